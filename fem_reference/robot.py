"""A cable robot as plain arrays, and its state at rest."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.cable import CableData, CableEquilibrium
from cdpr_struct.fem_reference.masts import Mast
from cdpr_struct.fem_reference.pulley import PulleyData
from cdpr_struct.fem_reference.rigid_platform import PlatformData, point_motion, rotating_arm_stiffness
from cdpr_struct.fem_reference.surroundings import SurroundingsData


@dataclass(frozen=True, eq=False)
class RobotData:
    """m cables between a frame and one rigid platform.

    frame_anchors    : (m, 3) [m], world, held; with a pulley, the point where the cable enters it
    platform_anchors : (m, 3) [m], platform frame
    cables           : m CableData, each from its frame anchor (start) to its platform anchor (end), so with
                       what lies on a pulley
    platform         : PlatformData
    gravity          : (3,) [m/s^2], world, z up
    pulleys          : m PulleyData or None, or empty for none at all
    surroundings     : SurroundingsData, what the robot stands and leans on
    wind             : (3,) [m/s], world, velocity of the air around the cables, of air_density [kg/m^3]; it presses on
                       a cable across the line from its start to its end, alike on every metre
    guided           : numbers, from 0, of the platform's six unknowns (displacement of the reference point along x, y,
                       z, rotation about them) that a guide holds
    """

    frame_anchors: np.ndarray
    platform_anchors: np.ndarray
    cables: tuple[CableData, ...]
    platform: PlatformData
    gravity: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    pulleys: tuple[PulleyData | None, ...] = ()
    surroundings: SurroundingsData = field(default_factory=SurroundingsData)
    guided: tuple[int, ...] = ()
    wind: np.ndarray = field(default_factory=lambda: np.zeros(3))
    air_density: float = 1.225

    def __post_init__(self) -> None:
        cables = tuple(self.cables)
        if not cables:
            raise ValueError("RobotData.cables must hold at least one cable, got none")
        object.__setattr__(self, "cables", cables)
        for name in ("frame_anchors", "platform_anchors"):
            object.__setattr__(self, name, fixed_array(f"RobotData.{name}", getattr(self, name), (len(cables), 3)))
        for name in ("gravity", "wind"):
            object.__setattr__(self, name, fixed_array(f"RobotData.{name}", getattr(self, name), (3,)))
        if not 0.0 <= self.air_density < np.inf:
            raise ValueError(f"RobotData.air_density must be zero or more, got {self.air_density!r}")
        pulleys = tuple(self.pulleys)
        if len(pulleys) not in (0, len(cables)):
            raise ValueError(f"RobotData.pulleys must be empty or hold {len(cables)} entries, got {len(pulleys)}")
        object.__setattr__(self, "pulleys", pulleys)
        if any(pulleys) and self.surroundings.bending:
            raise ValueError("RobotData: pulleys do not go with masts that bend")
        if any(p is not None and c.winch_tension for p, c in zip(pulleys, cables, strict=False)):
            raise ValueError("RobotData: pulleys do not go with winches that hold the tension of their cables")
        if any(number not in range(6) for number in self.guided) or len(set(self.guided)) >= 6:
            raise ValueError(f"RobotData.guided must be numbers from 0 to 5, not all six, got {self.guided!r}")

    @property
    def windy(self) -> bool:
        """Whether wind presses on any cable."""
        return bool(self.wind.any() and any(cable.drag_width for cable in self.cables))

    @property
    def free_unknowns(self) -> np.ndarray:
        """Numbers (f,) of the platform's unknowns that no guide holds."""
        return np.setdiff1d(np.arange(6), self.guided)

    @property
    def soft_masts(self) -> tuple[Mast, ...]:
        """The masts that give way."""
        return self.surroundings.soft_masts(self.frame_anchors)


@dataclass(frozen=True, eq=False)
class PointForce:
    """A constant force on the platform, and a constant moment if there is one.

    force  : (3,) [N], world; keeps its direction when the platform turns
    point  : (3,) [m], where it acts, platform frame
    moment : (3,) [N m], world; keeps its axes when the platform turns, so it has no potential
    """

    force: np.ndarray
    point: np.ndarray = field(default_factory=lambda: np.zeros(3))
    moment: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        for name in ("force", "point", "moment"):
            object.__setattr__(self, name, fixed_array(f"PointForce.{name}", getattr(self, name), (3,)))


@dataclass(frozen=True, eq=False)
class DeadLoads:
    """Constant forces (k, 3) [N], world, at platform points (k, 3) [m], platform frame; the weight first.

    moment : (3,) [N m], constant, world
    """

    forces: np.ndarray
    points: np.ndarray
    moment: np.ndarray

    @classmethod
    def on(cls, robot: RobotData, external_force: PointForce | None) -> DeadLoads:
        """Weight of the platform at its centre of mass, and the external force if there is one."""
        own = robot.surroundings.platform_gravity
        forces = [robot.platform.mass * (robot.gravity if own is None else own)]
        points, moment = [robot.platform.center_of_mass], np.zeros(3)
        if external_force is not None:
            if not isinstance(external_force, PointForce):
                raise ValueError(f"external_force must be a PointForce or None, got {external_force!r}")
            forces.append(external_force.force)
            points.append(external_force.point)
            moment = external_force.moment
        return cls(np.array(forces), np.array(points), moment)


@dataclass(frozen=True, eq=False)
class RobotEquilibrium:
    """A robot at rest (or held at a pose).

    robot, external_force : what it was solved for
    position, rotation    : (3,) [m], (3, 3) platform to world
    cables                : m CableEquilibrium
    residual_wrench       : (6,) [N, N m], world, about the reference point, of all forces on the platform;
                            zero but for round-off where the platform was free, else what would have to hold it; minus
                            what a guide does to it
    iterations            : Newton steps on the pose
    """

    robot: RobotData
    external_force: PointForce | None
    position: np.ndarray
    rotation: np.ndarray
    cables: tuple[CableEquilibrium, ...]
    residual_wrench: np.ndarray
    iterations: int

    @property
    def elements(self) -> int:
        """Number n of bars of every cable."""
        return self.cables[0].elements

    @property
    def arms(self) -> np.ndarray:
        """Lever arms (m, 3) [m] from the reference point to the platform anchors, world axes."""
        return self.robot.platform_anchors @ self.rotation.T

    def end_motion(self) -> np.ndarray:
        """Motion (m, 3, 6) of the cable ends per small platform motion."""
        return point_motion(self.arms)

    def geometric_stiffness(self) -> np.ndarray:
        """Stiffness (6, 6) of the turning lever arms of cable forces, weight and external force, and of a tether.

        Symmetric part only: the rest is half the moment of all forces on their arms, which vanishes at rest, and no
        conservative support could supply it to a platform that is held. A constant external moment is what these
        forces balance; it does no work that depends on the pose only, and its half stays out of vibration likewise.
        """
        loads = DeadLoads.on(self.robot, self.external_force)
        arms = np.vstack([self.arms, loads.points @ self.rotation.T])
        pulls = np.array([-cable.end_force for cable in self.cables])
        stiffness = rotating_arm_stiffness(arms, np.vstack([pulls, loads.forces]))
        stiffness[:3, :3] += self.robot.surroundings.tether_stiffness * np.eye(3)
        return 0.5 * (stiffness + stiffness.T)

    def element_stiffness(self) -> np.ndarray:
        """Tangent stiffness (m, n, 6, 6) [N/m] of all bars."""
        return np.array([cable.element_stiffness() for cable in self.cables])

    def element_mass(self, mass: MassModel = "lumped") -> np.ndarray:
        """Mass matrices (m, n, 6, 6) [kg] of all bars."""
        return np.array([cable.element_mass(mass) for cable in self.cables])

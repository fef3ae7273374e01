"""The robot: a platform on m cables in a frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.robot.arrays import frozen_array
from cdpr_struct.robot.body import Body
from cdpr_struct.robot.cable import Cable, Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.lump import Lump, lumps_fault
from cdpr_struct.robot.platform import Platform, least_moved_mass
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.winches import Winches, winches_fault

if TYPE_CHECKING:
    from cdpr_struct.robot.remainder import Remainder
    from cdpr_struct.robot.tolerances import Spread

_ROUNDING = 1e-15  # a vector whose length is one but for this is left as it is: files are read as written
FREEDOMS = ("x", "y", "z", "rx", "ry", "rz")
"""Of the platform: displacement of its origin along the world axes, rotation about them."""
MOTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")
"""The same in words."""


@dataclass(frozen=True, slots=True, eq=False)
class Robot:
    """Cable-driven parallel robot with m cables.

    platform_anchors : (m, 3) A_i [m], platform frame
    frame_anchors    : (m, 3) B_i [m], world frame; with a pulley, where the cable enters it
    pulleys          : per cable a `Pulley` or None
    gravity          : g [m/s^2], zero or more; given as a vector (3,), world frame, it becomes its size and `down`
    home             : pose that commands use when none is given, or None
    guided           : of FREEDOMS, those that a guide holds at the pose at hand: world axes at the platform origin
    down             : (3,) unit vector along which gravity acts, world frame
    extensions       : compliance in line, masts, loads, encoders and sensors; neutral if not given
    bodies           : what cables must keep away from; statics and dynamics know nothing of them
    lumps            : point masses on cables
    tolerances       : those that the file states, by name; see `Tolerances`
    posterior        : what a diagnosis left uncertain, in place of the tolerances, or None
    remainder        : what a diagnosis left unexplained, as a random law, or None
    """

    name: str
    platform: Platform
    cables: tuple[Cable, ...]
    platform_anchors: np.ndarray
    frame_anchors: np.ndarray
    pulleys: tuple[Pulley | None, ...] = ()
    gravity: float = 9.81
    description: str = ""
    home: Pose | None = None
    extensions: Extensions = None  # type: ignore[assignment]
    guided: tuple[str, ...] = ()
    down: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, -1.0]))
    bodies: tuple[Body, ...] = ()
    lumps: tuple[Lump, ...] = ()
    tolerances: Mapping[str, float] = field(default_factory=dict)
    posterior: "Spread | None" = None
    remainder: "Remainder | None" = None

    def __post_init__(self) -> None:
        self._settle_gravity()
        _check_guided(self.guided)
        m = len(self.cables)
        if m == 0:
            raise ValueError("Robot.cables must hold at least one cable")
        for name in ("platform_anchors", "frame_anchors"):
            object.__setattr__(self, name, frozen_array(getattr(self, name), (m, 3), f"Robot.{name}"))
        if not self.pulleys:
            object.__setattr__(self, "pulleys", (None,) * m)
        if len(self.pulleys) != m:
            raise ValueError(f"Robot.pulleys must have one entry per cable ({m}), got {len(self.pulleys)}")
        if self.extensions is None or not self.extensions.active:
            causes = () if self.extensions is None else self.extensions.causes
            object.__setattr__(self, "extensions", Extensions.of(m, causes=causes))
        self._check_parts()

    def _check_parts(self) -> None:
        """Extensions, lumps and winches that fit the cables."""
        m = len(self.cables)
        if len(self.extensions.slip) != m:
            raise ValueError(f"Robot.extensions must be for {m} cables, got {len(self.extensions.slip)}")
        if fault := moving_parts_fault(self.platform, self.extensions):
            raise ValueError(fault)
        if fault := cable_drag_fault(self.extensions, self.gravity):
            raise ValueError(fault)
        if fault := lumps_fault(self.lumps, m, self.extensions, self.gravity):
            raise ValueError(f"Robot.lumps: {fault}")
        if fault := winches_fault(self.cables):
            raise ValueError(fault)

    @property
    def held_freedoms(self) -> np.ndarray:
        """(6,) bool, which of FREEDOMS a guide holds."""
        return np.array([name in self.guided for name in FREEDOMS])

    def _settle_gravity(self) -> None:
        """Size and direction of gravity, which may have been given as one vector."""
        given = np.asarray(self.gravity, dtype=float)
        if given.shape == (3,):
            size = float(np.linalg.norm(given))
            object.__setattr__(self, "gravity", size)
            object.__setattr__(self, "down", given / size if size > 0.0 else (0.0, 0.0, -1.0))
        down = frozen_array(self.down, (3,), "Robot.down")
        length = float(np.linalg.norm(down))
        if given.shape not in ((), (3,)) or not 0.0 <= self.gravity < np.inf or length == 0.0:
            raise ValueError(f"Robot.gravity must be zero or more, or a vector of three numbers, got {self.gravity!r}")
        unit = down if abs(length - 1.0) <= _ROUNDING else frozen_array(down / length, (3,), "Robot.down")
        object.__setattr__(self, "down", unit)

    @property
    def gravity_vector(self) -> np.ndarray:
        """(3,) [m/s^2], world frame."""
        return self.gravity * self.down

    @property
    def axial_stiffness(self) -> np.ndarray:
        """(m,) EA [N]."""
        return np.array([cable.axial_stiffness for cable in self.cables])

    @property
    def linear_density(self) -> np.ndarray:
        """(m,) mu [kg/m]."""
        return np.array([cable.linear_density for cable in self.cables])

    @property
    def damping_ratio(self) -> np.ndarray:
        """(m,) xi [-]."""
        return np.array([cable.damping_ratio for cable in self.cables])

    @property
    def force_min(self) -> np.ndarray:
        """(m,) smallest tension at the platform that each cable is to have [N]."""
        return np.array([cable.force_min for cable in self.cables])

    @property
    def force_max(self) -> np.ndarray:
        """(m,) largest tension at the platform that each cable may have [N]; inf for no limit."""
        return np.array([cable.force_max for cable in self.cables])

    @property
    def tension_winches(self) -> list[int]:
        """Numbers from 1 of the cables whose winches hold the tension."""
        return [number for number, cable in enumerate(self.cables, start=1) if cable.winch_tension]

    @property
    def winches(self) -> Winches:
        """Those that hold lengths."""
        return Winches.of(self.cables)

    @property
    def shared_winches(self) -> list[str]:
        """Names of the winches that wind several cables."""
        winches = self.winches
        return [name for name, cables in zip(winches.names, winches.cables, strict=True) if len(cables) > 1]

    @property
    def weight_per_length(self) -> np.ndarray:
        """(m,) mu g [N/m]."""
        return self.linear_density * self.gravity

    def with_load(self, payload: float = 0.0, mass: float | None = None) -> "Robot":
        """Robot whose platform has another `mass` [kg] and/or a point load `payload` [kg] at its origin."""
        platform = self.platform if mass is None else self.platform.with_mass(mass)
        return replace(self, platform=platform.with_point_load(payload))

    def with_force_limits(self, lower: float | None = None, upper: float | None = None) -> "Robot":
        """Robot all of whose cables have these limits of tension at the platform [N]; None keeps each cable's own.

        Raises
        ------
        ValueError : a lower limit that is negative or not below the upper one.
        """
        limits = (("force_min", lower), ("force_max", upper))
        given: dict[str, Any] = {name: value for name, value in limits if value is not None}
        return replace(self, cables=tuple(replace(cable, **given) for cable in self.cables)) if given else self

    def with_wrench(self, wrench: np.ndarray | Sequence[float]) -> "Robot":
        """Robot with a further constant force and moment (6,) on its platform about its origin, world axes [N, N m]."""
        more, added = self.extensions, frozen_array(wrench, (6,), "wrench")
        load = {"force": more.force + added[:3], "moment": more.moment + added[3:]}
        return replace(self, extensions=more.with_changes(**load))

    def at_temperature(self, change: float) -> "Robot":
        """Robot whose cables are warmer by `change` than when their lengths were entered [K]."""
        return replace(self, extensions=self.extensions.with_changes(temperature_change=change))

    def without_extensions(self, *names: str) -> "Robot":
        """Robot whose named extensions are neutral, or all of them if none is named."""
        return replace(self, extensions=self.extensions.without(*names) if names else Extensions.of(len(self.cables)))


def anchors_in_world(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Platform anchors in the world and their lever arms.

    Parameters
    ----------
    position : (..., 3) r [m]
    rotation : (..., 3, 3) platform to world

    Returns
    -------
    points : (..., m, 3) r + R A_i [m], eq. (3.1)
    arms : (..., m, 3) R A_i [m], world axes
    """
    arms = np.einsum("...ij,mj->...mi", rotation, robot.platform_anchors)
    return position[..., None, :] + arms, arms


def gravity_wrench(robot: Robot, rotation: np.ndarray) -> np.ndarray:
    """Wrench (..., 6) of the platform's weight about its origin, world axes [N, N m]."""
    center = np.einsum("...ij,j->...i", rotation, robot.platform.center_of_mass)
    force = np.broadcast_to(robot.platform.mass * robot.gravity_vector, center.shape)
    return np.concatenate([force, np.cross(center, force)], axis=-1)


def _check_guided(guided: tuple[str, ...]) -> None:
    unknown = [name for name in guided if name not in FREEDOMS]
    if unknown or len(set(guided)) < len(guided) or len(guided) == len(FREEDOMS):
        raise ValueError(f"Robot.guided must be some of {', '.join(FREEDOMS)}, not all, each once, got {guided!r}")


def cable_drag_fault(more: Extensions, gravity: float) -> str:
    """What drag_width lacks, "" if nothing: wind that pushes, and gravity, in which every cable has a shape."""
    if not more.drag_width.any():
        return ""
    if not more.wind.any():
        return "drag_width needs wind = [x, y, z], the velocity of the air in m/s, world frame"
    return "" if gravity > 0.0 else "drag_width needs gravity above 0: a cable in the lee would have no shape"


def internal_mass_fault(platform: Platform, more: Extensions) -> str:
    """What is wrong with the internal mass, "" if nothing: it has a mount, and a rigid body is left without it."""
    if more.internal_mass == 0.0:
        return ""
    if more.internal_frequency == 0.0:
        return f"internal_mass = {more.internal_mass:g} kg needs internal_frequency, in Hz, above 0"
    most = platform.moved_mass(more.internal_direction)
    if more.internal_mass < most:
        return ""
    return (
        f"internal_mass = {more.internal_mass:g} kg must be a part of the platform's mass: below {most:.4g} kg, "
        "which its mass, centre of mass and inertia move along internal_direction at its origin"
    )


def moving_parts_fault(platform: Platform, more: Extensions) -> str:
    """What is wrong with parts that move in the platform, "" if nothing."""
    return internal_mass_fault(platform, more) or swinging_mass_fault(platform, more)


def swinging_mass_fault(platform: Platform, more: Extensions) -> str:
    """What is wrong with the mass that swings, "" if nothing: it has a frequency, and a body is left without it."""
    if more.swinging_mass == 0.0:
        return ""
    if more.swinging_frequency == 0.0:
        return f"swinging_mass = {more.swinging_mass:g} kg needs swinging_frequency, in Hz, above 0"
    body = np.asarray(platform.mass), platform.center_of_mass, platform.inertia
    most = float(least_moved_mass(*body, more.swinging_place))
    if more.swinging_mass < most:
        return ""
    return (
        f"swinging_mass = {more.swinging_mass:g} kg must be a part of the platform's mass: below {most:.4g} kg, "
        "which its mass, centre of mass and inertia move at swinging_place"
    )

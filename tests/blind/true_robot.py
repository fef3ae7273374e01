"""The real robot at rest, solved by the referee: entered robot, deviations, commanded lengths and payload."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from fem_reference import CableData, PlatformData, PointForce, PulleyData, RobotData, RobotEquilibrium, solve_robot
from tests.blind.deviations import EXPANSION, Deviations
from tests.blind.entered_robot import UP, EnteredRobot

ROUNDS = 30  # of forces and exits that depend on where the platform rests
SETTLED = 1e-9  # m, rad
DRUM_CIRCUMFERENCE = 0.4  # m, of the eccentric drum
HINGE_TILT = 0.05  # rad, over which the hinge tips


@dataclass(frozen=True, eq=False)
class Command:
    """What the controller does at one state.

    lengths  : (m,) [m], unstrained, by the entered model
    payload  : [kg]
    approach : (m,) +1 if the winch last wound in, else -1
    position, rotation : where the platform should come to rest, (3,) [m], (3, 3)
    """

    lengths: np.ndarray
    payload: float
    approach: np.ndarray
    position: np.ndarray
    rotation: np.ndarray


def true_lengths(deviations: Deviations, command: Command) -> np.ndarray:
    """Unstrained lengths (m,) [m] that are really paid out."""
    wanted, phases = command.lengths, 0.7 * np.arange(len(command.lengths))
    eccentric = deviations["drum_eccentricity"] * np.sin(2.0 * np.pi * wanted / DRUM_CIRCUMFERENCE + phases)
    paid = wanted + deviations["unstrained_length_offset"] + eccentric + deviations["backlash"] * command.approach
    return np.asarray(paid * (1.0 + deviations["drum_scale"]) * (1.0 + EXPANSION * deviations["temperature"]))


def true_cables(robot: EnteredRobot, deviations: Deviations, lengths: np.ndarray) -> tuple[CableData, ...]:
    """Cables whose stiffness also holds what is in series with them, spread over the free length."""
    stiffness = robot.axial_stiffness * np.exp(deviations["axial_stiffness"])
    longer = lengths + deviations["dead_length"] + deviations["joint_compliance"] * stiffness
    density = robot.linear_density * np.exp(deviations["cable_linear_density"])
    effective = stiffness * lengths / longer
    return tuple(CableData(*map(float, each)) for each in zip(lengths, effective, density, strict=True))


def true_platform(robot: EnteredRobot, deviations: Deviations, payload: float, rotation: np.ndarray) -> PlatformData:
    """Platform, joints and payload as one body; a hinged centre of mass tips over with the platform."""
    tip = np.tanh(np.array([rotation[2, 0], rotation[2, 1], 0.0]) / HINGE_TILT)
    center = robot.center_of_mass + deviations["center_of_mass"] - deviations["platform_hinge"] * tip
    mass = robot.mass + float(deviations["platform_mass"][0])
    masses = np.concatenate([[mass, payload], deviations["joint_mass"]])
    points = np.vstack([center, np.zeros(3), robot.platform_anchors + _offsets(deviations, "platform")])
    whole = masses @ points / masses.sum()
    arms = points - whole
    inertia = bare_inertia(robot, deviations) + np.einsum("k,kab->ab", masses, _point_inertia(arms))
    return PlatformData(float(masses.sum()), whole, inertia)


def bare_inertia(robot: EnteredRobot, deviations: Deviations) -> np.ndarray:
    """(3, 3) [kg m^2] of the platform alone about its centre of mass."""
    stretch = np.exp(0.5 * deviations["platform_inertia"])
    return np.asarray(robot.inertia * np.outer(stretch, stretch))


def _point_inertia(arms: np.ndarray) -> np.ndarray:
    """Inertia (k, 3, 3) of unit masses at arms (k, 3)."""
    squares = (arms**2).sum(axis=1)
    return np.asarray(squares[:, None, None] * np.eye(3) - arms[:, :, None] * arms[:, None, :])


def _offsets(deviations: Deviations, end: str) -> np.ndarray:
    return np.asarray(deviations[f"{end}_anchor_position"].reshape(-1, 3))


def true_gravity(robot: EnteredRobot, deviations: Deviations) -> np.ndarray:
    """Gravity (3,) [m/s^2] in the frame's axes."""
    tilt = Rotation.from_rotvec([*deviations["gravity_tilt"], 0.0])
    return np.asarray(tilt.apply([0.0, 0.0, -robot.gravity]))


def placed_force(robot: EnteredRobot, deviations: Deviations, position: np.ndarray) -> PointForce | None:
    """Force on the platform at its origin when it stands at a position."""
    away = position - robot.home
    force = deviations["external_force"] - deviations["hose_stiffness"] * away
    force = force + deviations["wind_gradient"] * float(away[:2] @ away[:2])
    return PointForce(force) if np.any(force) else None


def true_robot(
    robot: EnteredRobot, deviations: Deviations, command: Command, rotation: np.ndarray, yielded: np.ndarray
) -> RobotData:
    """Data for the referee, for a platform turned by `rotation` and masts that yielded by (m, 3) [m]."""
    anchors = robot.frame_anchors + _offsets(deviations, "frame")
    anchors = anchors * (1.0 + EXPANSION * deviations["temperature"]) + yielded
    pulleys: tuple[PulleyData, ...] = ()
    if robot.pulley_radius is not None:
        pulleys = tuple(PulleyData(float(robot.pulley_radius + d), UP) for d in deviations["pulley_radius"])
    platform = true_platform(robot, deviations, command.payload, rotation)
    return RobotData(
        anchors,
        robot.platform_anchors + _offsets(deviations, "platform"),
        true_cables(robot, deviations, true_lengths(deviations, command)),
        platform,
        true_gravity(robot, deviations),
        pulleys,
    )


def mast_yield(robot: EnteredRobot, deviations: Deviations, equilibrium: RobotEquilibrium) -> np.ndarray:
    """Shift (m, 3) [m] of the exit points under the sum of the cable forces on their mast."""
    pulls = -np.array([cable.start_force for cable in equilibrium.cables])
    sums = np.array([pulls[robot.masts == mast].sum(axis=0) for mast in range(4)])
    return np.asarray((deviations["frame_compliance"][:, None] * sums)[robot.masts])


def at_rest(robot: EnteredRobot, deviations: Deviations, command: Command, elements: int) -> RobotEquilibrium:
    """Where the real robot comes to rest, and with which forces.

    Forces, masts and hinge that depend on the answer are repeated until it stays; the referee's own errors
    (slack cable, no equilibrium) pass through.
    """
    position, rotation = command.position, command.rotation
    yielded = np.zeros_like(robot.frame_anchors)
    for _ in range(ROUNDS):
        data = true_robot(robot, deviations, command, rotation, yielded)
        force = placed_force(robot, deviations, position)
        equilibrium = solve_robot(data, position, rotation, elements, external_force=force)
        shift = mast_yield(robot, deviations, equilibrium)
        moved = np.abs(equilibrium.position - position).max() + np.abs(equilibrium.rotation - rotation).max()
        moved += np.abs(shift - yielded).max()
        position, rotation, yielded = equilibrium.position, equilibrium.rotation, shift
        if moved < SETTLED or not _depends_on_pose(deviations):
            return equilibrium
    raise RuntimeError(f"the platform did not settle in {ROUNDS} rounds, last motion {moved:.3g}")


def _depends_on_pose(deviations: Deviations) -> bool:
    names = ("hose_stiffness", "wind_gradient", "platform_hinge", "frame_compliance")
    return any(np.any(deviations[name]) for name in names)

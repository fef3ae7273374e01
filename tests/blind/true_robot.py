"""The real robot at rest, solved by the referee: entered robot, deviations, commanded lengths and payload."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference import (
    CableData,
    PlatformData,
    PointForce,
    PulleyData,
    RobotData,
    RobotEquilibrium,
    solve_robot,
)
from tests.blind.bending_masts import mast_deflections
from tests.blind.deviations import EXPANSION, Deviations
from tests.blind.entered_robot import EnteredRobot
from tests.blind.settling import Settling

ROUNDS = 30  # of forces and exits that depend on where the platform rests
SETTLED = 1e-9  # m, rad
DRUM_CIRCUMFERENCE = 0.4  # m, of the eccentric drum
HINGE_TILT = 0.05  # rad, over which the hinge tips
BEDDED = 300.0  # N, over which the wires of a rope bed down
JOINT_RADIUS = 0.03  # m, a joint is a ball of it
HOOK = np.array([1.0, -0.5, 2.5])  # m from home, of the balancer's line
MAGNET = np.array([0.8, 0.5, -2.0])  # m from home, of the place on the floor
MIDDLE, REACH, CHANGE = 6.0, 3.0, 0.2  # m: of an encoder, from there, and along which a drum changes its layer
SETTLING_DAY = 0.2  # share of the campaign in which settling exits sink by all but 1 / e
FRAME_REACH = 5.0  # m
HOURS = 4.0  # that a campaign takes
ADDED_AT = 0.3  # of the length from the platform: where a marker sits on a cable
DAYS = 10_000  # moments of a campaign, each with a gust of its own


@dataclass(frozen=True, eq=False)
class Command:
    """What the controller does at one state.

    lengths  : (m,) [m], unstrained, by the entered model
    payload  : [kg]
    approach : (m,) +1 if the winch last wound in, else -1
    position, rotation : where the platform should come to rest, (3,) [m], (3, 3)
    day      : share of the campaign that is over, 0 at the first state and 1 at the last
    motion : (3, 3) acceleration of the platform's origin [m/s^2], angular velocity and acceleration [rad/s, rad/s^2]
    """

    lengths: np.ndarray
    payload: float
    approach: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    day: float = 0.0
    motion: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))


def true_lengths(deviations: Deviations, command: Command, home: np.ndarray | float = MIDDLE) -> np.ndarray:
    """Unstrained lengths (m,) [m] that are really paid out; drums change their layer at lengths `home` (m,) [m]."""
    wanted, phases = command.lengths, 0.7 * np.arange(len(command.lengths))
    eccentric = deviations["drum_eccentricity"] * np.sin(2.0 * np.pi * wanted / DRUM_CIRCUMFERENCE + phases)
    paid = wanted + deviations["unstrained_length_offset"] + eccentric + deviations["backlash"] * command.approach
    paid = paid + deviations["encoder_quadratic"] * ((wanted - MIDDLE) / REACH) ** 2
    paid = paid + deviations["second_layer"] * 0.5 * (1.0 + np.tanh((wanted - home) / CHANGE))
    paid = paid + deviations["clamp_slip"] * (np.arange(len(wanted)) == 2) * (command.day > 0.5)
    paid = paid + deviations["brake_slip"] * HOURS * command.day
    warmed = 1.0 + EXPANSION * deviations["cable_warming"] * command.day
    scale = (1.0 + deviations["drum_scale"]) * warmed
    return np.asarray(paid * scale * (1.0 + EXPANSION * deviations["temperature"]))


def bedding(deviations: Deviations, tensions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Line that touches the strain s(T) = s0 (1 - exp(-T / T0)) at tensions (m,): its value at 0, its slope [1/N]."""
    left = deviations["construction_stretch"] * np.exp(-tensions / BEDDED)
    slope = left / BEDDED
    return np.asarray(deviations["construction_stretch"] - left - slope * tensions), np.asarray(slope)


def powers(deviations: Deviations, tensions: np.ndarray, stiffness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tangent EA (m,) [N] of ropes whose strain grows with T^(1 - n), and what its line has at no tension (m,).

    stiffness : of the tangent at `BEDDED`
    """
    exponent = deviations["power_elasticity"]
    about = np.where(tensions > 0.0, tensions, BEDDED)
    tangent = stiffness * (about / BEDDED) ** exponent
    return np.asarray(tangent), np.asarray(about / tangent * exponent / (1.0 - exponent))


def true_cables(
    robot: EnteredRobot, deviations: Deviations, paid: np.ndarray, tensions: np.ndarray, day: float = 0.0
) -> tuple[CableData, ...]:
    """Cables with what is in line behind their exits: joints, and the dead piece of the same rope to the winch.

    paid, tensions : unstrained lengths (m,) [m], and tensions (m,) [N] about which a rope that beds down is linear
    day : share of the campaign that is over
    """
    stretch, slope = bedding(deviations, tensions)
    crept = 1.0 + deviations["creep"] * np.log10(1.0 + 60.0 * HOURS * day)
    stiffness = robot.axial_stiffness * np.exp(deviations["axial_stiffness"]) / crept
    stiffness, more = powers(deviations, tensions, stiffness)
    stretch = stretch + more
    lengths = paid * (1.0 + stretch) + deviations["dead_length"] * stretch
    stiffness = stiffness / (1.0 + slope * stiffness)
    density = robot.linear_density * np.exp(deviations["cable_linear_density"])
    give = deviations["joint_compliance"] + deviations["dead_length"] / stiffness
    bare = [CableData(*map(float, each)) for each in zip(lengths, stiffness, density, give, strict=True)]
    added = deviations["cable_added_mass"]
    return tuple(
        replace(cable, lumps=((ADDED_AT * cable.unstrained_length, float(mass)),)) if mass else cable
        for cable, mass in zip(bare, added, strict=True)
    )


def true_platform(robot: EnteredRobot, deviations: Deviations, payload: float, rotation: np.ndarray) -> PlatformData:
    """Platform, joints and payload as one body; a hinged centre of mass tips over with the platform."""
    tip = np.tanh(np.array([rotation[2, 0], rotation[2, 1], 0.0]) / HINGE_TILT)
    center = robot.center_of_mass + deviations["center_of_mass"] - deviations["platform_hinge"] * tip
    mass = robot.mass + float(deviations["platform_mass"][0])
    masses = np.concatenate([[mass, payload], deviations["joint_mass"]])
    hung = np.array([*deviations["hook_offset"], 0.0])
    points = np.vstack([center, hung, robot.platform_anchors + _offsets(deviations, "platform")])
    whole = masses @ points / masses.sum()
    arms = points - whole
    joints = 0.4 * float(deviations["joint_mass"].sum()) * JOINT_RADIUS**2 * np.eye(3)
    inertia = bare_inertia(robot, deviations) + joints + np.einsum("k,kab->ab", masses, _point_inertia(arms))
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


def moved_exits(robot: EnteredRobot, deviations: Deviations, day: float) -> np.ndarray:
    """By how much the exits (m, 3) [m] have moved at a share of the campaign: where they sink, and in the sun."""
    shift = deviations["noon_frame"] * np.sin(np.pi * day) * (robot.frame_anchors - robot.home) / FRAME_REACH
    shift[:2, 2] -= deviations["anchor_settling"] * (1.0 - np.exp(-day / SETTLING_DAY))
    return np.asarray(shift)


def placed_force(
    robot: EnteredRobot, deviations: Deviations, position: np.ndarray, day: float = 0.0
) -> PointForce | None:
    """Force on the platform at its origin when it stands at a position, at a share of the campaign."""
    away = position - robot.home
    force = deviations["external_force"] - deviations["hose_stiffness"] * away
    force = force + deviations["wind_gradient"] * float(away[:2] @ away[:2])
    line = robot.home + HOOK - position
    force = force + deviations["tool_balancer"] * line / np.linalg.norm(line)
    to_floor = robot.home + MAGNET - position
    force = force + deviations["floor_magnet"] * to_floor / np.linalg.norm(to_floor) ** 3
    force = force - deviations["cubic_hose"] * float(away @ away) * away
    force = force + deviations["gusts"] * np.random.default_rng(round(DAYS * day)).standard_normal(3)
    return PointForce(force) if np.any(force) else None


def inertia_force(platform: PlatformData, command: Command) -> PointForce | None:
    """D'Alembert's force and moment on a moving platform; nothing else may push it then."""
    if not np.any(command.motion):
        return None
    moved, spin, turned = command.motion
    center = command.rotation @ platform.center_of_mass
    inertia = command.rotation @ platform.inertia @ command.rotation.T
    there = moved + np.cross(turned, center) + np.cross(spin, np.cross(spin, center))
    moment = inertia @ turned + np.cross(spin, inertia @ spin)
    return PointForce(-platform.mass * there, platform.center_of_mass, -moment)


def balancer_stiffness(robot: EnteredRobot, deviations: Deviations, position: np.ndarray) -> np.ndarray:
    """Stiffness (3, 3) [N/m] of a line of constant force: it only turns."""
    line = robot.home + HOOK - position
    length = np.linalg.norm(line)
    across = np.eye(3) - np.outer(line, line) / length**2
    return np.asarray(deviations["tool_balancer"] / length * across)


def true_robot(
    robot: EnteredRobot,
    deviations: Deviations,
    command: Command,
    rotation: np.ndarray,
    yielded: np.ndarray,
    tensions: np.ndarray | None = None,
) -> RobotData:
    """Data for the referee, for a platform turned by `rotation` and masts that yielded by (m, 3) [m].

    tensions : (m,) [N], about which ropes that bed down are linear (default: none)
    """
    about = np.zeros(robot.cables) if tensions is None else tensions
    warmth = 1.0 + EXPANSION * deviations["temperature"]
    anchors = (robot.frame_anchors + _offsets(deviations, "frame")) * warmth + yielded
    anchors = anchors + moved_exits(robot, deviations, command.day)
    pulleys: tuple[PulleyData | None, ...] = ()
    if robot.pulley_radius is not None:
        radii = (robot.pulley_radius + deviations["pulley_radius"]).tolist()
        pulleys = tuple(
            None if np.isnan(axis).any() else PulleyData(r, axis) for r, axis in zip(radii, robot.axes, strict=True)
        )
    platform = true_platform(robot, deviations, command.payload, rotation)
    return RobotData(
        anchors,
        (robot.platform_anchors + _offsets(deviations, "platform")) * warmth,
        true_cables(robot, deviations, true_lengths(deviations, command, robot.home_lengths), about, command.day),
        platform,
        true_gravity(robot, deviations),
        pulleys,
    )


def mast_yield(robot: EnteredRobot, deviations: Deviations, equilibrium: RobotEquilibrium) -> np.ndarray:
    """Shift (m, 3) [m] of the exit points under the cable forces on their masts."""
    pulls = -np.array([cable.start_force for cable in equilibrium.cables])
    return mast_deflections(robot, deviations["frame_compliance"], pulls)


def at_rest(robot: EnteredRobot, deviations: Deviations, command: Command, elements: int) -> RobotEquilibrium:
    """Where the real robot comes to rest, and with which forces.

    Forces, masts, ropes and hinge that depend on the answer are repeated until it stays; the referee's own errors
    (slack cable, no equilibrium) pass through.
    """
    position, rotation = command.position, command.rotation
    yielded, tensions, masts = np.zeros_like(robot.frame_anchors), np.zeros(robot.cables), Settling()
    for _ in range(ROUNDS):
        data = true_robot(robot, deviations, command, rotation, yielded, tensions)
        force = placed_force(robot, deviations, position, command.day) or inertia_force(data.platform, command)
        equilibrium = solve_robot(data, position, rotation, elements, external_force=force)
        shift = mast_yield(robot, deviations, equilibrium)
        moved = np.abs(equilibrium.position - position).max() + np.abs(equilibrium.rotation - rotation).max()
        moved += np.abs(shift - yielded).max()
        pulls = np.array([np.linalg.norm(cable.end_force) for cable in equilibrium.cables])
        stretches = [bedding(deviations, about)[0] * command.lengths for about in (pulls, tensions)]
        moved += np.abs(stretches[0] - stretches[1]).max()
        position, rotation, tensions = equilibrium.position, equilibrium.rotation, pulls
        if moved < SETTLED or not _depends_on_pose(deviations):
            return equilibrium
        yielded = masts.next(yielded, shift)
    raise RuntimeError(f"the platform did not settle in {ROUNDS} rounds, last motion {moved:.3g}")


def _depends_on_pose(deviations: Deviations) -> bool:
    forces = ("hose_stiffness", "wind_gradient", "tool_balancer", "floor_magnet", "cubic_hose")
    yielding = ("platform_hinge", "frame_compliance", "construction_stretch", "power_elasticity")
    return any(np.any(deviations[name]) for name in (*forces, *yielding))

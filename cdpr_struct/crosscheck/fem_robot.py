"""Hands a robot to the referee: plain numbers in, equilibria and modes out."""

from dataclasses import fields

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.extensions import masts_of
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.masts import carriers, of_each_mast

NOT_IN_FEM = ("bending_stiffness", "added_mass", "internal_mass", "swinging_mass")
"""Extensions that the referee does not have: its bars neither bend nor carry masses, its platform is rigid."""


def to_fem(
    robot: Robot, lengths: np.ndarray, axial_stiffness: np.ndarray | None = None, density: np.ndarray | None = None
) -> fem.RobotData:
    """The referee's description of the robot with unstrained cable lengths paid out (m,) [m].

    axial_stiffness, density : (m,) EA [N] and mu [kg/m] at the tension at hand, None for those of the robot

    Raises
    ------
    CdprError : pulleys on masts that give way, or behind winches that hold their tension.
    """
    more = robot.extensions
    for number in robot.tension_winches:
        if robot.pulleys[number - 1] is not None:
            raise CdprError(
                f"the FEM has no pulley for a winch that holds its tension: leave out pulley or winch_tension of cable "
                f"{number} to check the rest; the model exact computes both"
            )
    if any(robot.pulleys) and (more.frame_compliance.any() or more.mast_bending.any()):
        raise CdprError(
            "the FEM has no pulleys on masts that give way: leave out the pulleys, or frame_compliance and "
            "mast_bending, to check the rest; the model exact computes both"
        )
    stiffness = robot.axial_stiffness if axial_stiffness is None else axial_stiffness
    heavy = robot.linear_density if density is None else density
    lumps = [tuple((p.from_platform, p.mass) for p in robot.lumps if p.cable == i + 1) for i in range(len(lengths))]
    cables = tuple(
        fem.CableData(float(length), float(ea), float(mu), float(give), cable.winch_tension, float(width), held)
        for length, ea, mu, cable, give, width, held in zip(
            lengths, stiffness, heavy, robot.cables, more.series_compliance, more.drag_width, lumps, strict=True
        )
    )
    body = robot.platform
    platform = fem.PlatformData(body.mass, np.array(body.center_of_mass), np.array(body.inertia))
    guided = tuple(np.flatnonzero(robot.held_freedoms).tolist())
    pulleys = tuple(None if p is None else fem.PulleyData(p.radius, np.array(p.axis)) for p in robot.pulleys)
    anchors = np.array(robot.frame_anchors), np.array(robot.platform_anchors)
    around, air = _surroundings(robot), (np.array(more.wind), more.air_density)
    return fem.RobotData(*anchors, cables, platform, robot.gravity_vector, pulleys, around, guided, *air)


def _surroundings(robot: Robot) -> fem.SurroundingsData:
    more, tilted = robot.extensions, (np.append(robot.extensions.tilt, 0.0) + robot.down) * robot.gravity
    shared = masts_of(robot.frame_anchors)
    masts = tuple(tuple(np.flatnonzero(column).tolist()) for column in carriers(shared).T)
    bracket, upright = (tuple(of_each_mast(shared, c).tolist()) for c in (more.frame_compliance, more.mast_bending))
    gravity = tilted if more.tilt.any() else None
    hose = more.hose, np.array(more.hose_center)
    heads = tuple(more.mast_mass.tolist())
    return fem.SurroundingsData(masts, bracket, upright, more.mast_foot, heads, *hose, gravity)


def push_of(robot: Robot) -> fem.PointForce | None:
    """The constant force and moment on the robot's platform, the drag of wind included."""
    force, moment = np.split(robot.extensions.wrench, 2)
    return fem.PointForce(force, moment=moment) if force.any() or moment.any() else None


def solve_in_fem(point: OperatingPoint, elements: int) -> fem.RobotEquilibrium:
    """Equilibrium that the referee finds at the same unstrained lengths, started from the point's pose."""
    states = point.cables
    data = to_fem(point.entered, states.total_length, states.axial_stiffness, point.arrays.linear_density)
    return fem.solve_robot(data, point.position, point.rotation, elements, external_force=push_of(point.entered))


def vibrating(modes: fem.RobotModes, neutral: int) -> fem.RobotModes:
    """The referee's modes without the first, neutral ones."""
    return fem.RobotModes(*(getattr(modes, part.name)[neutral:] for part in fields(modes)))


def fem_shapes(modes: fem.RobotModes, stations: int) -> np.ndarray:
    """Shapes (k, 6 + 3 m stations) sampled at the fractions 1/stations .. 1 - 1/stations of each cable.

    Raises
    ------
    ValueError : the number of elements is no multiple of `stations`.
    """
    count, m, inner, _ = modes.cable_shapes.shape
    stride, rest = divmod(inner + 1, stations)
    if rest:
        raise ValueError(f"element count {inner + 1} must be a multiple of {stations}")
    picked = modes.cable_shapes[:, :, stride - 1 :: stride][:, :, : stations - 1]
    return np.concatenate([modes.platform_shapes, picked.reshape(count, m * (stations - 1) * 3)], axis=1)


def fem_cable_motion(point: OperatingPoint, modes: fem.RobotModes, stations: np.ndarray) -> np.ndarray:
    """Motion (k, m, s, 3) at fractions (s,) of each cable from the frame, world axes, linear between the nodes.

    Frame ends that give way (pulleys, compliance in line, masts) continue the line of the first two nodes.
    """
    end = np.einsum("mab,kb->kma", attachment(point), modes.platform_shapes)[:, :, None]
    moving = np.concatenate([modes.cable_shapes, end], axis=2)
    frame = np.zeros_like(end)
    if point.arrays.has_yielding_frame_ends or point.arrays.has_masts:
        frame = 2.0 * moving[:, :, :1] - moving[:, :, 1:2]
    nodes = np.concatenate([frame, moving], axis=2)
    place = np.asarray(stations) * (nodes.shape[2] - 1)
    first = np.minimum(place.astype(int), nodes.shape[2] - 2)
    share = (place - first)[:, None]
    return np.asarray((1.0 - share) * nodes[:, :, first] + share * nodes[:, :, first + 1])


def sampling_mass(robot: Robot, lengths: np.ndarray, stations: int, platform_mass: np.ndarray) -> np.ndarray:
    """Mass matrix of the samples of `fem_shapes`: each stands for its piece of cable."""
    per_sample = np.repeat(robot.linear_density * lengths / stations, 3 * (stations - 1))
    mass = np.diag(np.concatenate([np.zeros(6), per_sample]))
    mass[:6, :6] = platform_mass
    return mass

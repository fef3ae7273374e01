"""Hands a robot to the referee: plain numbers in, equilibria and modes out."""

import numpy as np

import fem_reference as fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot import Robot


def to_fem(robot: Robot, lengths: np.ndarray) -> fem.RobotData:
    """The referee's description of the robot with unstrained cable lengths (m,) [m]."""
    cables = tuple(
        fem.CableData(float(length), cable.axial_stiffness, cable.linear_density)
        for length, cable in zip(lengths, robot.cables, strict=True)
    )
    body = robot.platform
    platform = fem.PlatformData(body.mass, np.array(body.center_of_mass), np.array(body.inertia))
    gravity = np.array([0.0, 0.0, -robot.gravity])
    pulleys = tuple(None if p is None else fem.PulleyData(p.radius, np.array(p.axis)) for p in robot.pulleys)
    anchors = np.array(robot.frame_anchors), np.array(robot.platform_anchors)
    return fem.RobotData(*anchors, cables, platform, gravity, pulleys)


def solve_in_fem(point: OperatingPoint, elements: int) -> fem.RobotEquilibrium:
    """Equilibrium that the referee finds at the same unstrained lengths, started from the point's pose."""
    data = to_fem(point.robot, point.cables.total_length)
    return fem.solve_robot(data, point.position, point.rotation, elements)


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


def sampling_mass(robot: Robot, lengths: np.ndarray, stations: int, platform_mass: np.ndarray) -> np.ndarray:
    """Mass matrix of the samples of `fem_shapes`: each stands for its piece of cable."""
    per_sample = np.repeat(robot.linear_density * lengths / stations, 3 * (stations - 1))
    mass = np.diag(np.concatenate([np.zeros(6), per_sample]))
    mass[:6, :6] = platform_mass
    return mass

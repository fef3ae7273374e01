"""Robots that swing far: few light cables, lengths locked."""

import numpy as np

from cdpr_struct.dynamics.large_motion import LargeMotion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.forward_kinematics import forward

ANCHORS = np.array([[0.30, 0.0, 0.10], [-0.20, 0.25, 0.10], [-0.15, -0.30, 0.12]])


def resting(robot: Robot, lengths: list[float], start: list[float]) -> OperatingPoint:
    """Where the robot rests at these lengths, near a start."""
    found = forward(robot, np.array(lengths), np.array(start), np.eye(3))
    found.require_converged()
    return OperatingPoint(robot, found.position, found.rotation, found.cables)


def three_cables() -> OperatingPoint:
    """A platform of 2 kg on three locked cables; its three slow modes lie between 0.9 and 1.4 Hz."""
    platform = Platform(2.0, (0.0, 0.02, -0.1), np.diag([0.05, 0.06, 0.07]))
    frame = np.array([[1.5, 0.2, 2.5], [-1.0, 1.2, 2.4], [-0.9, -1.3, 2.6]])
    robot = Robot("three", platform, (Cable(1e5, 1e-3),) * 3, ANCHORS, frame)
    return resting(robot, [2.3, 2.2, 2.4], [0.1, 0.0, 0.4])


def hung_from_a_line() -> tuple[OperatingPoint, int]:
    """A platform of 2 kg, symmetric about the plane y = 0, whose three frame anchors lie on a line along y; and the
    number of its mode that turns about that line."""
    platform = Platform(2.0, (0.02, 0.0, -0.1), np.diag([0.05, 0.06, 0.07]))
    anchors = np.array([[0.30, 0.0, 0.10], [-0.20, 0.25, 0.10], [-0.20, -0.25, 0.10]])
    frame = np.array([[0.0, 0.0, 2.0], [0.0, 0.8, 2.0], [0.0, -0.8, 2.0]])
    robot = Robot("line", platform, (Cable(1e5, 1e-6),) * 3, anchors, frame)
    point = resting(robot, [1.5, 1.6, 1.6], [0.0, 0.0, 0.4])
    shapes = LargeMotion.about(point).shapes
    about = np.concatenate([-np.cross([0.0, 1.0, 0.0], frame[0] - point.position), [0.0, 1.0, 0.0]])
    return point, int(np.abs(np.linalg.solve(shapes, about)).argmax())

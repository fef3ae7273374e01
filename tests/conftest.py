"""Fixtures that every room of tests may use."""

import os

import pytest
from hypothesis import settings

import cdpr_struct.cli  # noqa: F401, one thread for NumPy, which must be said before it is imported
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

# A change lands or not for its own sake: with CI set, property tests draw the same examples every time.
settings.register_profile("ci", derandomize=True)
if os.environ.get("CI"):
    settings.load_profile("ci")


def at_rest(name: str, position=None, mass=None, payload=0.0) -> OperatingPoint:
    """A built-in robot held at a position (default: its home pose) by sagging cables."""
    robot = load_robot(name).with_load(payload, mass)
    where = robot.home.position if position is None else position
    solution = inverse(robot, where, robot.home.rotation)
    return OperatingPoint(robot, where, robot.home.rotation, solution.cables)


@pytest.fixture(scope="session")
def thesis_point() -> OperatingPoint:
    """The thesis's robot of Table 3.1 at (0, 0, 0.5) with 60 kg."""
    return at_rest("thesis-3-1")

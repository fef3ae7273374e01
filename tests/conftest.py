"""Fixtures that every room of tests may use."""

import os

import pytest
from hypothesis import settings

import cdpr_struct.cli  # noqa: F401, one thread for NumPy, which must be said before it is imported
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

# A change lands or not for its own sake: with CI set, property tests draw the same examples every time.
settings.register_profile("ci", derandomize=True)
if os.environ.get("CI"):
    settings.load_profile("ci")


_FORMS = {name: vars(Drawing)[name] for name in ("pdf", "narrow_svg")}
_EMPTY = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"></svg>'
_LEFT_OUT = {"pdf": lambda self, title: b"%PDF-1.4", "narrow_svg": property(lambda self: _EMPTY)}


@pytest.fixture(scope="module", autouse=True)
def one_form_of_figures(request: pytest.FixtureRequest) -> None:
    """Pages draw each figure once, not three times: phone and paper are left to modules marked `every_form`."""
    every = request.node.get_closest_marker("every_form") is not None
    for name, form in (_FORMS if every else _LEFT_OUT).items():
        setattr(Drawing, name, form)


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

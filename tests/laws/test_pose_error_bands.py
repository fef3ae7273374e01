"""Bands of pose errors against robots that are drawn from the tolerances and brought to rest one by one."""

from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.locked_response import locked_response
from cdpr_struct.bands.pose_error_bands import ErringRobot, PoseErrorNumbers
from cdpr_struct.robot.tolerances import Spread, Tolerances, change_count, tolerance_factor
from cdpr_struct.statics.pose_error import pose_error

ENTERED = Path(__file__).parents[2] / "examples/bands/robot.toml"


def erring(name: str) -> tuple[cs.Robot, ErringRobot]:
    robot = cs.load_robot(name)
    pose = cs.Pose.from_degrees([*np.add(robot.home.position, [0.3, -0.2, 0.1]), 2.0, -3.0, 30.0])
    return robot, ErringRobot.of(robot, pose_error(robot, pose.position, pose.rotation))


@pytest.mark.parametrize("name", ["cogiro", str(ENTERED)])
def test_bands_of_pose_errors_are_those_of_drawn_robots(name):
    robot, found = erring(name)
    spread = Spread.within(Tolerances(**robot.tolerances), 8)
    bands = found.bands(locked_response(found.sagging), spread, 0.9)
    errors, drawn = found.drawn(spread, 800)
    assert drawn.lost == 0
    ends = np.quantile(errors, [0.05, 0.95], axis=0).T
    assert (np.abs(bands.band - ends) <= 0.12 * (ends[:, 1] - ends[:, 0])[:, None]).all()
    assert np.allclose(bands.sigma, errors.std(axis=0), rtol=0.08)


def test_a_robot_without_tolerances_has_the_errors_of_the_command():
    _, found = erring("thesis-3-1")
    none = Spread(np.zeros_like(tolerance_factor(Tolerances(), 8)), np.zeros(change_count(8)))
    bands = found.bands(locked_response(found.sagging), none, 0.9)
    pose = cs.Pose(found.reference_position, np.radians([2.0, -3.0, 30.0]))
    columns = cs.pose_error("thesis-3-1", pose=pose, band=90).frame().iloc[0]
    names = ["global_x_mm", "axial_z_mm", "sag_y_mm", "global_mm"]
    expected = 1e-3 * columns[names].to_numpy(float)
    value = found.numbers().all
    assert np.allclose(value[[0, 5, 7, 12]], expected, atol=1e-9)
    assert np.allclose(bands.band, value[:, None])


def test_sizes_are_those_of_their_components():
    numbers = PoseErrorNumbers(np.arange(12.0))
    assert np.allclose(numbers.sizes, [np.linalg.norm(np.arange(3.0) + 3.0 * part) for part in range(4)])


def test_a_band_that_first_order_misses_is_that_of_drawn_robots():
    """With anchors 1 mm off, the share of sag of taut cables goes with one over the tension squared."""
    found = cs.pose_error("thesis-3-1", band=90, samples=400)
    bands = found.answer["bands"]
    assert "sag_z_mm" in bands["samples"]["differ"]
    assert "global_z_mm" not in bands["samples"]["differ"]
    low, high = bands["errors"]["sag_z_mm"]["drawn"]
    assert f"{low:.3f} .. {high:.3f}*" in found.text()

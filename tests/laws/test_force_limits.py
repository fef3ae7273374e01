"""Force limits belong to the robot: every state of balance keeps them unless told otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.crosscheck.limits_poses import audit_poses
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.tension_distribution import distribute
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.quantities import tensions
from cdpr_struct.workspace.sweep import sweep

PRELOADED = load_robot("thesis-5")
HOME = PRELOADED.home.position
LEVEL = np.eye(3)
NEAR = HOME + np.array([[0.0, 0.0, 0.0], [1.0, 0.5, 0.3]])


def limited_one_by_one(robot: Robot) -> Robot:
    """Every cable has limits of its own."""
    cables = tuple(replace(c, force_min=40.0 + 3.0 * i, force_max=4000.0 + i) for i, c in enumerate(robot.cables))
    return replace(robot, cables=cables)


@pytest.mark.parametrize(
    "limits", [(-1.0, 10.0), (10.0, 10.0), (10.0, 5.0), (np.inf, np.inf), (np.nan, 5.0), (0.0, np.nan)]
)
def test_a_cable_refuses_limits_that_no_tension_meets(limits):
    with pytest.raises(ValueError, match=r"Cable\.force_m"):
        Cable(1e5, 0.1, 0.0, *limits)


def test_limits_are_replaced_where_given():
    robot = limited_one_by_one(PRELOADED)
    np.testing.assert_array_equal(robot.with_force_limits(7.0).force_min, 7.0)
    np.testing.assert_array_equal(robot.with_force_limits(7.0).force_max, robot.force_max)
    np.testing.assert_array_equal(robot.with_force_limits(None, 900.0).force_max, 900.0)
    np.testing.assert_array_equal(robot.with_force_limits(None, 900.0).force_min, robot.force_min)
    assert robot.with_force_limits() is robot
    with pytest.raises(ValueError, match="force_max must be above force_min = 50"):
        robot.with_force_limits(50.0, 50.0)


def test_limits_survive_the_file_of_an_extended_robot(tmp_path):
    robot = limited_one_by_one(PRELOADED)
    robot = replace(robot, cables=(Cable(1e5, 0.1), *robot.cables[1:]))
    path = tmp_path / "robot.toml"
    path.write_text(robot_toml(robot_from_arrays(robot, RobotArrays.of(robot)), "again"))
    again = load_robot(path)
    np.testing.assert_array_equal(again.force_min, robot.force_min)
    np.testing.assert_array_equal(again.force_max, robot.force_max)
    assert again.force_max[0] == np.inf


def test_tensions_at_a_pose_keep_the_robots_limits_by_default():
    robot = limited_one_by_one(PRELOADED)
    for found in (inverse(robot, NEAR, LEVEL).tensions, distribute(robot, NEAR, LEVEL).tensions):
        assert (found >= robot.force_min * (1.0 - 1e-9)).all()
        assert np.isclose(found, robot.force_min, rtol=1e-6).any(axis=-1).all()
    free = inverse(robot, HOME, LEVEL, lower_bound=0.0)
    assert free.tensions.min() < 11.0
    np.testing.assert_array_equal(
        inverse(robot.with_force_limits(60.0), HOME, LEVEL).tensions,
        inverse(robot, HOME, LEVEL, lower_bound=60).tensions,
    )


def test_the_upper_limit_holds_by_default_too():
    suspended, place = load_robot("thesis-3-1"), np.array([1.5, 1.0, 0.5])
    limit = 0.97 * inverse(suspended, place, LEVEL).tensions.max()
    robot = suspended.with_force_limits(None, limit)
    for found in (inverse(robot, place, LEVEL), distribute(robot, place, LEVEL)):
        assert found.tensions.max() == pytest.approx(limit, rel=1e-7)


def test_a_batch_of_limits_is_a_batch_of_robots():
    arrays = replace(RobotArrays.of(PRELOADED), force_min=np.array([[0.0], [40.0], [90.0]]) * np.ones(8))
    assert arrays.batch_shape == (3,)
    together = inverse(arrays, HOME, LEVEL).tensions
    assert together.shape == (3, 8)
    for own, bound in zip(together, (0.0, 40.0, 90.0), strict=True):
        np.testing.assert_allclose(own, inverse(PRELOADED, HOME, LEVEL, lower_bound=bound).tensions, rtol=1e-9)


def test_arrays_without_limits_have_none():
    arrays = RobotArrays.of(PRELOADED)
    kept = {name: getattr(arrays, name) for name in arrays.__slots__ if name not in ("force_min", "force_max")}
    bare = RobotArrays(**kept)
    np.testing.assert_array_equal(bare.force_min, 0.0)
    np.testing.assert_array_equal(bare.force_max, np.inf)
    free = inverse(PRELOADED, HOME, LEVEL, lower_bound=0.0).tensions
    np.testing.assert_array_equal(inverse(bare, HOME, LEVEL).tensions, free)


def test_maps_and_audits_keep_the_limits():
    least = 90.0
    robot = PRELOADED.with_force_limits(least)
    assert tensions(robot, NEAR, LEVEL)["tension_min_N"].min() == pytest.approx(least, rel=1e-6)
    assert audit_poses(robot, NEAR, LEVEL).tension.min() == pytest.approx(least, rel=1e-6)
    assert audit_poses(PRELOADED.with_force_limits(30.0), NEAR, LEVEL).tension.min() == pytest.approx(30.0, rel=1e-6)


def test_a_map_of_other_limits_is_another_map():
    """Chunks kept from an interrupted run must not be mixed with those of another limit."""
    grid = Grid(np.array([0.0, 1.0]), np.array([0.0]), np.array([2.5]), np.zeros(3))
    robots = [PRELOADED, PRELOADED.with_force_limits(60.0), PRELOADED.with_force_limits(None, 5000.0)]
    assert len({sweep("tension-min", robot, grid).fingerprint for robot in robots}) == 3

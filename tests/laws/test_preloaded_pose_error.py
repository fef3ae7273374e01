"""Pose error of preloaded robots: what the force limits ask for is wound in, and nothing else changes."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.equilibrium import PlatformArms
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.pose_error import pose_error, reference_lengths
from cdpr_struct.statics.preload import Preload
from cdpr_struct.statics.sufficient_load import sufficient_load
from cdpr_struct.workspace.quantities import pose_errors

PRELOADED = load_robot("thesis-5")
HOME = PRELOADED.home.position
LEVEL = np.eye(3)
NEAR = HOME + np.array([[0.0, 0.0, 0.0], [1.0, 0.5, 0.3], [-2.0, 1.0, -0.6]])
ALMOST_NOTHING = 1e-6  # kg


def preload_of(robot, place, mass=None) -> Preload:
    return Preload.of(RobotArrays.of(robot, None if mass is None else np.asarray(mass)), place, LEVEL)


def test_the_preload_is_an_internal_force():
    preload = preload_of(PRELOADED, NEAR)
    assert preload.held.all()
    arms = PlatformArms.at(RobotArrays.of(PRELOADED), NEAR, LEVEL)
    unit = PRELOADED.frame_anchors - arms.points
    unit /= np.linalg.norm(unit, axis=-1, keepdims=True)
    matrix = np.concatenate([unit, np.cross(arms.arms, unit)], axis=-1)
    left = np.einsum("kmi,km->ki", matrix, preload.internal_force)
    assert np.abs(left).max() < 1e-9 * np.abs(preload.internal_force).max()
    assert preload.internal_force.max() > 60.0
    weight = np.einsum("kmi,km->ki", matrix, preload.within_limits)[:, 2]
    np.testing.assert_allclose(weight, 70.0 * 9.81, rtol=1e-9)  # twin: the tensions themselves do balance something


@pytest.mark.parametrize("name", ["thesis-3-1", "thesis-5"])
def test_without_a_limit_nothing_is_wound_in(name):
    robot = load_robot(name).with_force_limits(0.0)
    points = PlatformArms.at(RobotArrays.of(robot), NEAR, LEVEL).points
    straight = np.linalg.norm(points - robot.frame_anchors, axis=-1)
    np.testing.assert_array_equal(reference_lengths(robot, NEAR, LEVEL), straight)
    np.testing.assert_array_equal(reference_lengths(robot.with_force_limits(0.0, 1e6), NEAR, LEVEL), straight)


def test_cables_are_shortened_by_the_stretch_of_the_preload():
    """To first order (strain 3e-4) the straight length over 1 + preload / EA."""
    preload = preload_of(PRELOADED, NEAR).internal_force
    straight = reference_lengths(PRELOADED.with_force_limits(0.0), NEAR, LEVEL)
    wound = straight - reference_lengths(PRELOADED, NEAR, LEVEL)
    strain = preload / PRELOADED.axial_stiffness
    np.testing.assert_allclose(wound, straight - straight / (1.0 + strain), rtol=0.02, atol=1e-6)
    assert wound.max() > 2e-3


def real_one(name: str):
    """The preloaded robot over pulleys, with compliance in line, or on masts."""
    if name == "pulleys":
        return replace(PRELOADED, pulleys=(Pulley(0.05),) * 8)
    given = {"series": {"series_compliance": 2e-5}, "masts": {"frame_compliance": 5e-6}, "bare": {},
             "nonlinear": {"nonlinearity": 0.3, "reference_tension": 200.0}}[name]  # fmt: skip
    return replace(PRELOADED, extensions=Extensions.of(8, given))


@pytest.mark.parametrize("name", ["bare", "pulleys", "series", "masts", "nonlinear"])
def test_without_load_springs_take_the_preload_at_the_reference_pose(name):
    """A platform that weighs nothing: the shortened springs pull as the limits ask, where they were meant to."""
    robot = real_one(name)
    error = pose_error(robot, NEAR, LEVEL, mass=ALMOST_NOTHING)
    wanted = preload_of(robot, NEAR, ALMOST_NOTHING).within_limits
    assert np.abs(error.axial_error).max() < 1e-6
    np.testing.assert_allclose(error.spring.tensions, wanted, rtol=2e-5)
    assert error.spring.tensions.min() == pytest.approx(70.0, rel=1e-4)


def test_a_preload_of_another_stiffness_is_seen():
    """Twin: lengths of cables 2 % stiffer leave 2 % of the preload out."""
    stiffer = replace(RobotArrays.of(PRELOADED), axial_stiffness=1.02 * PRELOADED.axial_stiffness)
    lengths = reference_lengths(stiffer, HOME, LEVEL, mass=ALMOST_NOTHING)
    found = forward(PRELOADED, lengths, HOME, LEVEL, "spring", mass=ALMOST_NOTHING).tensions
    np.testing.assert_allclose(found, 70.0 / 1.02, rtol=1e-3)


def test_preload_stiffens_the_robot_against_its_load():
    """At home: without preload the lower springs go slack, with 600 N all pull, and the error is half as large."""
    loose, tight = (pose_error(PRELOADED.with_force_limits(low), HOME, LEVEL) for low in (0.0, 600.0))
    assert (loose.spring.tensions[4:] == 0.0).all()
    assert tight.spring.tensions.min() > 200.0
    assert tight.sagging.tensions.min() > 200.0
    assert tight.axial_error[2] / loose.axial_error[2] == pytest.approx(0.5, abs=0.03)


def test_poses_that_the_limits_exclude_do_not_count():
    robot = PRELOADED.with_force_limits(70.0, 900.0)
    columns = pose_errors(robot, NEAR, LEVEL)
    assert columns["held"].tolist() == [True, False, True]
    assert pose_errors(PRELOADED, NEAR, LEVEL)["held"].all()
    np.testing.assert_array_equal(preload_of(robot, NEAR).internal_force[1], 0.0)


def test_masses_beyond_the_limits_are_left_out_of_the_sufficient_load():
    robot, place = load_robot("six-cable-4mm"), [0.0, 0.0, 0.5]
    free = sufficient_load(robot, place, LEVEL, 2e-3, 5.0, 100.0)
    strong, weak = (robot.with_force_limits(0.0, limit) for limit in (1e5, 20.0))
    assert sufficient_load(strong, place, LEVEL, 2e-3, 5.0, 100.0).mass == pytest.approx(free.mass, rel=1e-9)
    assert np.isnan(sufficient_load(weak, place, LEVEL, 2e-3, 5.0, 100.0).mass)

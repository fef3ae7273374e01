"""Trajectories, inertia wrench and winch work obey mechanics."""

import dataclasses

import numpy as np
import pytest

from cdpr_struct.dynamics.trajectory_distribution import distribute_along
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.trajectory import TrajectoryLimitError, helix, straight_line, through_samples

ROBOT = load_robot("thesis-5")
PLATFORM = Platform(7.0, [0.1, -0.2, 0.3], [[2.0, 0.1, 0.0], [0.1, 3.0, 0.2], [0.0, 0.2, 2.5]])


def test_helix_has_the_stated_speed_and_acceleration():
    """Section 5.3.2: 2.4 m/s and 1.9 m/s^2; two turns, 3 m up, at rest at both ends."""
    path = helix()
    assert round(path.speed.max(), 1) == 2.4
    assert round(path.acceleration_size.max(), 1) == 1.9
    np.testing.assert_allclose(path.position[[0, -1]], [[3.0, 0.0, 1.0], [3.0, 0.0, 4.0]], atol=1e-12)
    np.testing.assert_allclose(path.velocity[[0, -1]], 0.0, atol=1e-12)
    np.testing.assert_allclose(path.acceleration[[0, -1]], 0.0, atol=1e-12)


def tumbling():
    start, end = Pose.from_degrees([0, 1, 2, 10, -20, 30]), Pose.from_degrees([1, 0, 3, -25, 40, 160])
    return straight_line(start, end, 2.0, 4001)


@pytest.mark.parametrize("path", [helix(6001), tumbling()], ids=["helix", "line"])
def test_rates_are_derivatives(path):
    """Central differences; their error goes with the step squared, here below 1e-4 of the scale."""
    step = path.time[2] - path.time[0]
    for values, rates in ((path.position, path.velocity), (path.velocity, path.acceleration)):
        np.testing.assert_allclose((values[2:] - values[:-2]) / step, rates[1:-1], atol=1e-5)
    turned = (path.rotation[2:] - path.rotation[:-2]) / step @ np.swapaxes(path.rotation[1:-1], 1, 2)
    spin = np.stack([turned[:, 2, 1], turned[:, 0, 2], turned[:, 1, 0]], axis=1)
    np.testing.assert_allclose(spin, path.angular_velocity[1:-1], atol=2e-5)
    change = (path.angular_velocity[2:] - path.angular_velocity[:-2]) / step
    np.testing.assert_allclose(change, path.angular_acceleration[1:-1], atol=5e-5)


def test_samples_of_the_helix_give_it_back():
    """601 samples, quintic spline: acceleration to 1e-6 m/s^2 away from the ends, 1e-4 at them."""
    exact = helix(601)
    path = through_samples(exact.time, exact.position)
    error = np.abs(path.acceleration - exact.acceleration).max(axis=1)
    assert error[20:-20].max() < 1e-6
    assert error.max() < 1e-3
    np.testing.assert_allclose(path.velocity, exact.velocity, atol=1e-4)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_few_samples_are_enough(count):
    path = through_samples(np.arange(count), np.outer(np.arange(count), [1.0, 0.0, 0.0]))
    np.testing.assert_allclose(path.velocity[:, 0], float(count > 1), atol=1e-12)
    np.testing.assert_allclose(path.acceleration, 0.0, atol=1e-12)


def test_angles_may_pass_half_a_turn():
    angles = np.radians([[0, 0, a] for a in (170, 175, -180, -175, -170)])
    path = through_samples(np.arange(5.0), np.zeros((5, 3)), angles)
    np.testing.assert_allclose(path.angular_velocity[:, 2], np.radians(5.0), rtol=1e-9)


def test_inertia_wrench_is_the_rate_of_momentum():
    """Linear and angular momentum of the body by central differences, about a fixed point that the origin passes."""
    path = tumbling()
    wrench = path.inertia_wrench(PLATFORM)
    arm = path.rotation @ PLATFORM.center_of_mass
    velocity = path.velocity + np.cross(path.angular_velocity, arm)
    inertia = path.rotation @ PLATFORM.inertia @ np.swapaxes(path.rotation, 1, 2)
    spin = np.einsum("kij,kj->ki", inertia, path.angular_velocity)
    step = path.time[2] - path.time[0]
    momentum = PLATFORM.mass * velocity
    rate = (momentum[2:] - momentum[:-2]) / step
    np.testing.assert_allclose(wrench[1:-1, :3], -rate, atol=1e-3)
    moment = np.cross(arm[1:-1], rate) + (spin[2:] - spin[:-2]) / step
    np.testing.assert_allclose(wrench[1:-1, 3:], -moment, atol=1e-3)


def test_speed_and_acceleration_limits():
    with pytest.raises(
        TrajectoryLimitError, match=r"speed reaches 2.364 m/s at t = 15 s, 0.3636 m/s above the limit 2 m/s"
    ):
        helix(301).require_within(max_speed=2.0)
    with pytest.raises(TrajectoryLimitError, match=r"acceleration reaches 1\.85\d* m/s\^2"):
        helix(301).require_within(max_acceleration=1.0)
    helix(301).require_within(2.4, 1.9)


def test_net_work_of_the_winches_is_the_energy_gained():
    """Ideal cables keep none: 70 kg lifted by 3 m, at rest before and after, 2060.1 J. Halving the step quarters the
    error of the trapezoidal rule."""
    gained = ROBOT.platform.mass * ROBOT.gravity * 3.0
    works = [distribute_along(ROBOT, helix(count), model="ideal").work for count in (301, 601)]
    errors = [abs(work.net[-1] - gained) for work in works]
    assert errors[1] < 1e-3 * gained
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=1.2)
    assert works[0].braking[-1] == pytest.approx(works[0].driving[-1] - works[0].net[-1])


def test_work_sees_a_heavier_platform():
    """Twin."""
    heavier = dataclasses.replace(ROBOT, platform=ROBOT.platform.with_mass(1.02 * ROBOT.platform.mass))
    net = distribute_along(heavier, helix(301), model="ideal").work.net[-1]
    assert net == pytest.approx(1.02 * 70.0 * 9.81 * 3.0, rel=3e-3)
    assert abs(net - 70.0 * 9.81 * 3.0) > 30.0

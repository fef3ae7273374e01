"""Clocks along a motion: what delays and a drift do to readings, what inertia asks of tensions, what is noise."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.hypotheses.causes.clocks import BOTH, LENGTHS, TENSIONS
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.correction import BEYOND_NOISE, several_tilted
from cdpr_struct.hypotheses.drift import drifts
from cdpr_struct.hypotheses.laws import _tilts
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.measurement.frames import Frames
from cdpr_struct.observation.motion import inertial, tension_rates
from cdpr_struct.observation.readings import Readings, paid_out, true_tension
from cdpr_struct.observation.rest import inertia_wrench
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import PlatformArms
from cdpr_struct.statics.trajectory import Trajectory
from tests.moving_campaigns import filmed, robot

LATE, DRIFT = 0.05, 1e-3  # s, s/s
TIME = 0.25 * np.arange(48)


def with_tensions(seed: int = 1, frames: int = 48):
    """A recording on four cables, with tensions that are nothing but a wave: what is asked is arithmetic."""
    campaign = filmed(seed, frames)
    states = campaign.states
    wave = 20.0 + 5.0 * np.sin(np.multiply.outer(states.time, [0.5, 0.6, 0.7, 0.8]))
    return replace(campaign, states=replace(states, tension=wave, tension_sigma=np.full(wave.shape, 0.5)))


def parabola(coefficients: np.ndarray, time: np.ndarray) -> np.ndarray:
    """(S, m) of (3, m)."""
    return np.stack([time**0, time, time**2], axis=1) @ coefficients


@pytest.mark.parametrize("cause", ["sensor_delay", "clock_drift"])
def test_readings_are_those_of_the_moment_of_the_pose(cause):
    """Poses that are older by a delay: what was filed with them is of later, and exact to second order."""
    campaign = with_tensions()
    known, time = recorded(campaign).known, campaign.states.time
    length, pull = parabola(np.array([[9.0] * 4, [0.3] * 4, [0.02] * 4]), time), np.full((48, 4), 20.0)
    rates = np.stack([0.3 + 0.04 * time, np.full(48, 0.04)], axis=-1)[:, None].repeat(4, axis=1)
    known = replace(known, rate=rates, pull=10.0 * rates)
    older = LATE if cause == "sensor_delay" else DRIFT * known.clock
    filed = parabola(np.array([[9.0] * 4, [0.3] * 4, [0.02] * 4]), time + older)
    theta = np.tile([LATE, 0.0, 0.0], 4) if cause == "sensor_delay" else np.array([DRIFT])
    arrays = LIBRARY[cause].apply(RobotArrays.of(robot()), theta[None])
    later = {"rate": replace(known, rate=_at(rates, older)), "pull": replace(known, pull=_at(10.0 * rates, older))}
    read = Readings(np.zeros((48, 3)), np.zeros((48, 3, 3)), pull + 10.0 * (filed - 9.0), filed)
    np.testing.assert_allclose(paid_out(arrays, read, later["rate"])[..., :], length, rtol=1e-9)
    np.testing.assert_allclose(true_tension(arrays, read, later["pull"]), pull + 10.0 * (length - 9.0), rtol=1e-9)


def _at(rates: np.ndarray, older: np.ndarray | float) -> np.ndarray:
    """Rates of what was filed, at its own moment."""
    moved = np.asarray(older) * np.ones(len(rates))
    return np.stack([rates[..., 0] + rates[..., 1] * moved[:, None], rates[..., 1]], axis=-1)


def test_each_system_is_told_apart_only_where_both_were_read():
    cause = LIBRARY["sensor_delay"]
    lengths = cause.patterns(seen_in(recorded(filmed(1, 48))))
    assert [one.label for one in lengths] == [*(f"cable {i} alone" for i in range(1, 5)), "all alike", "each its own"]
    both = cause.patterns(seen_in(recorded(with_tensions())))
    for law in (LENGTHS, TENSIONS, BOTH):
        assert sum(one.label.endswith(f", {law}") for one in both) == 6
    for found in (lengths, both):
        assert sum(one.weight for one in found) == pytest.approx(1.0)


def test_accelerations_come_with_what_is_not_known_of_them():
    noise, clean = np.random.default_rng(3), np.stack([0.8 * np.sin(0.6 * TIME)] * 3, axis=1)
    noisy = clean + 1e-3 * noise.standard_normal(clean.shape)
    own = replace(filmed(1, len(TIME)).states, position=noisy, tension=np.full((len(TIME), 4), 20.0), time=TIME)
    found, unknown = inertial(own)
    error = (found[:, :3] + 0.36 * clean)[3:-3]
    rms = np.sqrt((error**2).sum(axis=1).mean())
    assert rms < 0.05  # of 0.3; an interpolating spline errs by 0.1 an axis
    assert 0.3 * rms < unknown[10] < 3.0 * rms
    assert not found[:3].any()
    unread = replace(own, tension=np.full(own.tension.shape, np.nan))
    assert not inertial(unread)[0].any()
    assert not tension_rates(unread).any()


def test_inertia_is_that_of_a_trajectory():
    """The other implementation, of planned motions; nothing turns yet, and is about to."""
    draw, machine = np.random.default_rng(4), robot()
    n = 5
    rotation = Rotation.from_rotvec(0.3 * draw.standard_normal((n, 3))).as_matrix()
    motion, turning, still = draw.standard_normal((n, 3)), draw.standard_normal((n, 3)), np.zeros((n, 3))
    path = Trajectory(np.arange(n) * 1.0, still, still, motion, rotation, still, turning)
    known = replace(
        recorded(with_tensions()).known.at(np.arange(n)), inertial=np.concatenate([motion, turning], axis=1)
    )
    arrays = RobotArrays.of(machine)
    found = inertia_wrench(arrays, PlatformArms.at(arrays, still, rotation), rotation, known)
    np.testing.assert_allclose(found, path.inertia_wrench(machine.platform), atol=1e-12)


def test_rates_follow_corrections_of_units_axes_and_channels():
    frames = recorded_frames()
    np.testing.assert_allclose(frames.scaled("tension", 9.81).pull, 9.81 * frames.pull)
    np.testing.assert_allclose(frames.scaled("position", 1e-3).inertial[:, :3], 1e-3 * frames.inertial[:, :3])
    order = np.array([2, 1, 0, 3])
    np.testing.assert_array_equal(frames.in_order("tension", order).pull, frames.pull[:, order])
    mirrored = frames.in_axes(np.diag([1.0, -1.0, 1.0])).inertial
    np.testing.assert_allclose(mirrored, frames.inertial * [1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


def recorded_frames() -> Frames:
    draw = np.random.default_rng(5)
    return Frames(
        draw.normal(size=(6, 4, 2)), draw.normal(size=(6, 4, 2)), draw.normal(size=(6, 6)), np.zeros(6), np.ones(6), 6.0
    )


def test_tilts_that_are_noise_make_no_law_and_no_convention():
    campaign = filmed(1, 48)
    level = replace(campaign.states, angles=2e-3 * np.random.default_rng(6).standard_normal((48, 3)))
    assert several_tilted(level)
    assert not several_tilted(level, BEYOND_NOISE)
    assert several_tilted(replace(level, angles=0.1 + level.angles), BEYOND_NOISE)
    data = recorded(replace(campaign, states=level))
    noisy = np.zeros_like(data.sigma)
    noisy[:, 3:6] = Rotation.from_matrix(data.readings.rotation).as_rotvec() / data.sigma[:, 3:6]
    point = replace(Point.entered(data), noise=noisy)
    assert np.abs(_tilts(Local.about(data, point))).max() < 1e-4


def test_zeros_do_not_wander_within_minutes():
    campaign = filmed(1, 48)
    assert drifts(recorded(campaign)) == []
    slow = replace(campaign, states=replace(campaign.states, time=100.0 * campaign.states.time))
    assert len(drifts(recorded(slow))) > 0

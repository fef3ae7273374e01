"""Encoders that are read late along a motion: the delay is found, of all cables or of one.

Poses follow a curve; lengths are those that hold them at rest, taken from another time. Pure kinematics: what is
proved here is the arithmetic.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.observation.motion import length_rates, moving
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.laws.written_campaigns import cogiro, measured

SIGMA_LENGTH, SIGMA_POSITION, SIGMA_ROTATION = 1e-3, 5e-4, 5e-4
TIME = 0.25 * np.arange(24)


def lengths_at(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, angles and unstrained lengths along a figure of eight of some 0.5 m/s."""
    robot = load_robot("cogiro")
    home = robot.home.position
    place = home + np.stack([0.8 * np.sin(1.1 * time), 0.5 * np.sin(2.2 * time), 0.1 * np.cos(time)], axis=1)
    angles = 0.02 * np.stack([np.sin(time), np.cos(1.3 * time), np.sin(0.7 * time)], axis=1)
    held = inverse(robot, place, Rotation.from_euler("xyz", angles).as_matrix())
    return place, angles, held.lengths


@cache
def frames(seed: int, delays: tuple[float, ...]):
    """A campaign of frames whose lengths are older than the poses by delays, one a cable."""
    rng = np.random.default_rng(seed)
    place, angles, _ = lengths_at(TIME)
    lengths = np.stack([lengths_at(TIME - delay)[2][:, i] for i, delay in enumerate(delays)], axis=1)
    shape, base = lengths.shape, measured(cogiro(), 1)
    blank = np.full(shape, np.nan)
    states = replace(
        base.states,
        names=tuple(f"f{i}" for i in range(len(TIME))),
        position=place + SIGMA_POSITION * rng.standard_normal(place.shape),
        angles=angles + SIGMA_ROTATION * rng.standard_normal(place.shape),
        payload=np.zeros(len(TIME)),
        tension=blank,
        tension_sigma=blank,
        length=lengths + SIGMA_LENGTH * rng.standard_normal(shape),
        length_sigma=np.full(shape, SIGMA_LENGTH),
        sigma_position=np.full(len(TIME), SIGMA_POSITION),
        sigma_rotation=np.full(len(TIME), SIGMA_ROTATION),
        lock=np.full(len(TIME), -1),
        static=np.ones(len(TIME), dtype=bool),
        loaded=np.zeros(len(TIME), dtype=bool),
        approach=blank,
        time=TIME,
    )  # fmt: skip
    return replace(base, states=states, cable_frequencies=replace(base.cable_frequencies), tolerances=base.tolerances)


def test_rates_are_those_of_the_motion_and_states_at_rest_have_none():
    states = frames(1, (0.0,) * 8).states
    rates = length_rates(replace(states, length=lengths_at(TIME)[2]))
    step = 1e-5
    true = (lengths_at(TIME + step)[2] - lengths_at(TIME - step)[2]) / (2.0 * step)
    assert np.abs(rates[..., 0] - true)[2:-2].max() < 0.01 * np.abs(true).max()
    assert moving(rates).all()
    rest = replace(states, time=300.0 * np.arange(len(TIME)))
    assert not length_rates(rest).any()
    assert not length_rates(replace(states, time=np.full(len(TIME), np.nan))).any()
    assert not length_rates(replace(states, time=np.zeros(len(TIME)))).any()


@pytest.mark.parametrize(
    ("delays", "found"),
    [((0.03,) * 8, -0.03), pytest.param((0.0,) * 4 + (-0.03,) + (0.0,) * 3, 0.03, marks=pytest.mark.slow)],
    ids=["all", "one cable"],
)
def test_a_delay_is_named_with_its_size(delays, found):
    said = diagnosed(frames(2, delays))
    assert said.decision.classes == (("sensor_delay",),), said.decision
    (row,) = [row for row in said.sizes[0].parameters.values()]
    assert row["value"] == pytest.approx(found, abs=3.0 * row["sigma"])
    assert row["sigma"] < 0.1 * abs(found)


@pytest.mark.slow
def test_frames_that_agree_are_adequate():
    assert diagnosed(frames(3, (0.0,) * 8)).decision.status == "adequate"

"""Laws outside the library: what they do to every reading, and that they are said to be unknown (crime=True)."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.laws import laws, patterns
from cdpr_struct.hypotheses.periods import likeliest_periods
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import noisy, plan_of, with_states, written


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    robot = load_robot("cogiro")
    return written(robot, plan_of(robot, 6, cables_in=(0, 1)))


@pytest.fixture(scope="module")
def local(campaign) -> Local:
    data = recorded(campaign)
    return Local.about(data, Point.entered(data))


def test_every_law_has_words_of_its_own_and_one_of_them_is_true(local):
    found = patterns(laws(local))
    assert len({pattern.label for pattern in found}) == len(found)
    assert sum(pattern.weight for pattern in found) == pytest.approx(1.0, rel=1e-12)


def test_a_law_of_the_cells_changes_what_is_expected_of_plucked_cables(campaign, local):
    """By as much as a cell reading does that is off by the law."""
    law = next(one for one in laws(local) if one.words.endswith("with the square of the tension"))
    tension = campaign.states.tension
    off = 1e-4 * 0.02 * tension**2 / local.data.known.mean_tension
    data = recorded(with_states(campaign, tension=tension + off))
    changed = Local.about(data, Point.entered(data)).r
    found = law.columns.times(np.full(1, 1e-4))
    np.testing.assert_allclose(changed.cables - local.r.cables, found.cables[:, 0], rtol=1e-3, atol=1e-12)
    np.testing.assert_allclose(changed.static - local.r.static, found.static[..., 0], rtol=1e-2, atol=1e-6)
    assert np.abs(found.cables).max() > 1e-7


def test_cells_that_lag_say_in_part_what_pulled_before(campaign, local):
    law = next(one for one in laws(local) if one.words.endswith("that lags behind the state before, all alike"))
    tension = campaign.states.tension
    before = np.concatenate([tension[:1], tension[:-1]])
    data = recorded(with_states(campaign, tension=tension + 1e-4 * 0.02 * (before - tension)))
    changed = Local.about(data, Point.entered(data)).r
    found = 1e-4 * law.columns.static[..., 0]
    np.testing.assert_allclose(changed.static - local.r.static, found, rtol=1e-2, atol=1e-6)
    assert np.abs(found).max() > 1e-3


def test_cells_whose_gain_fades_are_off_in_proportion_to_time_and_tension(campaign, local):
    law = next(one for one in laws(local) if one.words.endswith("tension that changes with time, all alike"))
    tension = campaign.states.tension
    later = np.linspace(0.0, 1.0, len(tension))[:, None]
    data = recorded(with_states(campaign, tension=tension * (1.0 + 0.02e-4 * later)))
    changed = Local.about(data, Point.entered(data)).r
    found = 1e-4 * law.columns.static[..., 0]
    np.testing.assert_allclose(changed.static - local.r.static, found, rtol=1e-2, atol=1e-6)
    assert np.abs(found).max() > 1e-3


def test_cells_whose_gain_fades_are_unknown_and_none_whose_zeros_drift():
    robot = load_robot("cogiro")
    sound = noisy(written(robot, plan_of(robot, 12)), 8)
    later = np.linspace(0.0, 1.0, 12)[:, None]
    said = diagnosed(with_states(sound, tension=sound.states.tension * (1.0 - 0.05 * later)))
    assert said.decision.status == "unknown", said.decision
    assert "in proportion to the tension that changes with time" in said.outside[0]
    zeros = np.cumsum(np.random.default_rng(2).normal(0.0, 1.5, (12, 8)), axis=0)
    drifting = diagnosed(with_states(sound, tension=sound.states.tension + zeros - zeros[:1]))
    assert drifting.decision.status == "adequate", drifting.decision


def _outwards(local, channel):
    found = [one for one in laws(local) if one.words.endswith("the distance from the middle, outwards")]
    return next(one for one in found if one.channel == channel)


def test_a_lens_moves_positions_outwards_with_the_distance_from_the_middle(campaign, local):
    law = _outwards(local, "pose")
    assert law.columns.count == 2
    position = campaign.states.position
    x = position - position.mean(axis=0)
    far = x / np.sqrt((x**2).sum(axis=1).mean())
    sigma = local.data.sigma[:, :3].mean(axis=0)
    for number, moved in enumerate([far, (far**2).sum(axis=1, keepdims=True) * far]):
        data = recorded(with_states(campaign, position=position + 1e-3 * 5.0 * sigma * moved))
        changed = Local.about(data, Point.entered(data)).r
        found = 1e-3 * law.columns.static[..., number]
        np.testing.assert_allclose(changed.static - local.r.static, found, rtol=2e-2, atol=1e-5)
        assert np.abs(found).max() > 1e-4


def test_a_lens_is_unknown_and_no_temperature():
    robot = load_robot("cogiro")
    sound = noisy(written(robot, plan_of(robot, 12)), 8)
    x = sound.states.position - sound.states.position.mean(axis=0)
    bent = sound.states.position + 0.6e-3 * (x**2).sum(axis=1, keepdims=True) * x
    said = diagnosed(with_states(sound, position=bent))
    assert said.decision.status == "unknown", said.decision
    assert "outwards" in said.outside[0]


def test_a_hose_that_stiffens_pulls_outwards_with_the_cube_of_the_distance(campaign, local):
    law = _outwards(local, "force")
    assert law.columns.count == 5
    x = campaign.states.position - campaign.states.position.mean(axis=0)
    far = x / np.sqrt((x**2).sum(axis=1).mean())
    every = next(one for one in laws(local) if one.words.endswith("changes with every state")).columns.static
    states = len(x)
    each = every.reshape((*every.shape[:-1], 3, states)) / np.sqrt(states)
    np.testing.assert_allclose(law.columns.static[..., :3], each.sum(axis=-1), atol=1e-9)
    cube = (far**2).sum(axis=1, keepdims=True) * far
    np.testing.assert_allclose(law.columns.static[..., 4], (each * cube.T).sum(axis=(-2, -1)), atol=1e-9)


@pytest.mark.parametrize("period", [0.17, 0.4, 1.1])
def test_a_period_is_found_wherever_it_lies(period):
    rng = np.random.default_rng(3)
    lengths = rng.uniform(4.0, 9.0, (20, 8))
    error = np.sin(2.0 * np.pi * lengths / period + np.arange(8)) + 0.3 * rng.standard_normal((20, 8)) + lengths
    found, tried = likeliest_periods(lengths, error)
    assert abs(1.0 / found[0] - 1.0 / period) < 0.125 / 5.0  # an eighth of a wave over the range of lengths
    assert tried > 2 * 5.0 / 0.15


def test_cells_that_are_off_more_and_more_with_the_tilt_are_unknown():
    robot = load_robot("cogiro")
    sound = noisy(written(robot, plan_of(robot, 12)), 8)
    tilt = np.nan_to_num(sound.states.angles)[:, :1]
    turns = np.where(np.arange(8) % 2, 1.0, -1.0)
    off = replace(sound, states=replace(sound.states, tension=sound.states.tension + 150.0 * tilt * turns))
    said = diagnosed(off)
    assert said.decision.status == "unknown", said.decision
    assert "tilt" in said.outside[0]


@pytest.mark.slow
def test_an_encoder_that_often_skips_is_unknown_and_two_wrong_lengths_are_none():
    robot = load_robot("cogiro")
    sound = noisy(written(robot, plan_of(robot, 18)), 8)
    skipped, misread = sound.states.length.copy(), sound.states.length.copy()
    skipped[[1, 4, 8, 11, 15], 2] += [0.01, -0.01, 0.01, 0.01, -0.01]
    misread[[4, 13], [2, 5]] -= 0.01
    said = diagnosed(with_states(sound, length=skipped))
    assert said.decision.status == "unknown", said.decision
    assert said.piled_up is not None
    assert (said.piled_up.kind, said.piled_up.cable, said.piled_up.outliers) == ("length", 2, 5)
    other = diagnosed(with_states(sound, length=misread))
    assert other.decision.status == "adequate", other.decision
    assert other.piled_up is None
    assert len(other.set_aside) == 2

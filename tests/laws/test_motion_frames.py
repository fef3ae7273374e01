"""Frames of a motion: what they are worth, what condensing keeps, and a cause in motion beside an error of the place.

Truth of the recordings is the finite-element model's (`tests/moving_campaigns.py`).
"""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.all_frames import AllFrames, circular_shifts
from cdpr_struct.diagnosis.bend_of_speed import bend_of_speed
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.frame_blocks import BLOCKS
from cdpr_struct.hypotheses import search
from cdpr_struct.hypotheses.handling import corrections
from cdpr_struct.observation.motion import length_rates
from cdpr_struct.residuals import condensed as condensing
from cdpr_struct.residuals.condensed import FEWEST_KEPT, MOST_KEPT, condensed, correlation_span
from cdpr_struct.residuals.recorded import recorded
from tests.laws.written_campaigns import cogiro, measured
from tests.moving_campaigns import LENGTH, filmed, of_the_place

FRAMES = 72  # of the recordings that are not diagnosed
PLACE = 0.003  # m rms, of the error that changes with the place alone


def both(*errors):
    return lambda place, speed: sum(error(place, speed) for error in errors)


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.8])
def test_frames_count_as_what_their_lag_correlation_leaves(rho):
    """An AR(1) series of coefficient rho: n frames are worth n (1 - rho) / (1 + rho)."""
    draw, series = np.random.default_rng(1).standard_normal((4000, 4)), np.zeros((4000, 4))
    for k in range(1, len(series)):
        series[k] = rho * series[k - 1] + draw[k]
    assert correlation_span(series) == pytest.approx((1.0 + rho) / (1.0 - rho), rel=0.2)  # measured .03, .04, .06


def test_states_at_rest_and_short_motions_stay_as_they_are():
    for campaign in (measured(cogiro(), 1), filmed(1, FEWEST_KEPT)):
        assert condensed(campaign) is campaign


def test_condensed_frames_count_every_frame_and_keep_the_rates_of_all():
    whole = filmed(1, FRAMES)
    few = condensed(whole)
    index = [whole.states.names.index(name) for name in few.states.names]
    assert FEWEST_KEPT <= len(index) <= MOST_KEPT
    assert few.frames.of == FRAMES
    assert len(index) <= few.frames.worth <= FRAMES
    np.testing.assert_array_equal(few.frames.rate, length_rates(whole.states)[index])
    np.testing.assert_array_equal(few.states.length, whole.states.length[index])
    np.testing.assert_array_equal(recorded(few).known.rate, few.frames.rate)
    assert condensed(few) is few


def test_frames_at_rest_are_counted_with_the_one_before_them():
    few = condensed(filmed(1, FRAMES, still=30))
    assert few.frames.of == FRAMES
    assert few.frames.count[0] >= 25  # of 30; one in a hundred differs by chance
    assert few.frames.count[3:].max() < 6


def test_rates_follow_a_correction_of_the_lengths():
    campaign = condensed(filmed(1, FRAMES))
    by_words = {one.sentence: one.campaign for one in corrections(campaign)}
    in_mm = by_words["the lengths are in mm"].frames
    np.testing.assert_allclose(in_mm.rate, 1e-3 * campaign.frames.rate)
    swapped = by_words["the length channels of cables 1 and 3 are swapped"].frames
    np.testing.assert_array_equal(swapped.rate[:, [2, 1, 0, 3]], campaign.frames.rate)


def test_a_share_of_speed_is_seen_in_stretches_that_it_was_not_fitted_to():
    every = AllFrames.of(recorded(filmed(1, FRAMES)))
    pieces = np.array_split(np.arange(len(every.frames)), BLOCKS)
    speed = every.data.known.rate[every.frames, :, 0]
    shifts = len(circular_shifts(len(every.frames)))
    noise = LENGTH * np.random.default_rng(2).standard_normal(speed.shape)
    for law in (0.02 * speed, 0.02 * speed * np.abs(speed), 0.003 * np.sign(speed)):
        assert every.share_of_speed(law + noise, pieces) > 0.7
        assert every.p_of_speed(law + noise, pieces) == pytest.approx(1.0 / (shifts + 1))
    assert every.share_of_speed(noise, pieces) < 0.02
    assert every.p_of_speed(noise, pieces) > 0.05
    assert every.share_of_speed(noise, pieces[:1]) is None


@pytest.mark.parametrize(
    ("law", "straight"),
    [
        (lambda v: 0.03 * v, True),
        (lambda v: PLACE * np.sign(v), False),
        (lambda v: 0.03 * v * np.abs(v), False),
        (lambda v: 0.004 * np.tanh(v / 0.15), False),
        (lambda v: 0.01 * np.abs(v), False),
    ],
    ids=["a delay", "sign", "square", "saturation", "size"],
)
def test_what_bends_with_speed_is_no_delay(law, straight):
    """Beside an error of the place of a millimetre and a half."""
    place = of_the_place(1, 0.0015)
    every = AllFrames.of(recorded(filmed(1, error=lambda where, speed: place(where, speed) + law(speed))))
    assert bend_of_speed(every, every.errors(None)).matters != straight


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_few_frames_say_what_all_say(seed, monkeypatch):
    """The same name; the sizes differ by less than the sigma of the few."""
    campaign = filmed(seed, 90, delay=-0.03)
    few = diagnosed(campaign)
    monkeypatch.setattr(condensing, "FEWEST_KEPT", 90)
    every = diagnosed(campaign)
    assert every.recording.states == 90 > few.recording.states
    assert few.decision.classes == every.decision.classes == (("sensor_delay",),)
    own, other = few.sizes[0], every.sizes[0]
    assert abs(own.mean[0] - other.mean[0]) < own.sigma[0]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_stretches_with_independent_noise_agree(seed):
    said = diagnosed(filmed(seed, delay=-0.03))
    assert said.decision.classes == (("sensor_delay",),)
    assert said.recording.remainder is None
    assert 0.3 < said.recording.blocks.chi2_per_dof < 2.2  # 5 degrees of freedom: 98 % lie below 2.7; measured .8, 1.1
    assert said.sizes[0].mean[0] == pytest.approx(0.03, abs=3.0 * said.sizes[0].sigma[0])
    assert said.recording.held_out.named.max() < 0.4 * said.recording.held_out.refitted.min()


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_a_delay_is_named_beside_an_error_of_the_place(seed):
    said = diagnosed(filmed(seed, delay=-0.03, error=of_the_place(seed, PLACE)))
    assert (said.decision.status, said.decision.classes) == ("named", (("sensor_delay",),))
    assert said.recording.remainder.law
    assert said.sizes[0].mean[0] == pytest.approx(0.03, abs=3.0 * said.sizes[0].sigma[0])
    assert said.sizes[0].sigma[0] < 0.003
    assert said.recording.speed_share[0] > 0.5 > 0.1 > said.recording.speed_share[1]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    "more",
    [lambda v: 0.0 * v, lambda v: PLACE * np.sign(v), lambda v: 0.01 * np.abs(v), lambda v: 0.02 * v * np.abs(v)],
    ids=["place alone", "sign of the speed", "size of the speed", "square of the speed"],
)
def test_no_delay_is_named_where_another_law_of_motion_is_at_work(seed, more):
    said = diagnosed(filmed(seed, error=both(of_the_place(seed, PLACE), lambda place, speed: more(speed))))
    assert said.decision.status != "named"


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 4, 5])
@pytest.mark.parametrize(
    "more",
    [lambda v: PLACE * np.sign(v), lambda v: 0.03 * v * np.abs(v), lambda v: 0.004 * np.tanh(v / 0.15)],
    ids=["sign", "square", "saturation"],
)
def test_nor_where_that_law_is_larger_than_the_error_of_the_place(seed, more):
    """A delay takes up most of these; before errors were asked whether they bend with speed, 4 of 9 were named so."""
    said = diagnosed(filmed(seed, error=both(of_the_place(seed, 0.0015), lambda place, speed: more(speed))))
    assert said.decision.status != "named"


@pytest.mark.slow
def test_without_the_delay_in_the_library_no_other_name_is_given(monkeypatch):
    """Backlash takes up most of a delay, if directions are known; what it leaves is a function of speed."""
    campaign = filmed(1, delay=-0.03, error=of_the_place(1, PLACE))
    direction = -np.sign(length_rates(campaign.states)[..., 0])
    campaign = replace(campaign, states=replace(campaign.states, approach=direction))
    usual = search.testable

    def without(seen, checked):
        causes, hidden = usual(seen, checked)
        return [cause for cause in causes if cause.name not in ("sensor_delay", "clock_drift")], hidden

    monkeypatch.setattr(search, "testable", without)
    said = diagnosed(campaign)
    assert said.decision.status == "unknown"

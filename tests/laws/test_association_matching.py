"""Sums over partial matchings of peaks and modes: against enumeration, and what a matching must obey."""

import numpy as np
import pytest

from cdpr_struct.association.association import Association
from cdpr_struct.association.belief_propagation import bethe_matching, neighbours
from cdpr_struct.association.detection import clutter
from cdpr_struct.association.modes import PredictedModes, robot_modes
from cdpr_struct.association.one_to_one import exact_sums
from cdpr_struct.association.peak_noise import known_noise
from cdpr_struct.association.peaks import PeakList, padded
from cdpr_struct.association.subset_sum import subset_matching

NOISE = known_noise(np.tile([0.9, 0.06, 0.03, 0.01], (2, 1)), np.ones(2))
BAND = (2.0, 60.0)  # Hz
RULES = ("one_to_one", "exact", "poisson")


def enumerated(odds):
    """Probability of each pair and ln of the sum: every partial matching, written out."""
    total, pair = 0.0, np.zeros(odds.shape)

    def descend(peak, weight, taken):
        nonlocal total
        if peak == len(odds):
            total += weight
            for j, mu in taken:
                pair[j, mu] += weight
            return
        descend(peak + 1, weight, taken)
        for mu in set(range(odds.shape[1])) - {mu for _, mu in taken}:
            descend(peak + 1, weight * odds[peak, mu], [*taken, (peak, mu)])

    descend(0, 1.0, [])
    return pair / total, np.log(total)


def ln_likelihood(frequencies, modes, rule, variance=0.0, **lists):
    """ln L of one list with modes known up to a variance of ln f, and the pseudo-readings."""
    peaks = padded([PeakList(frequencies, np.full(len(frequencies), 0.003), BAND, **lists)])
    association = Association(peaks, modes, clutter(peaks, spurious=np.ones(1)), NOISE, rule=rule)
    nothing = np.zeros(modes.ln_frequency.shape)
    soft = association.expect(nothing, nothing + variance)
    return soft.constant - 0.5 * (soft.precision * (soft.value**2 + variance)).sum(), soft, association


def close_lists(count, peaks, modes):
    """Odds of lists whose modes lie at random, so that many are nearly double."""
    rng = np.random.default_rng(5)
    ln_frequency = rng.uniform(np.log(4.0), np.log(50.0), (count, modes))
    seen = ln_frequency[:, :peaks] + 0.004 * rng.standard_normal((count, peaks))
    z = (seen[:, :, None] - ln_frequency[:, None, :]) / 0.003
    odds = sum(w * np.exp(-0.5 * (z / k) ** 2) / k for w, k in ((0.9, 1), (0.06, 2), (0.03, 5), (0.01, 15))) * 100.0
    return odds, neighbours(ln_frequency, np.ones(ln_frequency.shape, bool))


@pytest.mark.parametrize("shape", [(1, 1), (1, 5), (4, 1), (2, 2), (3, 4), (4, 5), (4, 3)])
def test_subsets_sum_what_enumeration_does(shape):
    rng = np.random.default_rng(6)
    for _ in range(5):
        odds = np.exp(rng.normal(0.0, 4.0, shape)) * (rng.random(shape) < 0.8)
        pair, log_sum = subset_matching(odds)
        expected, total = enumerated(odds)
        np.testing.assert_allclose(pair, expected, atol=1e-12)  # rounding
        assert log_sum == pytest.approx(total, abs=1e-12)


def test_blocks_sum_what_the_whole_list_does():
    odds, slots = close_lists(4, 7, 9)
    pair, log_sum = exact_sums(odds, slots)
    for row, table in enumerate(odds):
        whole, total = subset_matching(table)
        np.testing.assert_allclose(pair[row], whole, atol=1e-6)  # pairs of odds below 1e-8 are left out
        assert log_sum[row] == pytest.approx(total, abs=1e-6)


@pytest.mark.parametrize("peaks", [1, 2, 3, 4])
def test_propagation_is_exact_for_two_modes(peaks):
    """Two modes and any peaks are a tree of one node; plain propagation errs by .7 nats on two by two."""
    odds = np.exp(np.random.default_rng(7).normal(3.0, 2.0, (peaks, 2)))
    pair, log_sum = bethe_matching(odds[None], np.array([[0, 1]]))
    expected, total = enumerated(odds)
    np.testing.assert_allclose(pair[0], expected, atol=1e-6)
    assert log_sum[0] == pytest.approx(total, abs=1e-6)
    if peaks == 2:
        assert bethe_matching(odds[None], np.array([[0, 2]]))[1][0] < total - 0.1


def test_propagation_is_close_to_the_sum_for_near_doubles():
    odds, slots = close_lists(24, 7, 30)
    pair, log_sum = bethe_matching(odds, slots)
    exact = [subset_matching(table) for table in odds]
    short = np.array([total for _, total in exact]) - log_sum
    assert short.min() > -1e-6  # a lower bound
    assert short.max() < 0.02  # measured 0.011; 0.44 with modes taken one by one
    assert max(np.abs(a - b[0]).max() for a, b in zip(pair, exact, strict=True)) < 0.02  # measured 0.011


@pytest.mark.parametrize("rule", RULES)
def test_likelihood_of_one_peak_integrates_to_the_probability_of_one_peak(rule):
    """One mode of P = .8, one spurious peak expected: the integral of L over the band is P(one peak)."""
    modes = robot_modes(np.log([[10.0]]), np.array([[0.8]]))
    grid = np.log(10.0) + np.append(-np.geomspace(1.6, 1e-5, 400), np.geomspace(1e-5, 1.79, 400))
    density = np.exp([ln_likelihood([f], modes, rule)[0] for f in np.exp(grid)])
    one = (0.2 + 0.8) * np.exp(-1.0) if rule != "poisson" else 1.8 * np.exp(-1.8)
    assert np.trapezoid(density, grid) == pytest.approx(one, rel=5e-3)  # trapezoids, and 0.3 % of the band's ends


@pytest.mark.parametrize("rule", RULES)
def test_order_of_peaks_and_modes_changes_nothing(rule):
    modes = np.log([[5.0, 9.9, 10.0, 10.04, 17.0]])
    seen = np.array([4.99, 10.02, 9.93, 30.0])
    reversed_value, reversed_soft, _ = ln_likelihood(
        seen[::-1], robot_modes(modes[:, ::-1], np.full((1, 5), 0.8)), rule
    )
    value, soft, _ = ln_likelihood(seen, robot_modes(modes, np.full((1, 5), 0.8)), rule)
    assert value == pytest.approx(reversed_value, abs=1e-6)  # tolerance of the propagation
    np.testing.assert_allclose(soft.precision, reversed_soft.precision[:, ::-1], rtol=1e-5)
    np.testing.assert_allclose(soft.value, reversed_soft.value[:, ::-1], atol=1e-8)


@pytest.mark.parametrize("rule", RULES)
def test_label_restricts(rule):
    """A peak at 10 Hz labelled as cable 1 does not read the mode of cable 0, nor one of the robot."""
    cable, order = np.array([[0, 1, 1, -1]]), np.array([[1, 1, 2, -1]])
    modes = PredictedModes(np.log([[10.0, 10.01, 10.02, 10.0]]), np.full((1, 4), 0.8), cable, order)
    free = ln_likelihood([10.0], modes, rule)[1]
    assert (free.precision > 1.0).all()
    by_cable = ln_likelihood([10.0], modes, rule, kind=1, cable=np.array([1]))[1]
    np.testing.assert_array_equal(by_cable.precision > 0.0, [[False, True, True, False]])
    by_order = ln_likelihood([10.0], modes, rule, kind=1, cable=np.array([1]), order=np.array([2]))[1]
    np.testing.assert_array_equal(by_order.precision > 0.0, [[False, False, True, False]])


@pytest.mark.parametrize("rule", RULES)
def test_cost_of_a_missing_and_of_a_spurious_peak(rule):
    modes = robot_modes(np.log([[5.0, 20.0]]), np.array([[0.8, 0.7]]))
    both, spurious, one = (ln_likelihood(f, modes, rule)[0] for f in ([5.0, 20.0], [5.0, 20.0, 55.0], [5.0]))
    density = 1.0 / np.log(BAND[1] / BAND[0])
    assert spurious - both == pytest.approx(np.log(density), abs=1e-3)  # wide scales reach 55 Hz a little
    height = np.sum([0.9, 0.06 / 2, 0.03 / 5, 0.01 / 15]) / (0.003 * np.sqrt(2.0 * np.pi))
    with_peak = np.log(density + 0.7 * height) if rule == "poisson" else np.log(0.3 * density + 0.7 * height)
    assert both - one == pytest.approx(with_peak - (0.0 if rule == "poisson" else np.log(0.3)), abs=1e-3)


@pytest.mark.parametrize("rule", RULES)
def test_assignment_is_continuous_where_modes_cross(rule):
    """Two modes pass each other below two peaks: halving the step halves the largest change of the readings."""
    peaks = padded([PeakList([9.97, 10.04], [0.003, 0.003], BAND)])
    modes = robot_modes(np.log([[10.0, 10.0, 10.5]]), np.full((1, 3), 0.8))
    association = Association(peaks, modes, clutter(peaks), NOISE, rule=rule)

    def precisions(steps):
        gaps = np.linspace(-0.01, 0.01, steps)
        found = [association.expect(np.array([[g, -g, 0.0]]), np.zeros((1, 3))) for g in gaps]
        return np.array([soft.precision[0] * (1.0 + 1e3 * soft.value[0]) for soft in found])

    coarse, fine = (np.abs(np.diff(precisions(n), axis=0)).max() for n in (201, 401))
    assert coarse / fine == pytest.approx(2.0, abs=0.1)
    np.testing.assert_allclose(*precisions(3)[1, :2], rtol=1e-9)  # at the crossing the two are alike
    np.testing.assert_allclose(precisions(3)[0, :2], precisions(3)[2, 1::-1], rtol=1e-5)  # they have changed places


@pytest.mark.parametrize("rule", RULES)
def test_list_of_another_pose_is_set_aside(rule):
    rng = np.random.default_rng(8)
    modes = robot_modes(np.log([[5.0, 8.0, 11.0, 15.0, 21.0, 30.0, 40.0]]), np.full((1, 7), 0.9))
    right = np.exp(modes.ln_frequency[0] + 0.003 * rng.standard_normal(7))
    for frequencies, own in ((right, 1.0), (1.13 * right, 0.0)):
        peaks = padded([PeakList(frequencies, np.full(7, 0.003), BAND)])
        association = Association(peaks, modes, clutter(peaks), NOISE, wrong_state=0.02, rule=rule)
        association.expect(np.zeros((1, 7)), np.zeros((1, 7)))
        assert association.assignment.own_state[0] == pytest.approx(own, abs=0.02)


@pytest.mark.parametrize("rule", RULES)
def test_a_list_without_peaks_is_evidence_and_no_list_is_none(rule):
    modes, nothing = robot_modes(np.log([[5.0, 20.0]]), np.array([[0.8, 0.7]])), np.zeros((1, 2))
    silent, soft, _ = ln_likelihood([], modes, rule)
    assert silent == pytest.approx(-1.0 - 1.5 if rule == "poisson" else -1.0 + np.log(0.2 * 0.3))
    np.testing.assert_array_equal(soft.precision, nothing)
    peaks = padded([])
    absent = PredictedModes(modes.ln_frequency, np.zeros((0, 2)), modes.cable, modes.order)
    soft = Association(peaks, absent, clutter(peaks), NOISE, rule=rule).expect(nothing, nothing)
    assert soft.constant == 0.0

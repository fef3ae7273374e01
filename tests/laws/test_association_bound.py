"""Peaks as soft readings: the bound they give to an inference, and its rise."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import expit

from cdpr_struct.association.association import Association
from cdpr_struct.association.detection import clutter
from cdpr_struct.association.modes import robot_modes
from cdpr_struct.association.peak_noise import SCALES, known_noise, stated_noise
from cdpr_struct.association.peaks import PeakList, padded
from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.scale_mixture import NoiseGroups

WEIGHT = np.array([0.9, 0.06, 0.03, 0.01])
BAND = (2.0, 60.0)  # Hz


def lists_of(rng, states=3, modes=8, shift=0.0, outliers=0):
    """Modes (K, M), and lists with a missing and a spurious peak each, the first few peaks 20 sd off."""
    ln_frequency = np.log(np.sort(rng.uniform(4.0, 40.0, (states, modes)), axis=1))
    lists = []
    for k in range(states):
        seen = rng.permutation(ln_frequency[k])[1:] + shift + 0.003 * rng.standard_normal(modes - 1)
        seen[:outliers] += 0.06 * rng.standard_normal(outliers)
        peaks = np.append(np.exp(seen), rng.uniform(*BAND))
        lists.append(PeakList(peaks, np.full(modes, 0.003), BAND, state=k, kind=k % 2))
    return padded(lists), robot_modes(ln_frequency, np.full((states, modes), 0.8))


def direct(peaks, modes, noise, spurious, mean):
    """ln L of the Poisson process by its formula, peak by peak."""
    total = 0.0
    for row, (state, kind) in enumerate(zip(peaks.state, peaks.kind, strict=True)):
        for y, s in zip(peaks.ln_frequency[row], peaks.sd[row], strict=True):
            intensity = spurious.density[row, 0]
            for mu, f in enumerate(modes.ln_frequency[state] + mean[state]):
                for weight, kappa in zip(noise.weight[kind], SCALES, strict=True):
                    sd = noise.tau[kind] * kappa * s
                    bell = np.exp(-0.5 * ((y - f) / sd) ** 2) / (np.sqrt(2.0 * np.pi) * sd)
                    intensity += modes.detection[row, mu] * weight * bell
            total += np.log(intensity)
        total -= modes.detection[row].sum() + spurious.expected[row]
    return total


def gaussian_fit(soft, prior_mean, prior_variance):
    """Posterior of independent modes, and ln integral prior exp(-w (value - f)^2 / 2)."""
    precision = 1.0 / prior_variance + soft.precision
    mean = (prior_mean / prior_variance + soft.precision * soft.value) / precision
    log_integral = -0.5 * np.log1p(prior_variance * soft.precision)
    log_integral -= 0.5 * (soft.value - prior_mean) ** 2 * soft.precision / (1.0 + prior_variance * soft.precision)
    return mean, 1.0 / precision, log_integral.sum()


def test_without_uncertainty_the_bound_is_the_likelihood():
    rng = np.random.default_rng(1)
    peaks, modes = lists_of(rng)
    noise, spurious = known_noise(np.stack([WEIGHT, WEIGHT[[0, 2, 1, 3]]]), [1.2, 0.9]), clutter(peaks)
    mean = 0.002 * rng.standard_normal(modes.ln_frequency.shape)
    soft = Association(peaks, modes, spurious, noise, rule="poisson").expect(mean, np.zeros_like(mean))
    bound = soft.constant - 0.5 * (soft.precision * (soft.value - mean) ** 2).sum()
    assert bound == pytest.approx(direct(peaks, modes, noise, spurious, mean), abs=1e-9)  # rounding


@pytest.mark.parametrize("predictive", [False, True])
def test_bound_stays_below_the_marginal_likelihood(predictive):
    """One mode, one state: the likelihood integrated over the prior of the mode on a grid."""
    peaks = padded([PeakList([9.96, 10.2, 10.05], [0.003] * 3, BAND)])
    modes, spurious = robot_modes(np.log([[10.0]]), np.array([[0.8]])), clutter(peaks)
    noise = known_noise(np.stack([WEIGHT, WEIGHT]), np.ones(2))
    grid = np.linspace(-0.1, 0.1, 4001)
    logs = np.array([direct(peaks, modes, noise, spurious, np.array([[x]])) for x in grid[::10]])
    prior_sd = 0.01
    prior = np.exp(-0.5 * (grid[::10] / prior_sd) ** 2) / (np.sqrt(2.0 * np.pi) * prior_sd)
    exact = np.log(np.trapezoid(prior * np.exp(logs - logs.max()), grid[::10])) + logs.max()
    association, mean, variance = (
        Association(peaks, modes, spurious, noise, rule="poisson"),
        np.zeros((1, 1)),
        np.full((1, 1), 1e-4),
    )
    for step in range(20):
        soft = association.expect(mean, variance, predictive=predictive and step == 0)
        mean, variance, log_integral = gaussian_fit(soft, np.zeros((1, 1)), np.full((1, 1), prior_sd**2))
        assert log_integral + soft.constant < exact
    assert log_integral + soft.constant > exact - 1.5  # three peaks, one mode: the assignment itself is in doubt


@pytest.mark.parametrize("rule", ["one_to_one", "exact", "poisson"])
@pytest.mark.parametrize("wrong_state", [0.0, 0.02])
def test_bound_rises_under_its_own_updates(wrong_state, rule):
    rng = np.random.default_rng(3)
    peaks, modes = lists_of(rng, shift=0.02, outliers=3)
    association = Association(peaks, modes, clutter(peaks), stated_noise(), wrong_state=wrong_state, rule=rule)
    shape = modes.ln_frequency.shape
    prior_mean, prior_variance = np.zeros(shape), np.full(shape, 0.015**2)
    mean, variance, bounds = prior_mean, prior_variance, []
    for step in range(25):
        soft = association.expect(mean, variance, predictive=step == 0)
        mean, variance, log_integral = gaussian_fit(soft, prior_mean, prior_variance)
        bounds.append(log_integral + soft.constant)
    assert np.diff(bounds).min() > -1e-9  # rounding
    assert bounds[-1] > bounds[0] + 1.0


def test_bound_of_predictive_densities_is_that_of_their_assignment():
    """One peak, one mode: expected ln L at the responsibilities that a wider mode would have, and their entropy."""
    y, s, v, detected, expected = np.log(10.05), 0.003, 0.004**2, 0.8, 1.0
    peaks = padded([PeakList([10.05], [s], BAND)])
    spurious, modes = (
        clutter(peaks, spurious=np.array([expected])),
        robot_modes(np.log([[10.0]]), np.array([[detected]])),
    )
    noise = known_noise(np.stack([WEIGHT, WEIGHT]), np.ones(2))
    association = Association(peaks, modes, spurious, noise, rule="poisson")
    soft = association.expect(np.zeros((1, 1)), np.full((1, 1), v), predictive=True)
    error, distance = (SCALES * s) ** 2, (y - np.log(10.0)) ** 2

    def emitted(variance):
        return detected * WEIGHT * np.exp(-0.5 * distance / variance) / np.sqrt(2.0 * np.pi * variance)

    stray = spurious.density[0, 0]
    r = np.append(emitted(error + v), stray) / (emitted(error + v).sum() + stray)
    expected_log = np.log(np.append(emitted(error), stray)) - np.append(0.5 * v / error, 0.0)
    bound = (r * (expected_log - np.log(r))).sum() - detected - expected
    assert soft.constant - 0.5 * float((soft.precision * (soft.value**2 + v)).sum()) == pytest.approx(bound, abs=1e-9)


def test_wrong_lists_mix_two_likelihoods():
    """ln((1 - p) L + p L elsewhere), list by list; elsewhere, as many peaks as expected lie anywhere in the band."""
    peaks, modes = lists_of(np.random.default_rng(6), shift=0.02)
    noise, spurious = known_noise(np.stack([WEIGHT, WEIGHT]), np.ones(2)), clutter(peaks)
    nothing = np.zeros(modes.ln_frequency.shape)
    right = Association(peaks, modes, spurious, noise)
    right.expect(nothing, nothing)
    own = right.assignment.matching.log_likelihood
    count = modes.detection.sum(axis=1) + spurious.expected
    elsewhere = peaks.count * np.log(count / np.log(BAND[1] / BAND[0])) - count
    prior = expit((own - elsewhere).mean())  # so that both matter
    expected = np.logaddexp(np.log1p(-prior) + own, np.log(prior) + elsewhere).sum()
    soft = Association(peaks, modes, spurious, noise, wrong_state=prior).expect(nothing, nothing)
    assert soft.constant - 0.5 * (soft.precision * soft.value**2).sum() == pytest.approx(expected, abs=1e-9)


def test_padding_and_modes_out_of_sight_carry_no_weight():
    rng = np.random.default_rng(4)
    peaks, modes = lists_of(rng, states=1)
    wide = robot_modes(
        np.append(modes.ln_frequency, [[0.0, peaks.ln_frequency[0, 0]]], axis=1), np.array([[0.8] * 8 + [0, 0]])
    )
    plain = Association(peaks, modes, clutter(peaks)).expect(np.zeros((1, 8)), np.full((1, 8), 1e-6))
    padded_soft = Association(peaks, wide, clutter(peaks)).expect(np.zeros((1, 10)), np.full((1, 10), 1e-6))
    np.testing.assert_array_equal(padded_soft.precision[0, 8:], 0.0)
    np.testing.assert_allclose(padded_soft.precision[:, :8], plain.precision, rtol=1e-12)
    assert padded_soft.constant == pytest.approx(plain.constant, abs=1e-9)


def test_fit_finds_a_shift_that_only_peaks_show():
    """Four states, ten modes each with its own sensitivity to one parameter; z = 1.5 moves them by up to 6 %."""
    rng = np.random.default_rng(9)
    states, modes, true = 4, 10, 1.5
    ln_frequency = np.sort(rng.uniform(np.log(4.0), np.log(40.0), (states, modes)), axis=1)
    slope = rng.uniform(0.0, 0.04, (states, modes))
    moved = np.exp(ln_frequency + true * slope + 0.003 * rng.standard_normal((states, modes)))
    seen = [row[rng.random(modes) < 0.85] for row in moved]
    lists = [PeakList(found, np.full(len(found), 0.003), BAND, state=k) for k, found in enumerate(seen)]
    peaks, predicted = padded(lists), robot_modes(ln_frequency, np.full((states, modes), 0.85))
    X = np.concatenate([np.zeros((states, 1, 1)), slope[:, :, None]], axis=1)  # first row: a reading that says nothing
    A, r = np.zeros((states, modes + 1, 1)), np.zeros((states, modes + 1))
    A[:, 0] = 1.0
    groups = NoiseGroups(np.zeros(states, int), np.ones(states))
    index, soft = np.arange(states)[:, None], np.arange(1, modes + 1)
    model = LinearModel((Stack(r, A, X, np.ones(r.shape), index, soft),), groups)
    still = LinearModel((replace(model.stacks[0], X=0.0 * X),), groups)
    association = Association(peaks, predicted, clutter(peaks))
    found = fit(model, soft=association)
    null = fit(still, soft=association.at(noise=stated_noise()))
    assert np.diff(found.bounds).min() > -1e-6  # tolerance of the propagation
    assert abs(found.z_mean[0] - true) < 4.0 * np.sqrt(found.z_covariance[0, 0])
    assert found.log_evidence > null.log_evidence + 10.0

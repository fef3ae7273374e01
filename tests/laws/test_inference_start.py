"""Where a fit begins: marginal likelihoods of scales are exact, and lead to a high maximum of the bound."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.inference.evidence import SETTLED, fit
from cdpr_struct.inference.extrapolation import extrapolated
from cdpr_struct.inference.joint_posterior import JointPosterior
from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.marginal_scales import scale_likelihood
from cdpr_struct.inference.scale_mixture import KAPPA, NoiseGroups, NoiseState, mixture_bound, updated_noise
from tests.laws.inference_cases import NO_ROWS, campaign, changed, dense_log_density


def interleaved():
    """Three groups of two readings each in every block, their readings in turns."""
    stack = campaign(3).stacks[0]
    index = np.tile(np.arange(3), 2) + 3 * np.arange(3)[:, None]
    return LinearModel((replace(stack, index=index),), NoiseGroups(np.arange(9) % 2, np.full(9, np.nan)))


def without_effect():
    """The same, the readings of the second group of each block without effect: their variance is that of the prior."""
    model = interleaved()
    A = model.stacks[0].A.copy()
    A[:, :, [1, 4]] = 0.0
    return changed(model, A=A)


@pytest.mark.parametrize(
    "model",
    [campaign(3), interleaved(), without_effect()],
    ids=["one joint group a block", "three", "one without effect"],
)
def test_likelihood_of_a_scale_is_the_ratio_of_dense_densities(model):
    groups, rng = model.groups, np.random.default_rng(3)
    readings = model.readings
    state = NoiseState.of(groups, rng.dirichlet(np.ones(len(KAPPA)), len(groups.kind)), np.array([1.3, 0.8]))
    joint = JointPosterior.of(model.white, readings.spread(state.variance), None, NO_ROWS)
    scales = np.array([0.5, 1.0, 3.0, 60.0])
    found = scale_likelihood(readings, state, joint, scales)
    for group in range(len(groups.kind)):
        changed = np.where(np.arange(len(groups.kind)) == group, scales[:, None] ** 2, state.variance)
        expected = dense_log_density(model, changed) - dense_log_density(model, state.variance)
        np.testing.assert_allclose(found[group], expected, atol=1e-9)


def spoilt(seed, share, factor):
    """12 states of 14 rows and 22 readings: sigma really `factor` times the stated, a share of groups 5 to 60 times."""
    rng, blocks, readings = np.random.default_rng(seed), 12, 22
    own = np.maximum(np.arange(readings) - 2, 0)
    index = own + (own[-1] + 1) * np.arange(blocks)[:, None]
    count = index.max() + 1
    kappa = np.where(rng.random(count) < share, rng.choice(KAPPA[2:], count), 1.0)
    A = rng.normal(size=(blocks, 14, readings))
    X = rng.normal(size=(blocks, 14, 60))
    u = factor * kappa[index] * rng.normal(size=index.shape)
    r = (A @ u[..., None])[..., 0] + X @ rng.normal(size=60)
    groups = NoiseGroups(np.tile(np.minimum(np.arange(own[-1] + 1), 1), blocks), np.full(count, np.nan))
    truth = NoiseState.of(groups, np.eye(len(KAPPA))[np.searchsorted(KAPPA, kappa)], np.full(2, factor))
    return LinearModel((Stack(r, A, X, np.full(r.shape, 1e-3), index, NO_ROWS),), groups), truth


@pytest.mark.parametrize(("share", "factor"), [(0.0, 3.0), (0.06, 1.0), (0.06, 2.0)])
def test_a_fit_without_a_start_is_as_good_as_one_from_the_true_scales(share, factor):
    """Mean over campaigns; from stated sigmas up to 27 nats are lost."""
    losses = []
    for seed in range(6):
        model, truth = spoilt(seed, share, factor)
        losses.append(fit(model, truth).log_evidence - fit(model).log_evidence)
    assert np.mean(losses) < 1.0
    assert max(losses) < 3.0  # the size of a decision


def test_missing_readings_and_readings_of_no_effect_do_not_disturb_the_start():
    model, _ = spoilt(1, 0.06, 1.0)
    missing = np.where(np.arange(len(model.groups.kind)) % 7 == 3, 1e8, np.nan)
    A = model.stacks[0].A.copy()
    A[:, :, 5] = 0.0
    groups = NoiseGroups(model.groups.kind, missing)
    found = fit(replace(changed(model, A=A), groups=groups))
    assert found.converged
    assert (np.diff(found.bounds) > -1e-9).all()
    assert found.noise.tau == pytest.approx(1.0, abs=0.3)


def plain_bounds(model, noise):
    """The bound after each plain step, until nothing changes."""
    readings, bounds = model.readings, []
    while len(bounds) < 2 or bounds[-1] - bounds[-2] > 1e-6:
        joint = JointPosterior.of(model.white, readings.spread(noise.variance), None, NO_ROWS)
        bounds.append(joint.parameters.log_evidence + mixture_bound(readings, noise))
        square = [mean**2 + variance for mean, variance in zip(joint.noise_mean, joint.noise_variance, strict=True)]
        noise = updated_noise(readings, noise, readings.sums(square))
    return np.array(bounds)


@pytest.mark.parametrize("factor", [0.3, 3.0])
def test_leaps_reach_the_maximum_of_plain_steps_in_half_of_them(factor):
    """Sigmas that are off and few rows make slow steps: most errors are known by their prior only, which follows."""
    model = campaign(2, (12, 3, 22, 20), kinds=1, floor=1e-3)
    model = changed(model, r=factor * model.stacks[0].r)
    noise = NoiseState.stated(model.groups)
    found, plain = fit(model, noise), plain_bounds(model, noise)
    stop = 1 + np.flatnonzero(np.diff(plain) < SETTLED)[0]
    assert found.converged
    assert (np.diff(found.bounds) > 0.0).all()
    assert plain[stop] < found.log_evidence < plain[-1] + 1e-6
    assert found.iterations < 0.5 * stop  # 8 of 33, 9 of 24


def test_a_leap_sums_a_geometric_series():
    end, way = np.array([2.0, -1.0, 0.5]), np.array([1.0, -2.0, 0.1])
    squares = [np.exp(end - way * 0.8**n) for n in range(4)]
    free = np.array([True, True, False])
    found = extrapolated(squares, free)
    np.testing.assert_allclose(found[:2], np.exp(end[:2]))
    assert found[2] == squares[-1][2]
    np.testing.assert_array_equal(extrapolated(squares[-3:], free), found)
    assert extrapolated(squares[:2], free) is None
    assert extrapolated([np.exp(end - way * 0.1**n) for n in range(3)], free) is None

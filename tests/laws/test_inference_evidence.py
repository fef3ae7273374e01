"""Evidence of a linear model: equal to the dense Gaussian, to sums over all scales, and to plain integration."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp

from cdpr_struct.inference.evidence import SETTLED, fit
from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.scale_mixture import KAPPA, PADDING, PSEUDO_COUNTS, NoiseGroups, NoiseState
from tests.laws.inference_cases import (
    NO_ROWS,
    campaign,
    changed,
    dense_log_density,
    enumerated_log_evidence,
    log_prior_tau,
)


@pytest.mark.parametrize("given", [1.0, 7.0])
@pytest.mark.parametrize("floor", [0.0, 0.3])
def test_gaussian_evidence_is_that_of_the_dense_normal_density(given, floor):
    model = campaign(1, shape=(4, 5, 7, 6), given=given, floor=floor)
    found = fit(model)
    assert found.log_evidence == pytest.approx(
        dense_log_density(model, np.full(len(model.groups.kind), given)), abs=1e-9
    )
    assert found.iterations == 2
    assert found.converged
    assert found.soft is None
    assert found.soft_mean.shape == found.soft_variance.shape == (0, 0)


def test_a_model_without_parameters_has_evidence():
    model = campaign(1, shape=(4, 5, 7, 0), given=2.0)
    exact = dense_log_density(model, np.full(len(model.groups.kind), 2.0))
    assert fit(model).log_evidence == pytest.approx(exact, abs=1e-9)
    with pytest.raises(ValueError, match="one_sided needs one entry"):
        fit(model, one_sided=np.array([True]))


def test_gaussian_posterior_is_that_of_one_least_squares_problem():
    """(u, z, e) jointly: rows r = A u + X z + floor e, priors N(0, variance), N(0, 1), N(0, 1)."""
    model = campaign(2, shape=(1, 4, 6, 3), given=3.0)
    stack = model.stacks[0]
    rows = np.hstack((stack.A[0] * np.sqrt(3.0), stack.X[0], np.diag(stack.floor[0])))
    gain = rows.T @ np.linalg.inv(rows @ rows.T)
    mean, covariance = gain @ stack.r[0], np.eye(rows.shape[1]) - gain @ rows
    found = fit(model)
    np.testing.assert_allclose(found.noise_mean[0][0], np.sqrt(3.0) * mean[:6], atol=1e-10)
    np.testing.assert_allclose(found.noise_variance[0][0], 3.0 * np.diag(covariance)[:6], atol=1e-10)
    np.testing.assert_allclose(found.z_mean, mean[6:9], atol=1e-10)
    np.testing.assert_allclose(found.z_covariance, covariance[6:9, 6:9], atol=1e-10)


@pytest.mark.parametrize("outlier", [0.0, 4.0, 20.0])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_bound_lies_below_the_sum_over_all_scales_and_close_to_it(seed, outlier):
    model = campaign(seed, shape=(2, 3, 3, 1), kinds=1, outlier=outlier)  # 4 groups, 625 combinations
    gap = enumerated_log_evidence(model) - fit(model).log_evidence
    assert 0.0 < gap < 0.5  # measured .05 to .47; .03 to 1.1 over 12 seeds and outliers of 0 to 20


def plain_integral(r, x, grids, draws=3000):
    """ln E over z (grid, half-normal or normal weight), tau (grid) and pi (drawn) of the mixture density of readings.

    r : (G, d) readings u + x z; x : (G, d, t). Nothing is integrated in closed form.
    """
    weights = np.random.default_rng(0).dirichlet(PSEUDO_COUNTS, draws)
    z = np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1).reshape(-1, len(grids))
    log_z = -0.5 * (z**2).sum(axis=1)
    log_tau = np.linspace(np.log(0.15), np.log(12.0), 23)
    square = ((r - np.einsum("gdt,zt->zgd", x, z)) ** 2).sum(axis=-1)
    total = []
    for tau in np.exp(log_tau):
        sigma = tau * KAPPA
        density = np.exp(-0.5 * square[..., None] / sigma**2) / (np.sqrt(2.0 * np.pi) * sigma) ** r.shape[1]
        total.append(logsumexp(np.log((density @ weights.T).prod(axis=1).mean(axis=1) + 1e-300) + log_z))
    return logsumexp(np.array(total) + log_prior_tau(log_tau)) - logsumexp(log_z) + np.log(log_tau[1] - log_tau[0])


def readings_model(r, x):
    """Group g is read as u_g + x_g z, in one block: A = I."""
    count, size = r.shape
    groups, index = NoiseGroups(np.zeros(count, int), np.full(count, np.nan)), np.repeat(np.arange(count), size)[None]
    A, X = np.eye(r.size)[None], x.reshape(1, r.size, -1)
    return LinearModel((Stack(r.reshape(1, -1), A, X, np.zeros((1, r.size)), index, NO_ROWS),), groups)


GRID = np.linspace(-5.0, 5.0, 81)
ONE = np.array([2.0, -1.0, 1.5, 1.0])[:, None, None]
TWO = np.array([[[2.0, 0.0], [0.0, 2.0]], [[1.0, 1.0], [1.0, -1.0]], [[0.0, 1.5], [2.0, 0.5]]])
PROBLEMS = {  # readings, change per parameter, one-sided, grids
    "an outlier of six": (np.array([[1.9], [-1.2], [7.5], [1.1]]), ONE, None, [GRID]),
    "a size that looks negative": (np.array([[-1.9], [1.2], [-1.5], [0.3]]), ONE, [True], [GRID[GRID >= 0]]),
    "joint readings, one off": (np.array([[1.0, -2.0], [9.0, 1.0], [-1.0, 1.0]]), TWO, None, [GRID[::2]] * 2),
}


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS)
def test_bound_lies_close_to_plain_integration(problem):
    r, x, one_sided, grids = problem
    gap = plain_integral(r, x, grids) - fit(readings_model(r, x), one_sided=one_sided).log_evidence
    assert 0.0 < gap < 0.4  # measured .33, .34, .31


@pytest.mark.parametrize("outlier", [0.0, 3.0, 5.0, 30.0])
@pytest.mark.parametrize("seed", range(5))
def test_the_bound_never_falls(seed, outlier):
    model = campaign(seed, shape=(6, 5, 8, 4), outlier=outlier)
    for one_sided in (None, np.arange(4) == 1):
        found = fit(model, one_sided=one_sided)
        assert found.converged
        assert (np.diff(found.bounds) > -1e-9).all()


def test_evidence_does_not_depend_on_any_order():
    model, rng = campaign(5, outlier=6.0), np.random.default_rng(5)
    stack = model.stacks[0]
    blocks, rows, columns = (rng.permutation(count) for count in stack.X.shape)
    names = rng.permutation(len(model.groups.kind))
    mixed = Stack(
        stack.r[blocks][:, rows],
        stack.A[blocks][:, rows],
        stack.X[blocks][:, rows][:, :, columns],
        stack.floor[blocks][:, rows],
        np.argsort(names)[stack.index[blocks]],
        NO_ROWS,
    )
    groups = NoiseGroups(model.groups.kind[names], model.groups.fixed_variance[names])
    one, other = fit(model), fit(LinearModel((mixed,), groups))
    assert other.log_evidence == pytest.approx(one.log_evidence, abs=1e-9)
    np.testing.assert_allclose(other.z_mean, one.z_mean[columns], atol=1e-9)
    np.testing.assert_allclose(other.noise.variance, one.noise.variance[names], rtol=1e-9)


def test_padding_and_equivalent_residuals_change_nothing():
    """More rows and readings of padding, and rows of other units mixed with each other."""
    model, rng = campaign(6, outlier=6.0, floor=0.0), np.random.default_rng(6)
    mix = rng.normal(size=(3, 4, 4))
    stack = model.stacks[0]
    padded = Stack(
        np.pad((mix @ stack.r[..., None])[..., 0], ((0, 0), (0, 3))),
        np.pad(mix @ stack.A, ((0, 0), (0, 3), (0, 2))),
        np.pad(mix @ stack.X, ((0, 0), (0, 3), (0, 0))),
        np.pad(stack.floor, ((0, 0), (0, 3)), constant_values=1.0),
        np.pad(stack.index, ((0, 0), (0, 2)), constant_values=PADDING),
        NO_ROWS,
    )
    one, other = fit(model), fit(replace(model, stacks=(padded,)))
    assert other.log_evidence == pytest.approx(one.log_evidence, abs=1e-8)
    np.testing.assert_allclose(other.z_mean, one.z_mean, atol=1e-8)


def test_a_missing_reading_is_a_dropped_row_up_to_a_constant():
    """Each row has one reading of its own; the constant is the same whatever the other data say."""
    differences = []
    for seed in (1, 2):
        rng = np.random.default_rng(seed)
        r, x = rng.normal(size=(6, 1)) + rng.normal(), rng.normal(size=(6, 1, 2))
        whole = readings_model(r, x)
        missing = np.where(np.arange(6) == 3, 1e8, np.nan)
        filled = replace(whole, groups=NoiseGroups(whole.groups.kind, missing))
        kept = np.arange(6) != 3
        with_missing, dropped = fit(filled), fit(readings_model(r[kept], x[kept]))
        np.testing.assert_allclose(with_missing.z_mean, dropped.z_mean, atol=1e-6)
        np.testing.assert_allclose(with_missing.noise.tau, dropped.noise.tau, rtol=1e-6)
        differences.append(with_missing.log_evidence - dropped.log_evidence)
    assert differences[0] == pytest.approx(differences[1], abs=1e-5)
    assert differences[0] == pytest.approx(-0.5 * np.log(2.0 * np.pi * 1e8), abs=1e-5)


def test_a_block_that_shares_nothing_adds_its_own_evidence_and_changes_nothing_else():
    """A block is repeated with readings of kinds of its own and no parameters."""
    model = campaign(7, outlier=6.0)
    stack, count, kinds = model.stacks[0], len(model.groups.kind), model.groups.kinds
    there = stack.index[:1]

    def groups(*kind):
        return NoiseGroups(np.concatenate(kind), np.full(sum(map(len, kind)), np.nan))

    own = Stack(stack.r[:1], stack.A[:1], 0.0 * stack.X[:1], stack.floor[:1], there, NO_ROWS)
    kind = model.groups.kind[: there.max() + 1]
    alone = LinearModel((own,), groups(kind))
    both = LinearModel((stack, replace(own, index=there + count)), groups(model.groups.kind, kind + kinds))
    one, other, total = fit(model), fit(alone), fit(both)
    assert total.log_evidence == pytest.approx(one.log_evidence + other.log_evidence, abs=2 * SETTLED)
    np.testing.assert_allclose(total.z_mean, one.z_mean, atol=0.02)  # as settled as the bound


def test_no_start_raises_the_bound_above_the_evidence():
    model = campaign(8, shape=(2, 2, 3, 1), kinds=1, outlier=5.0)
    truth, rng = enumerated_log_evidence(model), np.random.default_rng(8)
    for _ in range(20):
        responsibility = rng.dirichlet(np.ones(len(KAPPA)) * 0.3, len(model.groups.kind))
        start = NoiseState.of(model.groups, responsibility, np.exp(rng.normal(size=1)))
        found = fit(model, start)
        assert max(found.bounds) < truth
        assert (np.diff(found.bounds) > -1e-9).all()


def test_an_outlier_is_set_aside_and_the_estimates_stay():
    shape = (12, 14, 22, 10)
    clean, spoilt = campaign(9, shape=shape), campaign(9, shape=shape, outlier=20.0)
    one, other = fit(clean), fit(spoilt)
    group = spoilt.stacks[0].index[0, -1]
    assert other.noise.responsibility[group, 2:].sum() > 0.999
    assert np.delete(other.noise.responsibility[:, 0], group).min() > 0.5
    assert other.noise_mean[0][0, -1] == pytest.approx(one.noise_mean[0][0, -1] + 20.0, abs=1.0)
    shift = (other.z_mean - one.z_mean) / np.sqrt(np.diag(one.z_covariance))
    assert np.abs(shift).max() < 0.2  # measured .04; with Gaussian noise .8


def test_sigmas_that_are_twice_the_stated_are_found():
    model = campaign(10, shape=(18, 14, 22, 10), kinds=1)
    doubled = changed(model, A=0.5 * model.stacks[0].A, floor=0.5 * model.stacks[0].floor)
    assert fit(doubled).noise.tau == pytest.approx(2.0, rel=0.15)


def test_a_row_that_reads_one_parameter_counts_though_its_reading_is_zero():
    """Its floor is one and it holds no reading: no padding, since it says that the parameter is near zero."""
    model = campaign(1, given=2.0)
    r, A, X, floor = (getattr(model.stacks[0], name).copy() for name in ("r", "A", "X", "floor"))
    r[0, :2], floor[0, :2] = 0.0, 1.0
    A[0, 0], X[0, 0] = 0.0, [0.0, 3.0, 0.0]
    A[0, 1], X[0, 1] = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0], 0.0
    small = changed(model, r=r, A=A, X=X, floor=floor)
    exact = dense_log_density(small, np.full(len(model.groups.kind), 2.0))
    assert fit(small).log_evidence == pytest.approx(exact, abs=1e-9)


def test_a_group_without_readings_changes_nothing():
    model = campaign(2, outlier=6.0)
    more = NoiseGroups(np.append(model.groups.kind, 0), np.append(model.groups.fixed_variance, np.nan))
    one, other = fit(model), fit(replace(model, groups=more))
    assert other.log_evidence == pytest.approx(one.log_evidence, abs=1e-9)
    np.testing.assert_allclose(other.noise.variance[:-1], one.noise.variance, rtol=1e-9)


def test_what_a_model_holds_cannot_be_changed():
    """White rows and grouped readings are kept, so they would no longer be those of changed arrays."""
    model = LinearModel(list(campaign(1).stacks), campaign(1).groups)
    assert isinstance(model.stacks, tuple)
    stack, groups, readings = model.stacks[0], model.groups, model.readings
    held = [getattr(stack, name) for name in ("r", "A", "X", "floor", "index", "soft")]
    held += [groups.kind, groups.fixed_variance, readings.size, readings.members, readings.flat]
    assert not any(values.flags.writeable for values in held)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"r": np.full((3, 4), np.nan)}, "r must be finite"),
        ({"floor": -np.ones((3, 4))}, "floor must not be negative"),
        ({"X": np.zeros((3, 5, 2))}, "do not fit"),
        ({"A": np.zeros((3, 4, 5))}, "do not fit"),
        ({"soft": np.array([4])}, "soft must lie within"),
    ],
)
def test_a_model_that_does_not_fit_together_is_refused(change, message):
    with pytest.raises(ValueError, match=message):
        changed(campaign(1), **change)


def test_rows_without_noise_of_their_own_are_refused():
    model = campaign(1, floor=0.0)
    with pytest.raises(ValueError, match="floor a positive value"):
        fit(changed(model, A=np.repeat(model.stacks[0].A[:, :1], 4, axis=1)))


def test_stacks_that_do_not_fit_together_are_refused():
    model = campaign(1, soft=1)
    with pytest.raises(ValueError, match="at most may have soft rows"):
        LinearModel(model.stacks * 2, model.groups)
    other = campaign(1, shape=(3, 4, 6, 2)).stacks[0]
    with pytest.raises(ValueError, match="same number of parameters"):
        LinearModel((*model.stacks, other), model.groups)
    with pytest.raises(ValueError, match="index of readings"):
        changed(model, index=model.stacks[0].index + 1)


@pytest.mark.parametrize("start", [1.0, 1000.0])
def test_readings_far_beyond_their_sigmas_have_scales_that_settle(start):
    """A leap to scales so large that a variance, a difference, is rounding alone is no step: the bound seems higher."""
    model = campaign(4, shape=(30, 1, 1, 1), joint=1, kinds=1)
    wild = changed(model, r=start * model.stacks[0].r)
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        found = fit(wild, NoiseState.stated(model.groups))
    assert found.converged
    assert np.diff(found.bounds).min() > -SETTLED
    assert (found.noise_variance[0] > 0.0).all()

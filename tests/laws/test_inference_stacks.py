"""Blocks of unequal size, and noise beside that of the readings: the same evidence as in one dense matrix."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.inference.block_sums import BlockSums
from cdpr_struct.inference.evidence import bound_at, fit
from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.scale_mixture import KAPPA, PADDING, UNIT, NoiseGroups, NoiseState
from cdpr_struct.inference.screening import Screen, gains
from cdpr_struct.inference.soft_rows import SoftExpectation
from tests.laws.inference_cases import campaign, dense_log_density


def unequal(seed, given=np.nan, outlier=0.0, soft=0, parameters=5):
    """4 blocks of 3 rows, 2 of 6, 2 of 5 and soft ones; a group lies in the first and in the second stack."""
    first = campaign(seed, (4, 3, 5, parameters), outlier=outlier, given=given).stacks[0]
    second = campaign(seed + 100, (2, 6, 9, parameters), given=given).stacks[0]
    third = campaign(seed + 200, (2, 5, 7, parameters), given=given, soft=soft).stacks[0]
    starts = np.cumsum([0, first.index.max() + 1, second.index.max() + 1])
    stacks = [replace(s, index=s.index + start) for s, start in zip((first, second, third), starts, strict=True)]
    index = stacks[1].index.copy()
    index[1, :2] = stacks[0].index[2, -1]
    stacks[1] = replace(stacks[1], index=index)
    count = stacks[2].index.max() + 1
    return LinearModel(tuple(stacks), NoiseGroups(np.arange(count) % 2, np.full(count, given)))


def padded(model):
    """All blocks in one stack, hard rows first."""
    hard, soft = (max(size) for size in zip(*((s.hard.sum(), len(s.soft)) for s in model.stacks), strict=True))
    q = max(s.index.shape[1] for s in model.stacks)

    def rows(stack, values, fill=0.0):
        found = np.full((len(values), hard + soft, *values.shape[2:]), fill)
        found[:, : stack.hard.sum()] = values[:, stack.hard]
        found[:, hard : hard + len(stack.soft)] = values[:, stack.soft]
        return found

    def readings(values, fill=0):
        return np.pad(values, [*[(0, 0)] * (values.ndim - 1), (0, q - values.shape[-1])], constant_values=fill)

    stacks = [
        (rows(s, s.r), rows(s, readings(s.A)), rows(s, s.X), rows(s, s.floor, 1.0), readings(s.index, PADDING))
        for s in model.stacks
    ]
    arrays = [np.concatenate(parts) for parts in zip(*stacks, strict=True)]
    return LinearModel((Stack(*arrays, np.arange(hard, hard + soft)),), model.groups)


class Reading:
    """Soft rows of the last two blocks read .7, with a precision of 4."""

    def expect(self, mean, variance):
        read = np.arange(len(mean))[:, None] >= len(mean) - 2
        return SoftExpectation(np.full(mean.shape, 0.7), np.where(read, 4.0, 0.0) * np.ones(mean.shape), 0.0)


def test_evidence_of_unequal_blocks_is_that_of_one_dense_matrix():
    model = unequal(1, given=2.0)
    exact = dense_log_density(model, np.full(len(model.groups.kind), 2.0))
    assert fit(model).log_evidence == pytest.approx(exact, abs=1e-9)


@pytest.mark.parametrize("soft", [0, 3])
@pytest.mark.parametrize("sided", [None, np.array([True, False, True, False, False])])
def test_stacks_are_the_same_as_padding(soft, sided):
    model = unequal(2, outlier=8.0, soft=soft)
    wide = padded(model)
    one, other = (fit(m, soft=Reading() if soft else None, one_sided=sided) for m in (model, wide))
    assert one.log_evidence == pytest.approx(other.log_evidence, abs=1e-8)
    np.testing.assert_allclose(one.z_mean, other.z_mean, atol=1e-8)
    np.testing.assert_allclose(one.z_covariance, other.z_covariance, atol=1e-8)
    np.testing.assert_allclose(one.noise.variance, other.noise.variance, rtol=1e-7)
    start = 0
    for mean, variance in zip(one.noise_mean, one.noise_variance, strict=True):
        part = slice(start, start + len(mean)), slice(0, mean.shape[1])
        start += len(mean)
        np.testing.assert_allclose(mean, other.noise_mean[0][part], atol=1e-8)
        np.testing.assert_allclose(variance, other.noise_variance[0][part], atol=1e-8)
    if soft:
        np.testing.assert_allclose(one.soft_mean, other.soft_mean[-2:], atol=1e-8)
        np.testing.assert_allclose(one.soft_variance, other.soft_variance[-2:], atol=1e-8)


def test_candidates_over_stacks_gain_what_a_refit_does():
    model, rng = unequal(3, given=2.0), np.random.default_rng(3)
    columns = [rng.normal(size=(*stack.r.shape, 2)) for stack in model.stacks]
    screened = Screen.of(model, fit(model).noise).screened(columns)
    refit = fit(model.with_columns(columns)).log_evidence - fit(model).log_evidence
    assert gains(screened.gram, screened.score, np.ones(1))[0] == pytest.approx(refit, abs=1e-9)


def test_the_bound_at_given_scales_is_where_a_fit_from_them_begins():
    model, rng = unequal(4, outlier=8.0, soft=2), np.random.default_rng(4)
    responsibility = rng.dirichlet(np.ones(len(KAPPA)), len(model.groups.kind))
    state = NoiseState.of(model.groups, responsibility, np.array([0.8, 1.4]))
    read = Reading().expect(np.zeros((2, 2)), np.zeros((2, 2)))
    sided = np.arange(model.parameters) == 1
    found = fit(model, state, soft_start=read, one_sided=sided)
    assert bound_at(model, state, read, sided) == pytest.approx(found.bounds[0], abs=1e-9)
    only = fit(model, state, soft_start=read, one_sided=sided, most_steps=1)
    assert only.bounds == found.bounds[:1]
    assert not only.converged


def test_more_noise_is_more_covariance():
    """At the whitening of the readings, so that evidence with and without it compares."""
    model, rng = unequal(5, given=2.0), np.random.default_rng(5)
    more = [rng.normal(size=(*stack.r.shape, 3)) for stack in model.stacks]
    noisy = model.with_noise(more)
    count = len(model.groups.kind)
    known = [np.where(stack.index == UNIT, count, stack.index) for stack in noisy.stacks]
    dense = replace(
        noisy,
        stacks=tuple(replace(stack, index=index) for stack, index in zip(noisy.stacks, known, strict=True)),
        groups=NoiseGroups(np.append(model.groups.kind, 0), np.append(model.groups.fixed_variance, 1.0)),
    )

    def normaliser(m):
        own = (s.A @ s.A.swapaxes(1, 2) + np.eye(s.r.shape[1]) * s.floor[:, None] ** 2 for s in m.stacks)
        return 0.5 * sum(np.linalg.slogdet(part)[1].sum() for part in own)

    exact = dense_log_density(dense, np.append(np.full(count, 2.0), 1.0)) - normaliser(dense) + normaliser(model)
    found = fit(noisy)
    assert found.log_evidence == pytest.approx(exact, abs=1e-9)
    assert [mean.shape[1] for mean in found.noise_mean] == [stack.A.shape[2] + 3 for stack in model.stacks]


def test_more_noise_of_no_effect_changes_nothing_and_explains_what_is_there():
    """A state of the noise fits both models; noise of 20 in one channel is found in that channel."""
    model = unequal(6)
    plain = fit(model)
    nothing = [np.zeros((*stack.r.shape, 2)) for stack in model.stacks]
    same = fit(model.with_noise(nothing), plain.noise)
    assert same.log_evidence == pytest.approx(fit(model, plain.noise).log_evidence, abs=1e-9)
    rng = np.random.default_rng(6)
    channel = [np.eye(stack.r.shape[1])[:, :1] * np.ones((len(stack.r), 1, 1)) * 20.0 for stack in model.stacks]
    true = [rng.normal(size=(len(stack.r), 1)) for stack in model.stacks]
    r = [s.r + (c @ t[..., None])[..., 0] for s, c, t in zip(model.stacks, channel, true, strict=True)]
    spoilt = model.with_residual(r)
    found = fit(spoilt.with_noise(channel))
    assert found.log_evidence > fit(spoilt).log_evidence
    for mean, variance, known in zip(found.noise_mean, found.noise_variance, true, strict=True):
        assert (np.abs(mean[:, -1:] - known) < 4.0 * np.sqrt(variance[:, -1:])).all()
        assert (variance[:, -1] < 0.1).all()  # of a prior of one


def test_sums_of_a_block_are_those_of_its_dense_covariance():
    """Every block has noise of its own: c' S^-1 c, c' S^-1 r, and the spread of each row by noise and by z.

    One row has no reading and one parameter only.
    """
    model, known = unequal(7), 2
    A, X = model.stacks[0].A.copy(), model.stacks[0].X.copy()
    A[1, 2], X[1, 2, 1:] = 0.0, 0.0
    model = replace(model, stacks=(replace(model.stacks[0], A=A, X=X), *model.stacks[1:]))
    state = NoiseState.of(
        model.groups,
        np.random.default_rng(7).dirichlet(np.ones(len(KAPPA)), len(model.groups.kind)),
        np.array([0.7, 1.6]),
    )
    found = BlockSums.of(model, state, None, known)
    gram, score, sigma, block = [], [], [], []
    for stack in model.stacks:
        for r, A, X, floor, index in zip(stack.r, stack.A, stack.X, stack.floor, stack.index, strict=True):
            covariance = (A * state.variance[index]) @ A.T + np.diag(floor**2)
            weighed = np.linalg.solve(covariance, X)
            gram.append(X.T @ weighed)
            score.append(r @ weighed)
            sigma.append(np.sqrt(np.diag(covariance + X[:, :known] @ X[:, :known].T)))
            block.append(np.full(len(r), len(block)))
    np.testing.assert_allclose(found.gram, gram, rtol=1e-9)
    np.testing.assert_allclose(found.score, score, rtol=1e-9)
    np.testing.assert_allclose(found.sigma, np.concatenate(sigma), rtol=1e-12)
    np.testing.assert_array_equal(found.block, np.concatenate(block))
    np.testing.assert_array_equal(found.residual, np.concatenate([stack.r.ravel() for stack in model.stacks]))
    np.testing.assert_array_equal(found.columns, np.concatenate([s.X.reshape(-1, 5) for s in model.stacks]))


def test_soft_rows_have_the_spread_of_their_mixture_and_rows_that_are_not_read_an_infinite_one():
    """Precision 4 is a sigma of 1/2; rows of padding and soft rows of no precision say nothing."""
    model = padded(unequal(8, given=2.0, soft=2))
    stack, soft = model.stacks[0], model.stacks[0].soft
    read = Reading().expect(np.zeros((8, 2)), np.zeros((8, 2)))
    state = NoiseState.stated(model.groups)
    found, unread = (BlockSums.of(model, state, one, 1) for one in (read, None))
    by_noise = 2.0 * (stack.A**2).sum(axis=2) + stack.X[..., 0] ** 2
    expected = np.sqrt(by_noise + stack.floor**2)
    expected[:, soft] = np.sqrt(by_noise[:, soft] + 0.25)
    expected[:-2, soft] = np.inf
    expected[~stack.A.any(axis=2) & ~stack.X.any(axis=2)] = np.inf
    np.testing.assert_allclose(found.sigma.reshape(stack.r.shape), expected, rtol=1e-12)
    assert (found.residual.reshape(stack.r.shape)[:, soft] == 0.7).all()
    assert np.isinf(unread.sigma.reshape(stack.r.shape)[:, soft]).all()
    assert not unread.residual.reshape(stack.r.shape)[:, soft].any()
    np.testing.assert_array_equal(unread.sigma.reshape(stack.r.shape)[:, :6], found.sigma.reshape(stack.r.shape)[:, :6])

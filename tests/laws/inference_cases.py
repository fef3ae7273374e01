"""Small random campaigns for the laws of inference, and their evidence by brute force."""

import itertools
from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag
from scipy.special import gammaln, logsumexp

from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.scale_mixture import KAPPA, PSEUDO_COUNTS, TAU_DEGREES, NoiseGroups

NO_ROWS = np.zeros(0, int)


def campaign(seed, shape=(3, 4, 6, 3), joint=2, kinds=2, floor=0.1, outlier=0.0, given=np.nan, soft=0):
    """Blocks, rows, readings, parameters; the first `joint` readings of a block share a scale.

    outlier : errors added to the last reading of the first block [sigma]
    given   : variance of all readings if it is not to be inferred
    soft    : soft rows behind the hard ones
    """
    blocks, rows, readings, parameters = shape
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(blocks, rows + soft, readings))
    X = rng.normal(size=(blocks, rows + soft, parameters))
    u = rng.normal(size=(blocks, readings))
    u[0, -1] += outlier
    r = (A @ u[..., None])[..., 0] + X @ rng.normal(size=parameters)
    own = np.maximum(np.arange(readings) - joint + 1, 0)
    count = own[-1] + 1
    index = own + count * np.arange(blocks)[:, None]
    kind = np.tile(np.arange(count) % kinds, blocks)
    groups = NoiseGroups(kind, np.full(len(kind), given))
    soft_rows = np.arange(rows, rows + soft)
    r[:, soft_rows] = 0.0
    return LinearModel((Stack(r, A, X, np.full(r.shape, floor), index, soft_rows),), groups)


def changed(model, **change):
    """The model with other arrays in its first stack."""
    return replace(model, stacks=(replace(model.stacks[0], **change), *model.stacks[1:]))


def dense_log_density(model, variance):
    """ln N(r; 0, S) + ln|S at stated sigmas, z = 0|/2 of all rows in one matrix; group variances (..., G) to (...)."""
    A = block_diag(*(block for stack in model.stacks for block in stack.A))
    index, X = np.concatenate([stack.index.ravel() for stack in model.stacks]), whole(model, "X")
    r, noise = whole(model, "r"), np.diag(whole(model, "floor") ** 2)
    S = (A * variance[..., None, index]) @ A.T + X @ X.T + noise
    misfit = (r * np.linalg.solve(S, np.broadcast_to(r[:, None], (*S.shape[:-1], 1)))[..., 0]).sum(axis=-1)
    log_density = -0.5 * (np.linalg.slogdet(S)[1] + misfit + len(r) * np.log(2.0 * np.pi))
    return log_density + 0.5 * np.linalg.slogdet(A @ A.T + noise)[1]


def whole(model, name):
    """Rows of all blocks behind each other."""
    arrays = [getattr(stack, name) for stack in model.stacks]
    return np.concatenate([block for array in arrays for block in array])


def log_prior_tau(log_tau):
    """Density of ln tau where tau^2 is scaled inverse chi-squared around 1."""
    half = 0.5 * TAU_DEGREES
    return np.log(2.0) + half * np.log(half) - gammaln(half) - 2.0 * half * log_tau - half * np.exp(-2.0 * log_tau)


def enumerated_log_evidence(model, nodes=25):
    """Sum over every combination of kappa, quadrature over tau of one kind; pi integrated in closed form."""
    groups = model.groups
    choice = np.array(list(itertools.product(range(len(KAPPA)), repeat=len(groups.kind))))
    counts = np.eye(len(KAPPA))[choice].sum(axis=1)
    prior = (gammaln(PSEUDO_COUNTS + counts) - gammaln(PSEUDO_COUNTS)).sum(axis=1)
    prior += gammaln(PSEUDO_COUNTS.sum()) - gammaln(PSEUDO_COUNTS.sum() + len(groups.kind))
    log_tau, width = np.linspace(np.log(0.1), np.log(15.0), nodes, retstep=True)
    terms = [logsumexp(prior + dense_log_density(model, (KAPPA[choice] * np.exp(x)) ** 2)) for x in log_tau]
    return logsumexp(np.array(terms) + log_prior_tau(log_tau)) + np.log(width)

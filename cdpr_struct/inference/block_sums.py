"""What each block says of the parameters, noise integrated out: for predictions of blocks that were not fitted."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cdpr_struct.inference.joint_posterior import Marginal
from cdpr_struct.inference.linear_model import LinearModel, Stack
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.soft_rows import SoftExpectation


@dataclass(frozen=True, slots=True, eq=False)
class BlockSums:
    """Sums over the rows of each of K blocks, and the rows themselves, block by block.

    gram (K, t, t), score (K, t) : c' S^-1 c and c' S^-1 r of the columns c of z
    block (N,) : of each row;  residual (N,), columns (N, t)
    sigma (N,) : of a row by noise and by all of z under its prior; infinite where the row is not read
    """

    gram: np.ndarray
    score: np.ndarray
    block: np.ndarray
    residual: np.ndarray
    columns: np.ndarray
    sigma: np.ndarray

    @classmethod
    def of(cls, model: LinearModel, noise: NoiseState, soft: SoftExpectation | None, known: int) -> "BlockSums":
        """At given sizes of the noise; `known` of the parameters, the first, are free in `sigma`."""
        variance = model.readings.spread(noise.variance)
        marginal = Marginal.of(model.white, variance, soft)
        parts = [_of_stack(stack, own, soft, known) for stack, own in zip(model.stacks, variance, strict=True)]
        sizes = [stack.r.shape[1] for stack in model.stacks for _ in stack.r]
        block = np.repeat(np.arange(len(sizes)), sizes)
        first = np.concatenate([[0], np.cumsum(sizes)])
        columns = [marginal.X[a:b] for a, b in pairwise(first)]
        rows = [marginal.r[a:b] for a, b in pairwise(first)]
        return cls(
            np.stack([own.T @ own for own in columns]),
            np.stack([own.T @ r for own, r in zip(columns, rows, strict=True)]),
            block,
            np.concatenate([residual.ravel() for residual, _ in parts]),
            np.concatenate([stack.X.reshape((-1, model.parameters)) for stack in model.stacks]),
            np.concatenate([sigma.ravel() for _, sigma in parts]),
        )

    def without(self, blocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Precision (t, t), prior included, and score (t,) of z by all blocks but some."""
        rest = np.setdiff1d(np.arange(len(self.gram)), blocks)
        return np.eye(self.gram.shape[1]) + self.gram[rest].sum(axis=0), self.score[rest].sum(axis=0)

    def gain(self, own: np.ndarray, blocks: np.ndarray) -> float:
        """Log evidence [nat] that some numbers of z add to all others, without some blocks."""
        precision, score = self.without(blocks)
        others = np.setdiff1d(np.arange(len(score)), own)
        return _log(precision, score) - _log(precision[np.ix_(others, others)], score[others])


def _log(precision: np.ndarray, score: np.ndarray) -> float:
    factor = np.linalg.cholesky(precision)
    return float(0.5 * (np.linalg.solve(factor, score) ** 2).sum() - np.log(np.diagonal(factor)).sum())


def _of_stack(
    stack: Stack, variance: np.ndarray, soft: SoftExpectation | None, known: int
) -> tuple[np.ndarray, np.ndarray]:
    """Residual and sigma (K, n) of the rows of a stack; soft rows have the value and precision of their mixture."""
    residual = stack.r.copy()
    spread = (stack.A**2 @ variance[..., None])[..., 0] + (stack.X[..., :known] ** 2).sum(axis=-1) + stack.floor**2
    if len(stack.soft):
        residual[:, stack.soft] = 0.0 if soft is None else soft.value
        spread[:, stack.soft] -= stack.floor[:, stack.soft] ** 2
        read = np.zeros(residual[:, stack.soft].shape) if soft is None else soft.precision
        spread[:, stack.soft] += np.where(read > 0.0, 1.0 / np.where(read > 0.0, read, 1.0), np.inf)
    empty = ~stack.A.any(axis=2) & ~stack.X.any(axis=2)
    return residual, np.sqrt(np.where(empty, np.inf, spread))

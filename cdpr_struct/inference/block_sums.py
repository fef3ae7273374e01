"""What each block says of the parameters, noise integrated out: for predictions of blocks that were not fitted."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.joint_posterior import Marginal
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows


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
        variance = model.groups.spread(noise.variance)
        marginal = Marginal.of(WhiteRows.of(model), variance, soft)
        blocks, n, t = model.X.shape
        columns, r = marginal.X.reshape((blocks, n, t)), marginal.r.reshape((blocks, n))
        residual = model.r.copy()
        spread = (model.A**2 @ variance[..., None])[..., 0] + (model.X[..., :known] ** 2).sum(axis=-1) + model.floor**2
        if len(model.soft):
            residual[:, model.soft] = 0.0 if soft is None else soft.value
            spread[:, model.soft] -= model.floor[:, model.soft] ** 2
            read = np.zeros(residual[:, model.soft].shape) if soft is None else soft.precision
            spread[:, model.soft] += np.where(read > 0.0, 1.0 / np.where(read > 0.0, read, 1.0), np.inf)
        empty = ~model.A.any(axis=2) & ~model.X.any(axis=2)
        return cls(
            np.swapaxes(columns, 1, 2) @ columns,
            np.einsum("knt,kn->kt", columns, r),
            np.repeat(np.arange(blocks), n),
            residual.ravel(),
            model.X.reshape((-1, t)),
            np.sqrt(np.where(empty, np.inf, spread)).ravel(),
        )

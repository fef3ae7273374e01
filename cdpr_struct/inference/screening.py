"""By how much would more parameters raise the evidence, noise held as it is? Closed form, many candidates at once.

With noise and base parameters integrated out, columns c of a candidate enter through gram = c' S^-1 c and
score = c' S^-1 r only (Schur complement), for every prior size of the candidate.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.joint_posterior import Marginal, ParameterPosterior
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.positive_part import positive_part
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows


@dataclass(frozen=True, slots=True, eq=False)
class Screened:
    """All that the data say of D columns, at one noise state.

    gram  : (D, D)
    score : (D,)
    """

    gram: np.ndarray
    score: np.ndarray

    def take(self, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gram (..., d, d) and score (..., d) of some of the columns, indices (..., d)."""
        return self.gram[columns[..., :, None], columns[..., None, :]], self.score[columns]


@dataclass(frozen=True, slots=True, eq=False)
class Screen:
    """The base hypothesis at a noise state: rows, and what z takes out of them.

    rows, marginal, base : white rows, noise integrated out, posterior of z
    """

    rows: WhiteRows
    marginal: Marginal
    base: ParameterPosterior

    @classmethod
    def of(cls, model: LinearModel, noise: NoiseState, soft: SoftExpectation | None = None) -> "Screen":
        """Screen beside the parameters of `model`; put columns that are accepted already into it."""
        rows = model.white
        marginal = Marginal.of(rows, model.readings.spread(noise.variance), soft)
        return cls(rows, marginal, ParameterPosterior.of(marginal, rows.rows, np.zeros(0, int)))

    def screened(self, columns: Sequence[np.ndarray]) -> Screened:
        """Columns (K_i, n_i, D) per prior sigma, in the rows of the model, of one or many candidates."""
        white = np.empty((self.rows.count, columns[0].shape[2]))
        stacks = zip(self.rows.stacks, self.marginal.inverse, columns, self.rows.parts, strict=True)
        for stack, inverse, own, part in stacks:
            np.matmul(inverse @ stack.whitening, own, out=white[part].reshape(own.shape))
        explained = self.base.spread(white.T @ self.marginal.X)
        known = self.base.spread((self.marginal.r @ self.marginal.X)[None])[0]
        return Screened(white.T @ white - explained @ explained.T, self.marginal.r @ white - explained @ known)


def gains(gram: np.ndarray, score: np.ndarray, scales: np.ndarray, one_sided: np.ndarray | None = None) -> np.ndarray:
    """Log Bayes factor of candidates against the base at each prior size.

    Parameters
    ----------
    gram, score : (..., d, d), (..., d) of candidates with d columns each.
    scales : (S,) prior size in units of the columns' prior sigma, > 0.
    one_sided : (d,) mask of columns whose size cannot be negative.

    Returns
    -------
    (..., S) gain [nat], score'(I/s^2 + gram)^-1 score/2 - ln|I + s^2 gram|/2; one-sided columns add
    ln(2 P(size > 0)), for several of them ln(2^d P(all > 0)).
    """
    value, vector = np.linalg.eigh(gram)
    value, along = np.maximum(value, 0.0)[..., None, :], np.einsum("...ij,...i->...j", vector, score)[..., None, :]
    square = np.asarray(scales, dtype=float)[:, None] ** 2
    variance = square / (1.0 + square * value)
    gain = 0.5 * (variance * along**2 - np.log1p(square * value)).sum(axis=-1)
    sided = np.flatnonzero(np.zeros(gram.shape[-1], bool) if one_sided is None else one_sided)
    if not len(sided):
        return gain
    turned = vector[..., None, sided, :]
    mean = np.einsum("...ij,...j->...i", turned, variance * along)
    covariance = np.einsum("...ik,...k,...jk->...ij", turned, variance, turned)
    return gain + positive_part(mean, covariance).log_probability + len(sided) * np.log(2.0)

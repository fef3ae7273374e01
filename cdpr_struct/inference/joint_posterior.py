"""What do the data say of noise and parameters if every variance is known?

S_k = A_k diag(variance) A_k' + noise_k, one Cholesky factor per block; z by Woodbury. All blocks at once.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dtrtri

from cdpr_struct.inference.positive_part import positive_part
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows


@dataclass(frozen=True, slots=True, eq=False)
class Marginal:
    """Rows with the noise of the readings integrated out, white: r = X z + N(0, I).

    inverse        : (K, n, n) inverse Cholesky factor of S_k, soft rows scaled by the root of their precision
    scale          : (K, n) root of the precision of soft rows, 1 elsewhere
    A, X, r        : (K, n, q), (K n, t), (K n,)
    log_determinant: sum of ln |S_k|
    """

    inverse: np.ndarray
    scale: np.ndarray
    A: np.ndarray
    X: np.ndarray
    r: np.ndarray
    log_determinant: float

    @classmethod
    def of(cls, rows: WhiteRows, variance: np.ndarray, soft: SoftExpectation | None) -> "Marginal":
        """At given variances (K, q) of the readings; without `soft`, soft rows are not read."""
        scale = np.ones(rows.r.shape)
        r = rows.r
        if len(rows.soft):
            scale[:, rows.soft] = 0.0 if soft is None else np.sqrt(soft.precision)
            r = r.copy()
            r[:, rows.soft] = 0.0 if soft is None else scale[:, rows.soft] * soft.value
        A = scale[..., None] * rows.A if len(rows.soft) else rows.A
        factor = np.linalg.cholesky((A * variance[:, None]) @ A.swapaxes(1, 2) + rows.noise)
        inverse = np.linalg.inv(factor)
        return cls(
            inverse,
            scale,
            inverse @ A,
            cls._stacked(inverse, scale, rows.X),
            (inverse @ r[..., None]).ravel(),
            2.0 * float(np.log(np.einsum("kii->ki", factor)).sum()),
        )

    @staticmethod
    def _stacked(inverse: np.ndarray, scale: np.ndarray, columns: np.ndarray) -> np.ndarray:
        return ((inverse * scale[:, None]) @ columns).reshape(-1, columns.shape[2])

    def white(self, columns: np.ndarray) -> np.ndarray:
        """Columns (K, n, d) of white rows as columns (K n, d) here."""
        return self._stacked(self.inverse, self.scale, columns)


@dataclass(frozen=True, slots=True, eq=False)
class ParameterPosterior:
    """z ~ N(mean, root root'), some of it restricted to positive values by a change of the covariance.

    log_evidence : of the rows, z integrated out [nat]
    root         : (t, t)
    reach        : (t, d) change of z per change of its restricted entries
    change       : (d, d) what the restriction adds to the covariance of these entries
    """

    log_evidence: float
    mean: np.ndarray
    root: np.ndarray
    reach: np.ndarray
    change: np.ndarray

    @classmethod
    def of(cls, marginal: Marginal, rows: int, one_sided: np.ndarray) -> "ParameterPosterior":
        """Posterior for z ~ N(0, I); of entries `one_sided` (d,) only the positive half, doubled."""
        gram = marginal.X.T @ marginal.X
        factor = np.linalg.cholesky(gram + np.eye(len(gram)))
        root = np.triu(dtrtri(factor, lower=1)[0].T)
        score = root.T @ (marginal.X.T @ marginal.r)
        misfit = marginal.r @ marginal.r - score @ score
        determinant = marginal.log_determinant + 2.0 * np.log(np.diag(factor)).sum()
        log_evidence = -0.5 * float(misfit + determinant + rows * np.log(2.0 * np.pi))
        free = cls(log_evidence, root @ score, root, np.zeros((len(gram), 0)), np.zeros((0, 0)))
        return free._positive(one_sided) if len(one_sided) else free

    def _positive(self, one_sided: np.ndarray) -> "ParameterPosterior":
        beside = self.root @ self.root[one_sided].T
        covariance = beside[one_sided]
        part = positive_part(self.mean[one_sided], covariance)
        reach = np.linalg.solve(covariance, beside.T).T
        mean = self.mean + reach @ (part.mean - self.mean[one_sided])
        log_evidence = self.log_evidence + part.log_probability + len(one_sided) * np.log(2.0)
        return ParameterPosterior(log_evidence, mean, self.root, reach, part.covariance - covariance)

    def variance(self, rows: np.ndarray) -> np.ndarray:
        """Variance of rows @ z, for rows (..., t)."""
        spread = np.einsum("...i,...i->...", *(2 * [rows @ self.root]))
        if not self.change.size:
            return spread
        restricted = rows @ self.reach
        return spread + np.einsum("...i,...i->...", restricted @ self.change, restricted)

    def spread(self, rows: np.ndarray) -> np.ndarray:
        """Covariance (..., q, q) of rows @ z, for rows (..., q, t)."""
        turned = rows @ self.root
        covariance = turned @ turned.swapaxes(-1, -2)
        if not self.change.size:
            return covariance
        restricted = rows @ self.reach
        return covariance + restricted @ self.change @ restricted.swapaxes(-1, -2)

    @property
    def covariance(self) -> np.ndarray:
        """(t, t)"""
        return self.root @ self.root.T + self.reach @ self.change @ self.reach.T


@dataclass(frozen=True, slots=True, eq=False)
class JointPosterior:
    """Posterior of noise and parameters at given variances.

    parameters       : of z
    noise_mean       : (K, q) of u, in units of stated sigmas
    noise_covariance : (K, q, q) within each block
    soft_mean        : (K, s) prediction of the soft rows
    soft_variance    : (K, s)
    """

    parameters: ParameterPosterior
    noise_mean: np.ndarray
    noise_covariance: np.ndarray
    soft_mean: np.ndarray
    soft_variance: np.ndarray

    @classmethod
    def of(
        cls, rows: WhiteRows, variance: np.ndarray, soft: SoftExpectation | None, one_sided: np.ndarray
    ) -> "JointPosterior":
        """At given variances (K, q) of the readings; without `soft`, soft rows are not read."""
        marginal = Marginal.of(rows, variance, soft)
        parameters = ParameterPosterior.of(marginal, rows.rows, one_sided)
        blocks, n = rows.r.shape
        rest = (marginal.r - marginal.X @ parameters.mean).reshape(blocks, n, 1)
        turned = marginal.A.swapaxes(1, 2)
        noise_mean = variance * (turned @ rest)[..., 0]
        carried = variance[..., None] * (turned @ marginal.X.reshape(blocks, n, -1))
        known = variance[..., None] * turned
        noise_covariance = parameters.spread(carried) - known @ known.swapaxes(1, 2)
        np.einsum("kii->ki", noise_covariance)[...] += variance
        A, X = rows.A[:, rows.soft], rows.X[:, rows.soft]
        soft_mean = (A @ noise_mean[..., None])[..., 0] + X @ parameters.mean
        scaled = A * variance[:, None]
        seen = scaled @ turned
        own = np.einsum("ksq,ksq->ks", scaled, A) - np.einsum("ksn,ksn->ks", seen, seen)
        soft_variance = own + parameters.variance(X - A @ carried)
        return cls(parameters, noise_mean, noise_covariance, soft_mean, soft_variance)

    @property
    def noise_variance(self) -> np.ndarray:
        """(K, q)"""
        return np.einsum("kii->ki", self.noise_covariance)

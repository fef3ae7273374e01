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
        return ((inverse * scale[:, None]) @ columns).reshape(scale.size, columns.shape[2])

    def white(self, columns: np.ndarray) -> np.ndarray:
        """Columns (K, n, d) of white rows as columns (K n, d) here."""
        return self._stacked(self.inverse, self.scale, columns)


@dataclass(frozen=True, slots=True, eq=False)
class ParameterPosterior:
    """z with mean and covariance root root'.

    log_evidence : of the rows, z integrated out [nat]
    mean, root   : (t,), (t, t)
    """

    log_evidence: float
    mean: np.ndarray
    root: np.ndarray

    @classmethod
    def of(cls, marginal: Marginal, rows: int, one_sided: np.ndarray) -> "ParameterPosterior":
        """Posterior for z ~ N(0, I); of entries `one_sided` (d,) only the positive half, doubled."""
        gram = marginal.X.T @ marginal.X
        factor = np.linalg.cholesky(gram + np.eye(len(gram)))
        root = np.triu(dtrtri(factor, lower=1)[0].T) if len(gram) else gram
        score = root.T @ (marginal.X.T @ marginal.r)
        misfit = marginal.r @ marginal.r - score @ score
        determinant = marginal.log_determinant + 2.0 * np.log(np.diag(factor)).sum()
        log_evidence = -0.5 * float(misfit + determinant + rows * np.log(2.0 * np.pi))
        free = cls(log_evidence, root @ score, root)
        return free._positive(one_sided) if len(one_sided) else free

    def _positive(self, entries: np.ndarray) -> "ParameterPosterior":
        """Restricted to positive values of some entries; the others follow by regression on them."""
        basis, factor = np.linalg.qr(self.root[entries].T)
        covariance = factor.T @ factor
        part = positive_part(self.mean[entries], covariance)
        carried = self.root @ basis
        shift = carried @ np.linalg.solve(factor.T, part.mean - self.mean[entries])
        half = np.linalg.solve(factor.T, part.covariance)
        shrinkage = np.linalg.cholesky(np.linalg.solve(factor.T, half.T)) - np.eye(len(entries))
        log_evidence = self.log_evidence + float(part.log_probability) + len(entries) * np.log(2.0)
        return ParameterPosterior(log_evidence, self.mean + shift, self.root + carried @ shrinkage @ basis.T)

    @property
    def covariance(self) -> np.ndarray:
        """(t, t)"""
        return self.root @ self.root.T


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
        known = variance[..., None] * marginal.A.swapaxes(1, 2)  # u = known (r - X z), and what is not known of it
        spread = known @ (marginal.X @ parameters.root).reshape(blocks, n, len(parameters.mean))
        noise_mean = (known @ rest)[..., 0]
        noise_covariance = spread @ spread.swapaxes(1, 2) - known @ known.swapaxes(1, 2)
        np.einsum("kii->ki", noise_covariance)[...] += variance
        A, X = rows.A[:, rows.soft], rows.X[:, rows.soft]
        soft_mean = (A @ noise_mean[..., None])[..., 0] + X @ parameters.mean
        reached = X @ parameters.root - A @ spread
        seen = A @ known
        soft_variance = (A**2 @ variance[..., None])[..., 0] - (seen**2).sum(axis=2) + (reached**2).sum(axis=2)
        return cls(parameters, noise_mean, noise_covariance, soft_mean, soft_variance)

    @property
    def noise_variance(self) -> np.ndarray:
        """(K, q)"""
        return np.einsum("kii->ki", self.noise_covariance)

"""What do the data say of noise and parameters if every variance is known?

S_k = A_k diag(variance) A_k' + noise_k, one Cholesky factor per block; z by Woodbury. X' S^-1 X is one product over the
rows of all blocks; of the covariance of u, only the diagonal is computed.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.blas import dtrmm
from scipy.linalg.lapack import dtrtri

from cdpr_struct.inference.positive_part import positive_part
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows, WhiteStack, inverse_factor


@dataclass(frozen=True, slots=True, eq=False)
class Marginal:
    """Rows with the noise of the readings integrated out, white: r = X z + N(0, I). N counts the rows of all blocks.

    inverse        : (K, n, n) a stack, inverse Cholesky factor of S_k, soft rows scaled by the root of their precision
    A              : (K, n, q) a stack
    X, r           : (N, t), (N,)
    parts          : where the rows of each stack stand in them
    log_determinant: sum of ln |S_k|
    """

    inverse: tuple[np.ndarray, ...]
    A: tuple[np.ndarray, ...]
    X: np.ndarray
    r: np.ndarray
    parts: tuple[slice, ...]
    log_determinant: float

    @classmethod
    def of(cls, rows: WhiteRows, variance: Sequence[np.ndarray], soft: SoftExpectation | None) -> "Marginal":
        """At given variances (K_i, q_i) of the readings; without `soft`, soft rows are not read."""
        X, r = np.empty((rows.count, rows.parameters)), np.empty(rows.count)
        inverses, noises, determinant = [], [], 0.0
        for stack, own, part in zip(rows.stacks, variance, rows.parts, strict=True):
            residual, inverse, log_determinant = _noise_integrated_out(stack, own, soft)
            np.matmul(inverse, stack.X, out=X[part].reshape(stack.X.shape))
            np.matmul(inverse, residual[..., None], out=r[part].reshape((*residual.shape, 1)))
            inverses.append(inverse)
            noises.append(inverse @ stack.A)
            determinant += log_determinant
        return cls(tuple(inverses), tuple(noises), X, r, rows.parts, determinant)


def _noise_integrated_out(
    stack: WhiteStack, variance: np.ndarray, soft: SoftExpectation | None
) -> tuple[np.ndarray, np.ndarray, float]:
    """Residual (K, n) and inverse factor (K, n, n) that make rows white at a variance (K, q), and sum of ln |S_k|."""
    r, A, scale = stack.r, stack.A, None
    if len(stack.soft):
        scale = np.ones(r.shape)
        scale[:, stack.soft] = 0.0 if soft is None else np.sqrt(soft.precision)
        r = r.copy()
        r[:, stack.soft] = 0.0 if soft is None else soft.value
        A = scale[..., None] * A
    A = A * np.sqrt(variance)[:, None]
    factor = np.linalg.cholesky(A @ A.swapaxes(1, 2) + stack.noise)
    inverse = inverse_factor(factor)
    if scale is not None:
        inverse *= scale[:, None]
    return r, inverse, 2.0 * float(np.log(np.einsum("kii->ki", factor)).sum())


@dataclass(frozen=True, slots=True, eq=False)
class ParameterPosterior:
    """z with mean and covariance root root', root = factor (I + basis shrinkage basis').

    log_evidence     : of the rows, z integrated out [nat]
    mean             : (t,)
    factor           : (t, t) upper triangular, the root before signs are known
    basis, shrinkage : (t, d), (d, d) what d known signs do
    """

    log_evidence: float
    mean: np.ndarray
    factor: np.ndarray
    basis: np.ndarray
    shrinkage: np.ndarray

    @classmethod
    def of(cls, marginal: Marginal, rows: int, one_sided: np.ndarray) -> "ParameterPosterior":
        """Posterior for z ~ N(0, I); of entries `one_sided` (d,) only the positive half, doubled."""
        precision = marginal.X.T @ marginal.X
        t = len(precision)
        precision.flat[:: t + 1] += 1.0
        root = dtrtri(np.linalg.cholesky(precision).T)[0] if t else precision
        score = (marginal.r @ marginal.X) @ root
        misfit = marginal.r @ marginal.r - score @ score
        determinant = marginal.log_determinant - 2.0 * np.log(np.diag(root)).sum()
        log_evidence = -0.5 * float(misfit + determinant + rows * np.log(2.0 * np.pi))
        free = cls(log_evidence, root @ score, root, np.zeros((t, 0)), np.zeros((0, 0)))
        return free._positive(one_sided) if len(one_sided) else free

    def _positive(self, entries: np.ndarray) -> "ParameterPosterior":
        """Restricted to positive values of some entries; the others follow by regression on them."""
        basis, factor = np.linalg.qr(self.factor[entries].T)
        part = positive_part(self.mean[entries], factor.T @ factor)
        shift = self.factor @ (basis @ np.linalg.solve(factor.T, part.mean - self.mean[entries]))
        half = np.linalg.solve(factor.T, part.covariance)
        shrinkage = np.linalg.cholesky(np.linalg.solve(factor.T, half.T)) - np.eye(len(entries))
        log_evidence = self.log_evidence + float(part.log_probability) + len(entries) * np.log(2.0)
        return ParameterPosterior(log_evidence, self.mean + shift, self.factor, basis, shrinkage)

    def spread(self, columns: np.ndarray) -> np.ndarray:
        """columns root, (..., t): the covariance of columns z is this times its transpose. May overwrite columns."""
        if not columns.size:
            return columns
        flat = columns.reshape(-1, columns.shape[-1])
        found = dtrmm(1.0, self.factor, flat.T, trans_a=True, overwrite_b=True).T
        if self.basis.shape[1]:
            found = found + (found @ self.basis) @ self.shrinkage @ self.basis.T
        spread: np.ndarray = found.reshape(columns.shape)
        return spread

    @property
    def covariance(self) -> np.ndarray:
        """(t, t)"""
        root = self.spread(np.eye(len(self.mean)))
        return root @ root.T


@dataclass(frozen=True, slots=True, eq=False)
class JointPosterior:
    """Posterior of noise and parameters at given variances, values per reading (K, q) a stack.

    marginal       : rows that it follows from
    parameters     : of z
    variance       : the given ones
    noise_mean     : of u, in units of stated sigmas
    noise_variance : of u
    soft_mean      : (K, s) prediction of the soft rows; (0, 0) without any
    soft_variance  : (K, s)
    """

    marginal: Marginal
    parameters: ParameterPosterior
    variance: tuple[np.ndarray, ...]
    noise_mean: tuple[np.ndarray, ...]
    noise_variance: tuple[np.ndarray, ...]
    soft_mean: np.ndarray
    soft_variance: np.ndarray

    @classmethod
    def of(
        cls, rows: WhiteRows, variance: tuple[np.ndarray, ...], soft: SoftExpectation | None, one_sided: np.ndarray
    ) -> "JointPosterior":
        """At given variances (K_i, q_i) of the readings; without `soft`, soft rows are not read."""
        marginal = Marginal.of(rows, variance, soft)
        parameters = ParameterPosterior.of(marginal, rows.rows, one_sided)
        rest = marginal.r - marginal.X @ parameters.mean
        means, variances, seen = [], [], (np.zeros((0, 0)), np.zeros((0, 0)))
        for i, (stack, own) in enumerate(zip(rows.stacks, variance, strict=True)):
            gain, carried = _gain_and_carried(marginal, parameters, own, i)
            mean = (rest[marginal.parts[i]].reshape(stack.r.shape)[:, None] @ gain)[:, 0]
            means.append(mean)
            known = np.einsum("knq,knq->kq", gain, gain)
            variances.append(own - known + np.einsum("kqt,kqt->kq", carried, carried))
            if len(stack.soft):
                seen = _predicted(stack, parameters, own, mean, gain, carried)
        return cls(marginal, parameters, variance, tuple(means), tuple(variances), *seen)

    def covariance(self, stack: int, chosen: np.ndarray) -> np.ndarray:
        """(K, p, p) of the errors u of some readings (p,) of a stack."""
        own = self.variance[stack]
        gain, carried = _gain_and_carried(self.marginal, self.parameters, own, stack, chosen)
        found = carried @ carried.swapaxes(1, 2) - gain.swapaxes(1, 2) @ gain
        np.einsum("kii->ki", found)[...] += own[:, chosen]
        return found


def _gain_and_carried(
    marginal: Marginal,
    parameters: ParameterPosterior,
    variance: np.ndarray,
    stack: int,
    chosen: np.ndarray | slice = slice(None),
) -> tuple[np.ndarray, np.ndarray]:
    """gain (K, n, q) = A diag(variance) and gain' X root (K, q, t): u = gain' (r - X z), known but for
    variance - gain' gain; of some readings only."""
    gain = marginal.A[stack][:, :, chosen] * variance[:, None, chosen]
    X = marginal.X[marginal.parts[stack]].reshape((*gain.shape[:2], marginal.X.shape[1]))
    return gain, parameters.spread(gain.swapaxes(1, 2) @ X)


def _predicted(
    stack: WhiteStack,
    parameters: ParameterPosterior,
    variance: np.ndarray,
    noise_mean: np.ndarray,
    gain: np.ndarray,
    carried: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Mean and variance (K, s) of what soft rows read."""
    A, X = stack.A[:, stack.soft], stack.X[:, stack.soft]
    mean = (A @ noise_mean[..., None])[..., 0] + X @ parameters.mean
    seen = A @ gain.swapaxes(1, 2)
    reached = parameters.spread(X) - A @ carried
    by_noise = (A**2 @ variance[..., None])[..., 0] - np.einsum("ksn,ksn->ks", seen, seen)
    return mean, by_noise + np.einsum("kst,kst->ks", reached, reached)

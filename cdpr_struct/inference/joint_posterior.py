"""What do the data say of noise and parameters if every variance is known?

S_k = A_k diag(variance) A_k' + noise_k, one Cholesky factor per block; z by Woodbury. X' S^-1 X is one product over the
rows of all blocks, and what z adds to the variance of u one triangular solution over all readings.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.blas import dtrsm

from cdpr_struct.inference.positive_part import positive_part
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows, WhiteStack, inverse_factor


@dataclass(frozen=True, slots=True, eq=False)
class Marginal:
    """Rows with the noise of the readings integrated out, white: r = X z + N(0, I). N counts the rows of all blocks.

    inverse        : (K, n, n) a stack, inverse Cholesky factor of S_k, soft rows scaled by the root of their precision
    A              : (K, n, q) a stack
    X, r           : (N, t), (N,)
    log_determinant: sum of ln |S_k|
    """

    inverse: tuple[np.ndarray, ...]
    A: tuple[np.ndarray, ...]
    X: np.ndarray
    r: np.ndarray
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
        return cls(tuple(inverses), tuple(noises), X, r, determinant)


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
    """z with mean and covariance root root', root = L'^-1 (I + basis shrinkage basis').

    log_evidence     : of the rows, z integrated out [nat]
    mean             : (t,)
    factor           : (t, t) L, Cholesky factor of the precision before signs are known
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
        gram = marginal.X.T @ marginal.X
        t = len(gram)
        gram.flat[:: t + 1] += 1.0
        factor = np.linalg.cholesky(gram)
        score = _solved(factor, (marginal.r @ marginal.X)[None])
        misfit = marginal.r @ marginal.r - (score**2).sum()
        determinant = marginal.log_determinant + 2.0 * np.log(np.diag(factor)).sum()
        log_evidence = -0.5 * float(misfit + determinant + rows * np.log(2.0 * np.pi))
        mean = _solved(factor, score, transposed=True)[0]
        free = cls(log_evidence, mean, factor, np.zeros((t, 0)), np.zeros((0, 0)))
        return free._positive(one_sided) if len(one_sided) else free

    def _positive(self, entries: np.ndarray) -> "ParameterPosterior":
        """Restricted to positive values of some entries; the others follow by regression on them."""
        basis, factor = np.linalg.qr(_solved(self.factor, np.eye(len(self.mean))[entries]).T)
        part = positive_part(self.mean[entries], factor.T @ factor)
        step = basis @ np.linalg.solve(factor.T, part.mean - self.mean[entries])
        half = np.linalg.solve(factor.T, part.covariance)
        shrinkage = np.linalg.cholesky(np.linalg.solve(factor.T, half.T)) - np.eye(len(entries))
        log_evidence = self.log_evidence + float(part.log_probability) + len(entries) * np.log(2.0)
        mean = self.mean + _solved(self.factor, step[None], transposed=True)[0]
        return ParameterPosterior(log_evidence, mean, self.factor, basis, shrinkage)

    def spread(self, columns: np.ndarray) -> np.ndarray:
        """columns root, (p, t): the covariance of columns z is this times its transpose. May overwrite columns."""
        found = _solved(self.factor, columns)
        if self.basis.shape[1]:
            found = found + (found @ self.basis) @ self.shrinkage @ self.basis.T
        return found

    @property
    def covariance(self) -> np.ndarray:
        """(t, t)"""
        root = self.spread(np.eye(len(self.mean)))
        return root @ root.T


def _solved(factor: np.ndarray, rows: np.ndarray, transposed: bool = False) -> np.ndarray:
    """rows L'^-1, or rows L^-1 if transposed, of a lower triangular L; may overwrite rows (p, t)."""
    if not rows.size:
        return rows
    solution: np.ndarray = dtrsm(1.0, factor.T, rows.T, trans_a=not transposed, overwrite_b=True).T
    return solution


@dataclass(frozen=True, slots=True, eq=False)
class JointPosterior:
    """Posterior of noise and parameters at given variances, values per reading (K, q) a stack.

    parameters     : of z
    variance       : the given ones
    noise_mean     : of u, in units of stated sigmas
    noise_variance : of u
    gain           : (K, n, q) a stack, transposed: of what rows of a `Marginal` say, the share that is noise
    carried        : (K, q, t) a stack, gain' X root: covariance of u is variance - gain' gain + carried carried'
    soft_mean      : (K, s) prediction of the soft rows; (0, 0) without any
    soft_variance  : (K, s)
    """

    parameters: ParameterPosterior
    variance: tuple[np.ndarray, ...]
    noise_mean: tuple[np.ndarray, ...]
    noise_variance: tuple[np.ndarray, ...]
    gain: tuple[np.ndarray, ...]
    carried: tuple[np.ndarray, ...]
    soft_mean: np.ndarray
    soft_variance: np.ndarray

    @classmethod
    def of(
        cls, rows: WhiteRows, variance: tuple[np.ndarray, ...], soft: SoftExpectation | None, one_sided: np.ndarray
    ) -> "JointPosterior":
        """At given variances (K_i, q_i) of the readings; without `soft`, soft rows are not read."""
        marginal = Marginal.of(rows, variance, soft)
        parameters = ParameterPosterior.of(marginal, rows.rows, one_sided)
        gain = tuple(A * own[:, None] for A, own in zip(marginal.A, variance, strict=True))
        carried, reached = _carried(rows, marginal, parameters, gain)
        rest = marginal.r - marginal.X @ parameters.mean
        means, variances = [], []
        for stack, own, share, spread, part in zip(rows.stacks, variance, gain, carried, rows.parts, strict=True):
            means.append((rest[part].reshape(stack.r.shape)[:, None] @ share)[:, 0])
            known = np.einsum("knq,knq->kq", share, share)
            variances.append(own - known + np.einsum("kqt,kqt->kq", spread, spread))
        mean, spread = _predicted(rows, parameters, variance, means, gain, reached)
        return cls(parameters, variance, tuple(means), tuple(variances), gain, carried, mean, spread)

    def covariance(self, stack: int, chosen: np.ndarray) -> np.ndarray:
        """(K, p, p) of some readings (p,) of a stack."""
        gain, carried = self.gain[stack][:, :, chosen], self.carried[stack][:, chosen]
        found = carried @ carried.swapaxes(1, 2) - gain.swapaxes(1, 2) @ gain
        np.einsum("kii->ki", found)[...] += self.variance[stack][:, chosen]
        return found


def _carried(
    rows: WhiteRows, marginal: Marginal, parameters: ParameterPosterior, gain: tuple[np.ndarray, ...]
) -> tuple[tuple[np.ndarray, ...], np.ndarray]:
    """gain' X root of each stack (K, q, t), and X root - A gain' X root of the soft rows (K, s, t)."""
    t, soft = rows.parameters, rows.soft_stack
    sizes = [share.shape[0] * share.shape[2] for share in gain]
    ends = np.cumsum([0, *sizes, 0 if soft is None else len(rows.stacks[soft].r) * len(rows.stacks[soft].soft)])
    whole = np.empty((ends[-1], t))
    shapes = [(share.shape[0], share.shape[2], t) for share in gain]
    views = [whole[i:j].reshape(shape) for i, j, shape in zip(ends, ends[1:], shapes, strict=False)]
    for view, stack, share, part in zip(views, rows.stacks, gain, rows.parts, strict=True):
        np.matmul(share.swapaxes(1, 2), marginal.X[part].reshape(stack.X.shape), out=view)
    if soft is not None:
        stack = rows.stacks[soft]
        own = whole[ends[-2] :].reshape((len(stack.r), len(stack.soft), t))
        np.subtract(stack.X[:, stack.soft], stack.A[:, stack.soft] @ views[soft], out=own)
    whole = parameters.spread(whole)
    carried = tuple(whole[i:j].reshape(shape) for i, j, shape in zip(ends, ends[1:], shapes, strict=False))
    return carried, whole[ends[-2] :]


def _predicted(
    rows: WhiteRows,
    parameters: ParameterPosterior,
    variance: Sequence[np.ndarray],
    noise_mean: Sequence[np.ndarray],
    gain: Sequence[np.ndarray],
    reached: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Mean and variance (K, s) of what soft rows read; `reached` (K s, t) is what z carries into them."""
    if rows.soft_stack is None:
        return np.zeros((0, 0)), np.zeros((0, 0))
    i = rows.soft_stack
    stack = rows.stacks[i]
    A, X = stack.A[:, stack.soft], stack.X[:, stack.soft]
    mean = (A @ noise_mean[i][..., None])[..., 0] + X @ parameters.mean
    seen = A @ gain[i].swapaxes(1, 2)
    by_noise = (A**2 @ variance[i][..., None])[..., 0] - np.einsum("ksn,ksn->ks", seen, seen)
    return mean, by_noise + np.einsum("pt,pt->p", reached, reached).reshape(mean.shape)

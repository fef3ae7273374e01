"""Least squares for damped modes: the poles are searched for, everything linear in the model follows by projection.

A signal of c channels is B(poles) R + noise. For given poles the best R is linear algebra, so that only the poles are
unknown (variable projection, Golub and Pereyra 1973; the Jacobian is Kaufman's, whose J'J is the exact information on
the poles once R is eliminated).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from cdpr_struct.errors import ConvergenceError

Basis = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
_EVALUATIONS = 60
_TOLERANCE = 1e-8
_WORSE = 1e3  # times the residual without poles


@dataclass(frozen=True, slots=True, eq=False)
class SeparableFit:
    """Result of a fit of k poles to n rows of c channels.

    poles      : (k,) complex, positive imaginary part [rad/s]
    covariance : (2k, 2k) of (real, imaginary) parts, pole by pole, for residuals of unit variance
    linear     : (columns, c) of the basis;  residual : (n, c) weighted
    """

    poles: np.ndarray
    covariance: np.ndarray
    linear: np.ndarray
    residual: np.ndarray

    @property
    def squares(self) -> float:
        """Sum of squares of the residuals."""
        return float((self.residual**2).sum())

    @property
    def variance(self) -> float:
        """Of the noise, per row and channel."""
        n, c = self.residual.shape
        free = n * c - self.linear.size - 2 * len(self.poles)
        return self.squares / max(free, 1)

    def criterion(self) -> float:
        """Bayesian information criterion; the smaller, the better."""
        n, c = self.residual.shape
        unknown = self.linear.size + 2 * len(self.poles)
        return n * c * float(np.log(max(self.squares, 1e-300) / (n * c))) + unknown * float(np.log(n * c))


def separable_fit(
    basis: Basis, signal: np.ndarray, weight: np.ndarray, start: np.ndarray,
    tolerance: float = _TOLERANCE, evaluations: int = _EVALUATIONS,
) -> SeparableFit:  # fmt: skip
    """Poles and linear coefficients that fit a signal best.

    Parameters
    ----------
    basis : poles (k,) to columns (n, q), the first 2k those of the poles, two each, and how these two change with
            the real and the imaginary part of their pole (2k, n, 2)
    signal : (n, c);  weight : (n, c) or (1, c), one over the noise's standard deviation
    start : (k,) complex poles [rad/s];  tolerance : relative change of the squares below which it ends
    evaluations : of the signal, at most

    Raises
    ------
    ConvergenceError : the poles to start with grow beyond all numbers.
    """
    scale = np.repeat(np.abs(start), 2)
    shared, channels = weight.shape[0] == 1, signal.shape[1]
    target = signal * weight

    last: list[tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray, np.ndarray]]]] = []

    def parts(x: np.ndarray) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        if not last or not np.array_equal(last[0][0], x):  # residuals and slopes are asked for one after the other
            columns, slopes = basis(_poles(x * scale))
            own = [(slice(None), 1.0)] if shared else [(slice(i, i + 1), weight[:, [i]]) for i in range(channels)]
            last[:] = [(x.copy(), [_project(w * columns, w * slopes, target[:, i]) for i, w in own])]
        return last[0][1]

    def rest(x: np.ndarray) -> np.ndarray:
        return np.concatenate([p[0].T.ravel() for p in parts(x)])

    def slope(x: np.ndarray) -> np.ndarray:
        jacobian = np.concatenate([p[1].reshape((len(x), -1)).T for p in parts(x)])
        return jacobian * scale

    first = np.stack([start.real, start.imag], axis=1).ravel() / scale
    with np.errstate(over="ignore", invalid="ignore"):
        found = least_squares(rest, first, jac=slope, method="lm", ftol=tolerance, max_nfev=evaluations)
        done = parts(found.x)
    information = sum(np.einsum("pcn,qcn->pq", p[1], p[1]) for p in done)
    if not information.any():
        raise ConvergenceError("modes of a record", np.inf, 0, "Is a reading far off all others, or a time wrong?")
    linear = np.concatenate([p[2] for p in done], axis=1)
    if shared:
        linear = linear / weight
    residual = np.concatenate([p[0] for p in done], axis=1)
    return SeparableFit(_poles(found.x * scale), np.linalg.pinv(information), linear, residual)


def _poles(parts: np.ndarray) -> np.ndarray:
    return parts[0::2] + 1j * np.abs(parts[1::2])


def _project(columns: np.ndarray, slopes: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Residual (n, c), its slopes (2k, c, n) and the coefficients (q, c).

    A trial of poles that grow beyond all numbers is worse than no poles at all, so that the search turns back.
    """
    if not (np.isfinite(columns).all() and np.isfinite(slopes).all()):
        (n, c), unknown = target.shape, len(slopes)
        return _WORSE * target, np.zeros((unknown, c, n)), np.zeros((columns.shape[1], c))
    q, r = np.linalg.qr(columns)
    inside = q.T @ target
    linear = np.linalg.lstsq(r, inside, rcond=None)[0]
    pairs = np.repeat(linear[: len(slopes)].reshape((-1, 2, linear.shape[1])), 2, axis=0)
    moved = np.swapaxes(slopes @ pairs, 1, 2)
    flat = moved.reshape((-1, moved.shape[-1]))
    across = (flat - (flat @ q) @ q.T).reshape(moved.shape)
    return target - q @ inside, -across, linear

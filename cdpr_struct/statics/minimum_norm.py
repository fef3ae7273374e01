"""Smallest change subject to balance and bounds: a batch of small strictly convex quadratic programs.

    minimise  sum_i (h_i t_i^2 / 2 + g_i t_i)   subject to   J t = b,   low <= t <= high.

Its dual has n <= 6 unknowns y and no bounds: t_i(y) = clip((J_i . y - g_i) / h_i, low_i, high_i), and the dual's
gradient is b - J t(y). The dual is concave and piecewise quadratic, so a Newton method with line search ends after a
few steps with the exact set of active bounds. If no t balances, the residual b - J t stays: it is returned, not hidden.
"""

from dataclasses import dataclass

import numpy as np

MAX_ITERATIONS = 60
_SHIFT = 1e-10  # relative, keeps the dual's Hessian regular where bounds hold most cables


@dataclass(frozen=True, slots=True, eq=False)
class QuadraticPrograms:
    """A flat batch (k) with n balance equations and m unknowns.

    curvature, gradient, low, high : (k, m); curvature > 0
    matrix, target : (k, n, m), (k, n)
    """

    curvature: np.ndarray
    gradient: np.ndarray
    matrix: np.ndarray
    target: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def primal(self, dual: np.ndarray) -> np.ndarray:
        """(k, m) minimiser at given dual unknowns (k, n)."""
        free = (np.einsum("knm,kn->km", self.matrix, dual) - self.gradient) / self.curvature
        return np.clip(free, self.low, self.high)

    def slope(self, dual: np.ndarray) -> np.ndarray:
        """(k, n) gradient of the dual, b - J t(y)."""
        return self.target - np.einsum("knm,km->kn", self.matrix, self.primal(dual))

    def take(self, index: np.ndarray) -> "QuadraticPrograms":
        return QuadraticPrograms(*(getattr(self, name)[index] for name in self.__slots__))


def solve_programs(programs: QuadraticPrograms) -> tuple[np.ndarray, np.ndarray]:
    """Solutions t (k, m) and their dual y (k, n), the multipliers of the balance."""
    k, n = programs.target.shape
    dual = np.zeros((k, n))
    size = np.abs(programs.matrix).sum(axis=(1, 2)) / programs.matrix.shape[2] + 1e-300
    reach = np.abs(programs.gradient / programs.curvature).max(axis=1)
    scale = np.linalg.norm(programs.target, axis=1) + size * reach + 1e-300
    items = np.arange(k)
    for _ in range(MAX_ITERATIONS):
        part, here = programs.take(items), dual[items]
        slope = part.slope(here)
        step = _newton_direction(part, here, slope)
        moved = _line_search(part, here, step)
        change = np.abs(part.primal(moved) - part.primal(here)).max(axis=1)
        dual[items] = moved
        balanced = np.linalg.norm(part.slope(moved), axis=1) <= 1e-13 * scale[items]
        largest = np.abs(part.primal(moved)).max(axis=1)
        items = items[~balanced & (change > 1e-13 * largest)]
        if not items.size:
            break
    return programs.primal(dual), dual


def _newton_direction(part: QuadraticPrograms, dual: np.ndarray, slope: np.ndarray) -> np.ndarray:
    t = part.primal(dual)
    free = ((t > part.low) & (t < part.high)) / part.curvature
    hessian = np.einsum("kim,km,kjm->kij", part.matrix, free, part.matrix)
    every = np.einsum("kim,km,kim->k", part.matrix, 1.0 / part.curvature, part.matrix)
    shift = _SHIFT * every[:, None, None] * np.eye(part.target.shape[1])
    return np.linalg.solve(hessian + shift, slope[..., None])[..., 0]


def _line_search(part: QuadraticPrograms, dual: np.ndarray, step: np.ndarray) -> np.ndarray:
    """The full step where the dual still rises at its end, else the point on the way where it stops rising."""
    start = np.einsum("kn,kn->k", part.slope(dual), step)
    end = np.einsum("kn,kn->k", part.slope(dual + step), step)
    short = np.flatnonzero(end < -1e-9 * np.abs(start))
    factor = np.ones(len(dual))
    if short.size:
        factor[short] = _stop_of_rise(part.take(short), dual[short], step[short], start[short], end[short])
    return dual + factor[:, None] * step


def _stop_of_rise(
    part: QuadraticPrograms, dual: np.ndarray, step: np.ndarray, start: np.ndarray, end: np.ndarray
) -> np.ndarray:
    """Factor (k,) in 0..1 where the dual's slope along the step is about zero: false position, halved when it drags."""
    low, high, at_low, at_high = np.zeros(len(dual)), np.ones(len(dual)), start, end
    for count in range(24):
        share = at_low / np.maximum(at_low - at_high, 1e-300)
        middle = low + (high - low) * (np.clip(share, 0.02, 0.98) if count % 3 else 0.5)
        here = np.einsum("kn,kn->k", part.slope(dual + middle[:, None] * step), step)
        up = here > 0.0
        low, at_low = np.where(up, middle, low), np.where(up, here, at_low)
        high, at_high = np.where(up, high, middle), np.where(up, at_high, here)
        if (np.abs(here) <= 1e-6 * np.abs(start)).all():
            break
    return middle

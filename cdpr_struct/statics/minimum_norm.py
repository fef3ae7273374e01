"""Smallest change subject to balance and bounds: a batch of small strictly convex quadratic programs.

    minimise  sum_i (h_i t_i^2 / 2 + g_i t_i)   subject to   J t = b,   low <= t <= high.

Its dual has n <= 6 unknowns y and no bounds: t_i(y) = clip((J_i . y - g_i) / h_i, low_i, high_i), and the dual's
gradient is b - J t(y). The dual is concave and piecewise quadratic, so a Newton method with line search ends after a
few steps with the exact set of active bounds. If no t balances, the residual b - J t stays: it is returned, not hidden.
"""

from dataclasses import dataclass

import numpy as np

MAX_ITERATIONS = 30
_HOPELESS = 1e7  # multipliers this many times what a feasible problem asks for: nothing balances
_RANK = 1e-12  # relative: directions that the unknowns cannot act in


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
    price = (programs.curvature.max(axis=1) * scale / size + np.abs(programs.gradient).max(axis=1)) / size
    items = np.arange(k)
    for _ in range(MAX_ITERATIONS):
        part, here = programs.take(items), dual[items]
        newton, rest = _directions(part, here)
        moved = _climb(part, _climb(part, here, newton), rest)
        before, after = part.primal(here), part.primal(moved)
        dual[items] = moved
        balanced = np.linalg.norm(part.slope(moved), axis=1) <= 1e-13 * scale[items]
        idle = np.abs(after - before).max(axis=1) <= 1e-13 * np.abs(after).max(axis=1)
        hopeless = np.abs(moved).max(axis=1) > _HOPELESS * price[items]
        items = items[~(balanced | idle | hopeless)]
        if not items.size:
            break
    return programs.primal(dual), dual


def _directions(part: QuadraticPrograms, dual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Newton direction in what the free unknowns can balance, and the dual's slope in what they cannot."""
    t = part.primal(dual)
    free = ((t > part.low) & (t < part.high)) / part.curvature
    hessian = np.einsum("kim,km,kjm->kij", part.matrix, free, part.matrix)
    every = np.einsum("kim,km,kim->k", part.matrix, 1.0 / part.curvature, part.matrix)
    values, vectors = np.linalg.eigh(hessian)
    spanned = values > _RANK * every[:, None]
    share = np.einsum("kij,ki->kj", vectors, part.slope(dual))
    newton = np.where(spanned, share / np.where(spanned, values, 1.0), 0.0)
    rest = np.where(spanned, 0.0, share)
    return np.einsum("kij,kj->ki", vectors, newton), np.einsum("kij,kj->ki", vectors, rest)


def _climb(part: QuadraticPrograms, dual: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Exact maximum of the dual along a direction: its slope is piecewise linear with kinks where bounds come and go.

    A direction along which the dual rises for ever (the balance is impossible) is followed to its last kink.
    """
    pace = np.einsum("knm,kn->km", part.matrix, direction)
    weight = np.linalg.norm(part.matrix, axis=1) * np.linalg.norm(direction, axis=1)[:, None]
    pace = np.where(np.abs(pace) > _RANK * weight, pace, 0.0)
    start = np.einsum("knm,kn->km", part.matrix, dual) - part.gradient
    kinks = _kinks(part, start, pace)
    stops = np.where(np.isfinite(kinks), kinks, 0.0)
    free = (start[:, None, :] + stops[..., None] * pace[:, None, :]) / part.curvature[:, None, :]
    t = np.clip(free, part.low[:, None, :], part.high[:, None, :])
    slope = np.einsum("kn,kn->k", part.target, direction)[:, None] - np.einsum("kjm,km->kj", t, pace)
    rising = np.isfinite(kinks) & (slope > 0.0)
    rising[:, 0] |= True
    last = rising.shape[1] - 1 - np.argmax(rising[:, ::-1], axis=1)
    row = np.arange(len(dual))
    beyond = free[row, last] + 1e-9 * np.sign(pace) * (1.0 + np.abs(free[row, last]))
    moving = (beyond > part.low) & (beyond < part.high)
    fall = (np.where(moving, pace**2, 0.0) / part.curvature).sum(axis=1)
    here = np.maximum(slope[row, last], 0.0)
    further = np.where(fall > 0.0, here / np.where(fall > 0.0, fall, 1.0), 0.0)
    following = np.minimum(last + 1, kinks.shape[1] - 1)
    room = np.where(following > last, kinks[row, following] - stops[row, last], np.inf)
    return dual + (stops[row, last] + np.minimum(further, room))[:, None] * direction


def _kinks(part: QuadraticPrograms, start: np.ndarray, pace: np.ndarray) -> np.ndarray:
    """(k, 2 m + 1) sorted factors >= 0 at which an unknown meets or leaves a bound, 0 first, inf for never."""
    moves = pace != 0.0
    safe = np.where(moves, pace, 1.0)
    kinks = [np.zeros((len(start), 1))]
    for bound in (part.low, part.high):
        finite = np.isfinite(bound) & moves
        factor = (np.where(finite, bound, 0.0) * part.curvature - start) / safe
        kinks.append(np.where(finite & (factor > 0.0), factor, np.inf))
    return np.sort(np.concatenate(kinks, axis=1), axis=1)

"""Smallest change subject to balance and bounds: a batch of small strictly convex quadratic programs.

    minimise  sum_i (h_i t_i^2 / 2 + g_i t_i)   subject to   J t = b,   low <= t <= high.

Its dual has n <= 6 unknowns y and no bounds: t_i(y) = clip((J_i . y - g_i) / h_i, low_i, high_i), and the dual's
gradient is b - J t(y). The dual is concave and piecewise quadratic, so a Newton method with line search ends after a
few steps with the exact set of active bounds. If no t balances, the residual b - J t stays: it is returned, not hidden.

Where J loses rank, or many unknowns meet their bounds at once, the dual is flat and Newton may wander. Such programs
are solved by the method of multipliers: the balance may fail by s at the price |s|^2 / (2 e) - y0 . s, which makes the
dual strictly concave, and y0 is renewed by the y that is found.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.batch_items import BatchItems

MAX_ITERATIONS = 30
_HOPELESS = 1e7  # multipliers this many times what a feasible problem asks for: nothing balances
_RANK = 1e-12  # relative: directions that the unknowns cannot act in
_NEGLIGIBLE = 1e-9  # of the forces: an unbalance in such directions that no one tries to remove
_ELASTICITY = 1e-8, 1e-10, 1e-12, 1e-12  # e of one round after the other, over the trace of J J^T / h


@dataclass(frozen=True, slots=True, eq=False)
class QuadraticPrograms(BatchItems):
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


def solve_programs(programs: QuadraticPrograms, careful: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Solutions t (k, m) and their dual y (k, n), the multipliers of the balance.

    careful : where the search is cut short, go on by the method of multipliers; that takes several times as long
    """
    dual, stuck = _ascend(programs, np.zeros(programs.target.shape))
    if careful and stuck.size:
        dual[stuck] = _by_multipliers(programs.take(stuck), np.zeros_like(dual[stuck]))[1]
    return programs.primal(dual), dual


def least_violation(programs: QuadraticPrograms) -> tuple[np.ndarray, np.ndarray]:
    """Solutions t (k, m), and the unbalance b - J t (k, n) that is left: the least there can be, 0 but for rounding
    where the balance is possible. Then r . J t' <= r . J t for all t' within the bounds, so r separates b from them."""
    t, dual = _by_multipliers(programs, np.zeros(programs.target.shape), 1)
    return t, programs.slope(dual)


def _by_multipliers(
    programs: QuadraticPrograms, dual: np.ndarray, rounds: int = len(_ELASTICITY)
) -> tuple[np.ndarray, np.ndarray]:
    """Solutions t (k, m) and their dual y (k, n)."""
    k, n = programs.target.shape
    every = np.einsum("knm,km,knm->k", programs.matrix, 1.0 / programs.curvature, programs.matrix) + 1e-300
    none = np.full((k, n), np.inf)
    for share in _ELASTICITY[:rounds]:
        elastic = QuadraticPrograms(
            np.concatenate([programs.curvature, np.repeat(1.0 / (share * every)[:, None], n, axis=1)], axis=1),
            np.concatenate([programs.gradient, dual], axis=1),
            np.concatenate([programs.matrix, np.broadcast_to(np.eye(n), (k, n, n))], axis=2),
            programs.target,
            np.concatenate([programs.low, -none], axis=1),
            np.concatenate([programs.high, none], axis=1),
        )
        dual = _ascend(elastic, dual)[0]
    return programs.primal(dual), dual


def _ascend(programs: QuadraticPrograms, dual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Dual (k, n) at its maximum from a start, and the items at which the search was cut short."""
    dual = dual.copy()
    size = np.abs(programs.matrix).sum(axis=(1, 2)) / programs.matrix.shape[2] + 1e-300
    reach = np.abs(programs.gradient / programs.curvature).max(axis=1)
    scale = np.linalg.norm(programs.target, axis=1) + size * reach + 1e-300
    price = (programs.curvature.max(axis=1) * scale / size + np.abs(programs.gradient).max(axis=1)) / size
    items, lost = np.arange(len(dual)), np.zeros(0, dtype=int)
    for _ in range(MAX_ITERATIONS):
        part, here = programs.take(items), dual[items]
        newton, rest = _directions(part, here, scale[items])
        moved = _climb(part, _climb(part, here, newton), rest)
        before, after = part.primal(here), part.primal(moved)
        dual[items] = moved
        balanced = np.linalg.norm(part.slope(moved), axis=1) <= 1e-13 * scale[items]
        idle = np.abs(after - before).max(axis=1) <= 1e-13 * np.abs(after).max(axis=1)
        hopeless = np.abs(moved).max(axis=1) > _HOPELESS * price[items]
        lost = np.append(lost, items[hopeless & ~balanced])
        items = items[~(balanced | idle | hopeless)]
        if not items.size:
            break
    return dual, np.append(items, lost)


def _directions(part: QuadraticPrograms, dual: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Newton direction in what the free unknowns can balance, and the dual's slope in what they cannot."""
    t = part.primal(dual)
    free = ((t > part.low) & (t < part.high)) / part.curvature
    hessian = np.einsum("kim,km,kjm->kij", part.matrix, free, part.matrix)
    every = np.einsum("kim,km,kim->k", part.matrix, 1.0 / part.curvature, part.matrix)
    values, vectors = np.linalg.eigh(hessian)
    spanned = values > _RANK * every[:, None]
    share = np.einsum("kij,ki->kj", vectors, part.slope(dual))
    newton = np.where(spanned, share / np.where(spanned, values, 1.0), 0.0)
    rest = np.where(spanned | (np.abs(share) <= _NEGLIGIBLE * scale[:, None]), 0.0, share)
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

"""Quadratic programs whose active bounds are nearly known: guess, verify, and only where that fails search."""

import numpy as np

from cdpr_struct.statics.minimum_norm import QuadraticPrograms, solve_programs

_GUESSES = 10  # Newton steps on the active set before the safeguarded solver takes over
_BALANCED = 1e-13  # unbalance over the numbers it is a difference of that counts as solved
_SHIFT = 1e-14  # relative, keeps the matrix of the free unknowns invertible


def solve_guessed(programs: QuadraticPrograms, dual: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solutions t (k, m) and their dual (k, n), as `solve_programs`, started at a guess of the dual (k, n).

    Full Newton steps on the dual's gradient b - J t(y). It is piecewise linear, so a step from the right piece ends at
    the solution, and a vanishing gradient proves it. Items that do not get there go to the safeguarded solver.
    """
    dual = dual.copy()
    items = np.arange(len(dual))
    reach = np.abs(programs.gradient / programs.curvature).max(axis=1)
    for count in range(_GUESSES + 1):
        part = programs.take(items)
        t = part.primal(dual[items])
        product = part.matrix * t[:, None, :]
        gap = part.target - product.sum(axis=2)
        scale = np.linalg.norm(part.target, axis=1) + np.abs(product).max(axis=(1, 2)) + reach[items]
        unsolved = ~(np.linalg.norm(gap, axis=1) <= _BALANCED * scale)
        items = items[unsolved]
        if not items.size or count == _GUESSES:
            break
        free = ((t > part.low) & (t < part.high))[unsolved]
        dual[items] += _newton_step(part.take(unsolved), free, gap[unsolved])
    if items.size:
        dual[items] = solve_programs(programs.take(items))[1]
    return programs.primal(dual), dual


def unbounded_dual(programs: QuadraticPrograms) -> np.ndarray:
    """(k, n) dual of the programs without their bounds: a first guess."""
    t = -programs.gradient / programs.curvature
    gap = programs.target - np.einsum("knm,km->kn", programs.matrix, t)
    return _newton_step(programs, np.ones(t.shape, dtype=bool), gap)


def _newton_step(part: QuadraticPrograms, free: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Newton step (k, n) of the dual if the unknowns `free` (k, m) are those off their bounds."""
    rows = part.matrix * (free / part.curvature)[:, None, :]
    hessian = rows @ np.swapaxes(part.matrix, 1, 2)
    every = (part.matrix**2 / part.curvature[:, None, :]).sum(axis=(1, 2))
    shift = _SHIFT * every[:, None, None] * np.eye(part.target.shape[1])
    step: np.ndarray = np.linalg.solve(hessian + shift, gap[..., None])[..., 0]
    return step

"""Which step of least norm balances the platform within bounds, at very many poses at once?

An active-set method on (cable, pose) arrays: cables that would pass a bound are fixed in it, one a pass, and freed once
the cost wants them inside.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.small_systems import solve_positive

EQUATIONS = 6
_PASSES = 6
_FEW = 16  # poses, at which a call costs more than what it computes


@dataclass(frozen=True, slots=True, eq=False)
class StepProgram:
    """Least h t^2 / 2 + g t with J t = -left and low <= t <= high: curvature h, gradient g, bounds (m, n), matrix J
    (6, m, n), left (6, n)."""

    curvature: np.ndarray
    gradient: np.ndarray
    matrix: np.ndarray
    left: np.ndarray
    low: np.ndarray
    high: np.ndarray


def least_norm(program: StepProgram, side: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Step (m, n), multipliers (6, n) and side (m, n) of the program's answer.

    side : in which bound each cable is, -1, 0 or 1, to begin from. A pass frees the cable of each pose that pulls
        hardest out of its bound, or fixes that which passes one furthest.
    """
    for _ in range(_PASSES):
        step, dual = _between(program, side)
        beyond = np.maximum(program.low - step, step - program.high)
        if not side.any() and not (beyond > 0.0).any():
            break
        pull = side * (program.gradient + program.curvature * step - (program.matrix * dual[:, None]).sum(axis=0))
        wrong = np.where(side == 0, beyond, pull) > 0.0
        if not wrong.any():
            break
        side = _exchanged(
            side, np.where(side == 0, -np.inf, pull), np.where(side == 0, beyond, 0.0), step < program.low
        )
    return step, dual, side


def _exchanged(side: np.ndarray, pull: np.ndarray, beyond: np.ndarray, below: np.ndarray) -> np.ndarray:
    """Sides (m, n) with one cable a pose freed, or else one fixed in the bound that it passes: in place of the one that
    presses least against its own where no more than six are free."""
    side, pose = side.copy(), np.arange(side.shape[1])
    freed, fixed = pull.argmax(axis=0), beyond.argmax(axis=0)
    fixes = (pull[freed, pose] <= 0.0) & (beyond[fixed, pose] > 0.0)
    full = (side != 0).sum(axis=0) >= len(side) - EQUATIONS
    frees = (pull[freed, pose] > 0.0) | (fixes & full & (side[freed, pose] != 0))
    fixes &= ~full | frees
    side[freed[frees], pose[frees]] = 0
    side[fixed[fixes], pose[fixes]] = np.where(below[fixed[fixes], pose[fixes]], -1, 1)
    return side


def _between(program: StepProgram, side: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Step and multipliers with some cables in their bounds."""
    some = side.any()
    free = (side == 0) if some else np.ones(1)
    bound = np.where(side < 0, program.low, np.where(side > 0, program.high, 0.0)) if some else np.zeros(1)
    weighted = program.matrix * (free / program.curvature)
    normal = _normal(weighted, program.matrix)
    right = (weighted * program.gradient).sum(axis=1) - program.left
    right = right - (program.matrix * bound).sum(axis=1) if some else right
    dual = solve_positive(normal, right)
    step = ((program.matrix * dual[:, None]).sum(axis=0) - program.gradient) / program.curvature
    return np.where(free, step, bound) if some else step, dual


def _normal(weighted: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Sums over m of products of (6, m, n) and (6, m, n): the lower triangle of (6, 6, n); at few poses in one call."""
    count, _, poses = matrix.shape
    if poses <= _FEW:
        return np.asarray((weighted[:, None] * matrix).sum(axis=2))
    normal = np.zeros((count, count, poses))
    for i in range(count):
        normal[i, : i + 1] = (weighted[i] * matrix[: i + 1]).sum(axis=1)
    return normal

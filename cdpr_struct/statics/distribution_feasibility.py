"""Is there any tension distribution within the bounds? Decided by the least unbalanced wrench and a proof beside it.

The search minimises the unbalanced wrench within the bounds. If some is left, its direction y separates: every cable's
share y . wrench_i depends on its own chord tension only and is concave or convex in it, so the largest share within the
bounds is known, and if all of them together do not reach the load, no distribution exists.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.statics.distribution_problem import BALANCED, DistributionProblem, Tangent
from cdpr_struct.statics.guessed_programs import solve_guessed, unbounded_dual
from cdpr_struct.statics.least_crossing import least_crossing
from cdpr_struct.statics.minimum_norm import QuadraticPrograms
from cdpr_struct.statics.unholdable_poses import DIRECTIONS

MAX_ITERATIONS = 40
FAR = 1e4  # tensions up to this many times the load are considered where there is no upper bound
_BISECTIONS = 50
_RIDGE = 1e-8  # price of a tension change over that of an unbalanced wrench


@dataclass(frozen=True, slots=True, eq=False)
class LeastUnbalance:
    """Flat batch (k).

    chord_tension : (k, m) [N] within the bounds
    wrench        : (k, 6) what stays unbalanced, scaled by the problem's unit [N]
    feasible      : (k,) bool: nothing stays unbalanced
    proven        : (k,) bool: proven that something stays
    """

    chord_tension: np.ndarray
    wrench: np.ndarray
    feasible: np.ndarray
    proven: np.ndarray


def least_unbalance(problem: DistributionProblem) -> LeastUnbalance:
    """Chord tensions within the bounds that leave the least wrench unbalanced."""
    tension = np.clip(problem.start(), problem.floor, problem.ceiling)
    items, tangent = np.arange(len(tension)), problem.tangent(tension)
    wrench = tangent.wrench.copy()
    for _ in range(MAX_ITERATIONS):
        step = _elastic_step(problem.take(items), tension[items], tangent)
        tension[items] += step
        tangent = problem.take(items).tangent(tension[items])
        wrench[items] = tangent.wrench
        small = np.abs(step).max(axis=1) <= 1e-9 * tension[items].max(axis=1)
        going = ~small & (tangent.unbalanced > 1e-3 * BALANCED)
        items, tangent = items[going], tangent.take(going)
        if not items.size:
            break
    end = problem.tangent(tension)
    feasible = end.unbalanced <= BALANCED
    return LeastUnbalance(tension, end.wrench, feasible, ~feasible & _separated(problem, tension, end))


def _elastic_step(problem: DistributionProblem, tension: np.ndarray, tangent: Tangent) -> np.ndarray:
    """Gauss-Newton step within the bounds: the unbalanced wrench is six more unknowns of a quadratic program."""
    k, m = tension.shape
    ones, none = np.ones((k, 6)), np.full((k, 6), np.inf)
    eye = np.broadcast_to(np.eye(6), (k, 6, 6))
    low, high = problem.room(tension)
    programs = QuadraticPrograms(
        curvature=np.concatenate([np.full((k, m), _RIDGE), ones], axis=1),
        gradient=np.zeros((k, m + 6)),
        matrix=np.concatenate([tangent.matrix, -eye], axis=2),
        target=-tangent.wrench,
        low=np.concatenate([low, -none], axis=1),
        high=np.concatenate([high, none], axis=1),
    )
    return solve_guessed(programs, unbounded_dual(programs))[0][:, :m]


def _separated(problem: DistributionProblem, tension: np.ndarray, tangent: Tangent) -> np.ndarray:
    """(k,) bool: no chord tensions within the bounds balance the load, seen along the wrench that stays unbalanced."""
    size = np.linalg.norm(tangent.wrench, axis=1, keepdims=True)
    along = -tangent.wrench / np.maximum(size, 1e-300)
    ceiling = np.minimum(problem.ceiling, problem.floor + FAR * problem.size)
    share_low, share_high = (_shares(problem, t, along) for t in (problem.floor, ceiling))
    concave = problem.vertical_share(along) * tangent.bend <= 0.0
    largest = np.where(concave, _concave_maximum(problem, ceiling, along), np.maximum(share_low, share_high))
    load = (along * problem.holding.load / problem.holding.unit).sum(axis=1)
    reach: np.ndarray = largest.sum(axis=1) + load
    return reach < -1e-3 * size[:, 0]


def _concave_maximum(problem: DistributionProblem, ceiling: np.ndarray, along: np.ndarray) -> np.ndarray:
    """(k, m) upper bound of each cable's share within the bounds where it is concave, by bisection on its slope."""
    low, high = problem.floor, ceiling
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        rising = _slopes(problem, middle, along) > 0.0
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    return _shares(problem, low, along) + np.maximum(_slopes(problem, low, along), 0.0) * (high - low)


def _slopes(problem: DistributionProblem, tension: np.ndarray, along: np.ndarray) -> np.ndarray:
    """(k, m) derivative of `_shares` by the chord tensions."""
    return problem.shares(problem.hold(tension).force_rate, along)


def _shares(problem: DistributionProblem, tension: np.ndarray, along: np.ndarray) -> np.ndarray:
    """(k, m) what each cable contributes to the wrench in the scaled direction `along` (k, 6) [N]."""
    return problem.shares(problem.hold(tension).states.force_on_platform, along)


def explain(
    problem: DistributionProblem, ends: LeastUnbalance, where: Callable[[int], str], count: int
) -> UnholdablePoseError:
    """Error about the pose that is worst off: which cable, by how much, or which direction no cable acts in.

    Parameters
    ----------
    problem, ends : the poses (k) that cannot be held
    where : name of pose i in words, like "at t = 3 s"
    count : of all poses that were asked for
    """
    worst = int(np.linalg.norm(ends.wrench, axis=1).argmax())
    one = problem.take(np.array([worst]))
    tension = ends.chord_tension[worst : worst + 1]
    tangent = one.tangent(tension)
    poses = len(ends.wrench)
    who = f"{where(worst)} no tension distribution holds the platform within the bounds"
    who += f" ({poses} of {count} poses)" if count > 1 else ""
    lack = _missing_direction(tangent.matrix[0], tangent.wrench[0], one.holding.unit[0])
    if lack is not None:
        axis, amount, rank = lack
        unit = "N" if axis < 3 else "N m"
        reason = f"the wrench matrix is singular (rank {rank} of 6) and no cable acts against {amount:.4g} {unit} of "
        return UnholdablePoseError(f"{who}: {reason}{DIRECTIONS[axis]}. Move the pose.", None, amount)
    return _crossed_bound(one, tension, tangent, who, bool(ends.proven[worst]))


def _missing_direction(matrix: np.ndarray, wrench: np.ndarray, unit: np.ndarray) -> tuple[int, float, int] | None:
    """Axis and size [N, N m] of what no tensions, even pushing ones, could balance, and the matrix's rank."""
    left, values, _ = np.linalg.svd(matrix, full_matrices=False)
    spanned = left[:, values > 1e-9 * values[0]]
    rest = wrench - spanned @ (spanned.T @ wrench)
    if np.linalg.norm(rest) <= 1e-6 * np.linalg.norm(wrench):
        return None
    axis = int(np.abs(rest).argmax())
    return axis, float(abs(rest[axis]) * unit[axis]), spanned.shape[1]


def _taut_matrix(one: DistributionProblem) -> np.ndarray:
    """(6, m) scaled wrench per newton of straight cables."""
    arms = one.holding.arms
    offset = (one.holding.arrays.frame_anchors - arms.points)[0]
    direction = offset / np.linalg.norm(offset, axis=-1)[:, None]
    wrench: np.ndarray = np.concatenate([direction, np.cross(arms.arms[0], direction)], axis=-1).T
    return wrench / one.holding.unit[0][:, None]


def _crossed_bound(
    one: DistributionProblem, tension: np.ndarray, tangent: Tangent, who: str, proven: bool
) -> UnholdablePoseError:
    """The cable whose bound is in the way most when the sum of all bound violations is made least (cables taut)."""
    matrix, t = _taut_matrix(one), tension[0]
    ceiling = np.minimum(one.ceiling[0], one.floor[0] + FAR * one.size[0])
    crossing = least_crossing(matrix, matrix @ t - tangent.wrench[0], one.floor[0], ceiling)
    if crossing is None:
        return UnholdablePoseError(f"{who}. Move the pose, change the load or the bounds.")
    reason = crossing.said(one.holding.low[0], one.holding.high[0], "its lower", "its upper")
    doubt = "" if proven else "(The search found none; that there is none is not proven.) "
    hint = "Move the pose, change the load or the bounds."
    return UnholdablePoseError(f"{who}: {reason}. {doubt}{hint}", crossing.cable + 1, crossing.amount)

"""Inverse kinematics (3.2.1a): which cable lengths and tensions hold a pose?

The unknown of each cable is its chord tension; every other quantity follows from it at a fixed pose. Of all tensions
that balance the platform within the bounds, those with the least Euclidean norm at the platform end are taken, eqs.
(5.1)-(5.9): a sequence of quadratic programs with exact first derivatives of forces and cost, so the end point is the
optimum of the chosen cable model, sag included. With as many cables as equations it is plain Newton; with fewer, what
the cables cannot balance stays as residual.
"""

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics import holding_tensions
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import cable_wrench
from cdpr_struct.statics.guides import free_part
from cdpr_struct.statics.holding_tensions import HoldingProblem, allowed_unbalance, force_bounds
from cdpr_struct.statics.lost_cables import lost
from cdpr_struct.statics.separating_wrench import separation
from cdpr_struct.statics.stiffening import settled_stiffness
from cdpr_struct.statics.taut_tensions import suits, taut_tensions
from cdpr_struct.statics.unholdable_poses import (
    behind_wheels,
    ends_within_wheels,
    half_turn_error,
    no_length_error,
    unholdable,
    without_length,
)

BALANCED = 1e-8  # residual over load and tensions that counts as balanced
_MOST_WINCH_STEPS = 12


class InverseStatus(IntEnum):
    """What was found for one pose."""

    HELD = 0
    UNHOLDABLE = 1
    NOT_CONVERGED = 2


@dataclass(frozen=True, slots=True, eq=False)
class InverseSolution:
    """Lengths and tensions at given poses; leading axes (...) are the batch.

    cables             : CableStates (..., m)
    lengths            : (..., m) unstrained, from the frame anchors on, as the encoders are to say them [m]
    residual_wrench    : (..., 6) what is left unbalanced, what a guide takes left out [N, N m]
    status, iterations : (...); `InverseStatus` values
    """

    cables: CableStates
    lengths: np.ndarray
    residual_wrench: np.ndarray
    status: np.ndarray
    iterations: np.ndarray

    def at(self, index: int | np.ndarray) -> "InverseSolution":
        """The solutions at an index of the batch."""
        rest = (getattr(self, name)[index] for name in ("lengths", "residual_wrench", "status", "iterations"))
        return InverseSolution(self.cables.at(index), *rest)

    @property
    def tensions(self) -> np.ndarray:
        """(..., m) at the platform [N]."""
        return self.cables.tension_at_platform

    @property
    def held(self) -> np.ndarray:
        """(...) bool: balanced, within the bounds."""
        return self.status == InverseStatus.HELD


def inverse(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    model: str | CableModel = "sagging",
    external_wrench: npt.ArrayLike | None = None,
    lower_bound: npt.ArrayLike | None = None,
    upper_bound: npt.ArrayLike | None = None,
    mass: npt.ArrayLike | None = None,
    allow_unheld: bool = False,
) -> InverseSolution:
    """Cable lengths and tensions of minimum norm that hold the platform at given poses.

    Parameters
    ----------
    position, rotation : (..., 3) [m], (..., 3, 3) platform to world
    model : "sagging", "spring" or "ideal"
    external_wrench : (..., 6) on the platform about its origin, world axes, beside its weight [N, N m]
    lower_bound, upper_bound : (..., m) or scalar, on the tension at the platform end [N]; None: the robot's own limits
    mass : (...) of the platform in place of the robot's [kg]
    allow_unheld : return poses that cannot be held with their status, instead of raising

    Returns
    -------
    InverseSolution; all batch axes broadcast.

    Raises
    ------
    UnholdablePoseError : a pose cannot be held (unless `allow_unheld`); it names cable or direction, and the amount,
        or a cable that has no length there, or would turn by more than 180 degrees on its pulley.
    ConvergenceError : the iteration was cut short (unless `allow_unheld`).
    ValueError : bounds that are negative or crossed.
    """
    arrays = RobotArrays.of(robot, None if mass is None else np.asarray(mass, dtype=float))
    place, turn = np.asarray(position, dtype=float), np.asarray(rotation, dtype=float)
    load = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    low, high = force_bounds(
        arrays.force_min if lower_bound is None else lower_bound,
        arrays.force_max if upper_bound is None else upper_bound,
        arrays.cable_count,
    )
    cores = (place.shape[:-1], turn.shape[:-2], load.shape[:-1], low.shape[:-1], high.shape[:-1], arrays.batch_shape)
    shape = np.broadcast_shapes(*cores)
    flat = [np.broadcast_to(a, shape + a.shape[-1:]).reshape((-1, a.shape[-1])) for a in (place, load, low, high)]
    turns = np.broadcast_to(turn, (*shape, 3, 3)).reshape((-1, 3, 3))
    pose, bounds = (flat[0], turns), (flat[2], flat[3])
    problem = HoldingProblem.at(arrays.flattened(shape), cable_model(model), pose, flat[1], bounds)
    nothing = without_length(problem)
    degenerate = np.asarray(nothing.any(axis=1))
    if degenerate.any():
        if not allow_unheld:
            raise no_length_error(nothing)
        problem = _moved_off(problem, degenerate)
    within = ends_within_wheels(problem.arrays, problem.arms.points)
    if within.any() and not allow_unheld:
        raise half_turn_error(arrays, within)
    solution = _solve(problem)
    if arrays.has_tension_winches:
        problem, solution = _with_winches(problem, solution)
    if arrays.stiffens:
        problem, solution = _stiffening(problem, solution)
    solution.status[degenerate] = InverseStatus.UNHOLDABLE
    behind = behind_wheels(problem.arrays, problem.arms.points) & ~solution.held[:, None]
    if not allow_unheld and behind.any():
        raise half_turn_error(arrays, behind)
    if not allow_unheld and (solution.status == InverseStatus.NOT_CONVERGED).any():
        left = float(np.abs(solution.residual_wrench).max())
        hint = "Raise the lower bound: the tensions may lie where cable weight and tension balance."
        raise ConvergenceError("inverse kinematics", left, int(solution.iterations.max()), hint)
    if not allow_unheld and not solution.held.all():
        rest = solution.residual_wrench, solution.tensions
        raise unholdable(problem, solution.held, *rest, separation(problem).proven)
    return _reshaped(solution, shape)


def _with_winches(problem: HoldingProblem, solution: InverseSolution) -> tuple[HoldingProblem, InverseSolution]:
    """Solutions in which the cables of winches that hold their tension have it at the frame.

    Their bounds at the platform close on the tension that is left of it there; it hardly changes from one to the next.
    """
    wanted = np.broadcast_to(problem.arrays.winch_tension, solution.tensions.shape)
    winch = wanted > 0.0
    at_platform = np.where(winch, wanted, solution.tensions)
    for _ in range(_MOST_WINCH_STEPS):
        low, high = (np.where(winch, at_platform, bound) for bound in (problem.low, problem.high))
        problem = replace(problem, low=low, high=high)
        solution = _solve(problem)
        miss = np.where(winch, wanted - solution.cables.tension_at_frame, 0.0)
        if (np.abs(miss) <= BALANCED * 1e-3 * wanted.max()).all():
            break
        at_platform = np.maximum(solution.tensions + miss, 0.0)
    return problem, _cut_short(solution, (np.abs(miss) > BALANCED * wanted.max()).any(axis=-1))


def _stiffening(problem: HoldingProblem, solution: InverseSolution) -> tuple[HoldingProblem, InverseSolution]:
    """Solutions with the stiffness that the cables have at their tension, until it stays."""

    def again(arrays: RobotArrays) -> np.ndarray:
        nonlocal problem, solution
        problem = replace(problem, arrays=arrays)
        solution = _solve(problem)
        return solution.tensions

    settled = settled_stiffness(problem.arrays, solution.tensions, again)
    return problem, _cut_short(solution, ~settled)


def _cut_short(solution: InverseSolution, open_: np.ndarray) -> InverseSolution:
    """The solution; poses (n,) that are `open_` do not count as held, since a search around them has not ended."""
    status = np.where(open_ & solution.held, InverseStatus.NOT_CONVERGED, solution.status)
    return replace(solution, status=status)


def _solve(problem: HoldingProblem) -> InverseSolution:
    """All poses: the taut ones together, the others by programs; those that straight cables balance are tried first."""
    parts, rest = [], np.arange(len(problem.load))
    if suits(problem):
        taut = taut_tensions(problem)
        found, rest = np.flatnonzero(taut.found), np.flatnonzero(~taut.found)
        if not rest.size:
            return _judged(problem, taut.states, taut.found, taut.iterations)
        kept = taut.states.at(found)
        parts.append((found, _judged(problem.take(found), kept, taut.found[found], taut.iterations[found])))
    others = problem.take(rest)
    balances = others.straight_cables_balance()
    near, far = np.flatnonzero(balances), np.flatnonzero(~balances)
    parts.append((rest[near], _by_programs(others.take(near))))
    parts.append((rest[far], _proven_or_searched(others.take(far))))
    solution = _joined(parts)
    lost = np.flatnonzero(balances & ~solution.held[rest])
    return _replaced(solution, rest[lost], _proven_or_searched(others.take(lost)))


def _proven_or_searched(problem: HoldingProblem) -> InverseSolution:
    """Poses that may be out of reach: the least violation, or what a search finds where that is not proven."""
    if not len(problem.load):
        return _by_programs(problem)
    ends = separation(problem)
    states = problem.model.hold(problem.arrays, problem.arms.points, ends.tension).states
    none = np.zeros(len(ends.proven), dtype=int)
    solution = _judged(problem, states, none == 0, none)
    solution.status[:] = InverseStatus.UNHOLDABLE
    open_ = np.flatnonzero(~ends.proven)
    if open_.size:
        found = _by_programs(problem.take(open_))
        solution = _replaced(solution, open_[found.held], found.at(found.held))
        again = open_[~found.held & ends.near[open_]]
        careful = _by_programs(replace(problem.take(again), careful=True), ends.tension[again])
        solution = _replaced(solution, again, careful)
    return solution


def _by_programs(problem: HoldingProblem, start: np.ndarray | None = None) -> InverseSolution:
    tension, iterations, settled = problem.solve(start)
    states = problem.model.hold(problem.arrays, problem.arms.points, tension).states
    return _judged(problem, states, settled, iterations)


def _judged(
    problem: HoldingProblem, states: CableStates, settled: np.ndarray, iterations: np.ndarray
) -> InverseSolution:
    residual = free_part(cable_wrench(states, problem.arms) + problem.load, problem.arrays)
    size = np.linalg.norm(problem.load / problem.unit, axis=1) + states.tension_at_platform.sum(axis=1)
    balanced = np.linalg.norm(residual / problem.unit, axis=1) <= allowed_unbalance(problem.arrays, BALANCED, size)
    pull = states.tension_at_platform
    margin = BALANCED * size[:, None]
    inside = ((pull >= problem.low - margin) & (pull <= problem.high + margin)).all(axis=1)
    status = np.where(balanced & inside, InverseStatus.HELD, InverseStatus.UNHOLDABLE)
    cut_short = ~settled & ((status == InverseStatus.HELD) | (iterations >= holding_tensions.MAX_ITERATIONS))
    cut_short |= (status == InverseStatus.HELD) & lost(states).any(axis=1)
    status[cut_short] = InverseStatus.NOT_CONVERGED
    lengths = problem.arrays.reading(states.total_length)
    return InverseSolution(states, lengths, residual, status, iterations)


def _joined(parts: list[tuple[np.ndarray, InverseSolution]]) -> InverseSolution:
    """One solution of several with their places in it."""
    order = np.argsort(np.concatenate([places for places, _ in parts]))

    def both(values: list[np.ndarray]) -> np.ndarray:
        return np.concatenate(values)[order]

    solutions = [solution for _, solution in parts]
    names = CableStates.__slots__
    cables = CableStates(*(both([getattr(one.cables, name) for one in solutions]) for name in names))
    rest = ("lengths", "residual_wrench", "status", "iterations")
    return InverseSolution(cables, *(both([getattr(one, name) for one in solutions]) for name in rest))


def _replaced(solution: InverseSolution, index: np.ndarray, other: InverseSolution) -> InverseSolution:
    """A solution with the items `index` taken from another."""
    if not index.size:
        return solution
    kept = np.setdiff1d(np.arange(len(solution.status)), index)
    return _joined([(kept, solution.at(kept)), (index, other)])


def _moved_off(problem: HoldingProblem, items: np.ndarray) -> HoldingProblem:
    """Poses `items` (k,) moved by a metre, so that all cables have a direction; for what is not held anyway."""
    arms = problem.arms
    return replace(problem, arms=replace(arms, points=arms.points + items[:, None, None] * np.array([1.0, 1.0, 1.0])))


def _reshaped(flat: InverseSolution, shape: tuple[int, ...]) -> InverseSolution:
    def back(value: np.ndarray) -> np.ndarray:
        return value.reshape(shape + value.shape[1:])

    cables = CableStates(*(back(getattr(flat.cables, name)) for name in flat.cables.__slots__))
    rest = ("lengths", "residual_wrench", "status", "iterations")
    return InverseSolution(cables, *(back(getattr(flat, name)) for name in rest))

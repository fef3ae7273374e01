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

from cdpr_struct.errors import ConvergenceError, UnholdablePoseError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics import holding_tensions
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import cable_wrench
from cdpr_struct.statics.guides import free_part
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.taut_tensions import suits, taut_tensions

BALANCED = 1e-8  # residual over load and tensions that counts as balanced
_SAME_STIFFNESS = 1e-12  # relative change of EA that ends the search for that at the tension
_MOST_STIFFENINGS = 50
_DIRECTIONS = ("force x", "force y", "force z", "moment x", "moment y", "moment z")


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
    UnholdablePoseError : a pose cannot be held (unless `allow_unheld`); it names cable or direction, and the amount.
    ConvergenceError : the iteration was cut short (unless `allow_unheld`).
    ValueError : bounds that are negative or crossed.
    """
    arrays = RobotArrays.of(robot, None if mass is None else np.asarray(mass, dtype=float))
    place, turn = np.asarray(position, dtype=float), np.asarray(rotation, dtype=float)
    load = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    low, high = _bounds(
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
    solution = _solve(problem)
    if arrays.nonlinearity.any():
        problem, solution = _stiffening(problem, solution)
    if not allow_unheld and (solution.status == InverseStatus.NOT_CONVERGED).any():
        left = float(np.abs(solution.residual_wrench).max())
        hint = "Raise the lower bound: the tensions may lie where cable weight and tension balance."
        raise ConvergenceError("inverse kinematics", left, int(solution.iterations.max()), hint)
    if not allow_unheld and not solution.held.all():
        raise unholdable(problem, solution.held, solution.residual_wrench)
    return _reshaped(solution, shape)


def unholdable(problem: HoldingProblem, held: np.ndarray, residual: np.ndarray) -> UnholdablePoseError:
    """Error about the pose that is worst off: which direction no cable acts in, or which cable, and how much."""
    failed = np.flatnonzero(~held)
    worst = failed[np.linalg.norm(residual[failed] / problem.unit[failed], axis=1).argmax()]
    one = problem.take(np.array([worst]))
    tension, left = (a[0] for a in one.unbounded_tensions())
    who = "the cables cannot hold " + ("this pose" if held.size == 1 else f"{failed.size} of {held.size} poses")
    if np.linalg.norm(left / one.unit[0]) > 1e-6 * np.linalg.norm(one.load / one.unit):
        axis = int(np.abs(left / one.unit[0]).argmax())
        amount = float(abs(left[axis]))
        reason = f"{who}: no cable acts against {amount:.4g} {'N' if axis < 3 else 'N m'} of {_DIRECTIONS[axis]}. "
        return UnholdablePoseError(reason + "Give cable lengths to find where the platform hangs.", None, amount)
    short, excess = one.low[0] - tension, tension - one.high[0]
    cable = int(np.maximum(short, excess).argmax())
    amount = float(max(short[cable], excess[cable]))
    if amount <= 0.0 and tension.size < len(left):
        hint = "Give cable lengths to find where the platform hangs."
        return UnholdablePoseError(f"{who}: {tension.size} cables cannot balance the platform there. {hint}")
    if amount <= 0.0:
        return UnholdablePoseError(f"{who}: the cables' own weight uses up the bounds. Widen them, or move the pose.")
    bound = one.low[0, cable] if short[cable] >= excess[cable] else one.high[0, cable]
    side = "below the lower" if short[cable] >= excess[cable] else "above the upper"
    reason = f"{who}: cable {cable + 1} would need {tension[cable]:.4g} N, {amount:.4g} N {side} bound {bound:.4g} N. "
    return UnholdablePoseError(reason + "Move the pose, change the load or the bounds.", cable + 1, amount)


def _stiffening(problem: HoldingProblem, solution: InverseSolution) -> tuple[HoldingProblem, InverseSolution]:
    """Solutions with the stiffness that the cables have at their tension, until it stays."""
    entered = problem.arrays
    for _ in range(_MOST_STIFFENINGS):
        stiffness, before = entered.stiffness_at(solution.tensions), problem.arrays.axial_stiffness
        if np.abs(stiffness / before - 1.0).max() <= _SAME_STIFFNESS:
            break
        problem = replace(problem, arrays=replace(entered, axial_stiffness=stiffness))
        solution = _solve(problem)
    return problem, solution


def _solve(problem: HoldingProblem) -> InverseSolution:
    """All poses: the taut ones of a batch together, the others one iteration of programs."""
    if not suits(problem):
        return _by_programs(problem)
    taut = taut_tensions(problem)
    found, rest = np.flatnonzero(taut.found), np.flatnonzero(~taut.found)
    if not rest.size:
        return _judged(problem, taut.states, taut.found, taut.iterations)
    parts = []
    if found.size:
        kept = taut.states.at(found)
        parts.append(_judged(problem.take(found), kept, taut.found[found], taut.iterations[found]))
    parts.append(_by_programs(problem.take(rest)))
    return _joined(parts, np.argsort(np.concatenate([found, rest])))


def _by_programs(problem: HoldingProblem) -> InverseSolution:
    tension, iterations, settled = problem.solve()
    states = problem.model.hold(problem.arrays, problem.arms.points, tension).states
    return _judged(problem, states, settled, iterations)


def _judged(
    problem: HoldingProblem, states: CableStates, settled: np.ndarray, iterations: np.ndarray
) -> InverseSolution:
    residual = free_part(cable_wrench(states, problem.arms) + problem.load, problem.arrays)
    size = np.linalg.norm(problem.load / problem.unit, axis=1) + states.tension_at_platform.sum(axis=1)
    balanced = np.linalg.norm(residual / problem.unit, axis=1) <= BALANCED * size
    pull = states.tension_at_platform
    margin = BALANCED * size[:, None]
    inside = ((pull >= problem.low - margin) & (pull <= problem.high + margin)).all(axis=1)
    status = np.where(balanced & inside, InverseStatus.HELD, InverseStatus.UNHOLDABLE)
    cut_short = ~settled & ((status == InverseStatus.HELD) | (iterations >= holding_tensions.MAX_ITERATIONS))
    status[cut_short] = InverseStatus.NOT_CONVERGED
    lengths = problem.arrays.reading(states.total_length)
    return InverseSolution(states, lengths, residual, status, iterations)


def _joined(parts: list[InverseSolution], order: np.ndarray) -> InverseSolution:
    """One solution of several, its items in another order."""

    def both(values: list[np.ndarray]) -> np.ndarray:
        return np.concatenate(values)[order]

    cables = CableStates(*(both([getattr(part.cables, name) for part in parts]) for name in CableStates.__slots__))
    rest = ("lengths", "residual_wrench", "status", "iterations")
    return InverseSolution(cables, *(both([getattr(part, name) for part in parts]) for name in rest))


def _bounds(lower: npt.ArrayLike, upper: npt.ArrayLike, m: int) -> tuple[np.ndarray, np.ndarray]:
    low, high = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    if not ((low >= 0.0).all() and np.isfinite(low).all()):
        raise ValueError(f"lower_bound must be finite and >= 0 N, got {low.min()!r}")
    pair = []
    for name, bound in (("lower_bound", low), ("upper_bound", high)):
        if bound.ndim and bound.shape[-1] not in (1, m):
            raise ValueError(f"{name} must have one entry per cable ({m}), got shape {bound.shape}")
        pair.append(np.broadcast_to(bound, (*bound.shape[:-1], m)))
    if not (low < high).all():
        raise ValueError(f"upper_bound must be above lower_bound, got {high.min()!r} N and {low.max()!r} N")
    return pair[0], pair[1]


def _reshaped(flat: InverseSolution, shape: tuple[int, ...]) -> InverseSolution:
    def back(value: np.ndarray) -> np.ndarray:
        return value.reshape(shape + value.shape[1:])

    cables = CableStates(*(back(getattr(flat.cables, name)) for name in flat.cables.__slots__))
    rest = ("lengths", "residual_wrench", "status", "iterations")
    return InverseSolution(cables, *(back(getattr(flat, name)) for name in rest))

"""Which tensions should the cables have? Sagging force distribution with bounds, eqs (5.1)-(5.9), batch over poses."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.distribution_feasibility import LeastUnbalance, explain, least_unbalance
from cdpr_struct.statics.distribution_problem import DistributionProblem, Optimum, Tangent
from cdpr_struct.statics.distribution_restarts import bettered, searched_elsewhere
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.tension_bound import chord_tension_at, chord_tension_at_length, constant, floor_at
from cdpr_struct.statics.tension_cost import EuclideanNorm, TensionCost

_AT_BOUND = 1e-7  # relative distance that counts as lying on a bound


class DistributionStatus(IntEnum):
    """What was found for one pose."""

    OPTIMAL = 0
    INFEASIBLE = 1  # no distribution within the bounds exists
    NOT_FOUND = 2  # none was found, or its optimum was not reached


@dataclass(frozen=True, slots=True, eq=False)
class TensionDistribution:
    """Tensions at k poses.

    cables          : CableStates (k, m)
    lengths         : (k, m) unstrained, from the frame anchors on, as the encoders are to say them [m]
    lower, upper    : (k, m) bounds on the tension at the platform [N]
    cost            : (k,) what was minimised, in its own unit
    residual_wrench : (k, 6) what is left unbalanced [N, N m]
    kkt_residual    : (k,) how far the optimality conditions are from being met: largest of the step that would still
                      improve the cost over the largest tension, and the unbalanced wrench over load and tensions
    rank            : (k,) of the wrench matrix, and freedoms a guide holds; below 6 the platform can move
    status, iterations : (k,); `DistributionStatus` values
    """

    cables: CableStates
    lengths: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    cost: np.ndarray
    residual_wrench: np.ndarray
    kkt_residual: np.ndarray
    rank: np.ndarray
    status: np.ndarray
    iterations: np.ndarray

    @property
    def tensions(self) -> np.ndarray:
        """(k, m) at the platform [N]."""
        return self.cables.tension_at_platform

    @property
    def at_lower(self) -> np.ndarray:
        """(k, m) bool: the cable lies on its lower bound."""
        return self.tensions <= self.lower * (1.0 + _AT_BOUND)

    @property
    def at_upper(self) -> np.ndarray:
        """(k, m) bool: the cable lies on its upper bound, its force limit."""
        return self.tensions >= self.upper * (1.0 - _AT_BOUND)


def distribute(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    lower_bound: npt.ArrayLike | None = None,
    upper_bound: npt.ArrayLike | None = None,
    longest: npt.ArrayLike = np.inf,
    cost: TensionCost | None = None,
    model: str | CableModel = "sagging",
    allow_unheld: bool = False,
) -> TensionDistribution:
    """Tensions of least cost that hold the platform at k poses.

    Parameters
    ----------
    position, rotation : (k, 3) [m], (k, 3, 3) platform to world; a single pose counts as k = 1
    external_wrench : (k, 6) or (6,) on the platform about its origin beside its weight, world axes [N, N m]
    lower_bound, upper_bound : scalar, (m,) or (k, m) on the tension at the platform [N]; None: the robot's own limits
    longest : the same, on the unstrained length [m], eq. (5.8)
    cost : default the Euclidean norm
    model : "sagging", "spring" or "ideal"
    allow_unheld : return poses without a distribution with their status, instead of raising

    Raises
    ------
    UnholdablePoseError : some pose has no distribution within the bounds; names the worst, the cable and the amount.
    """
    place = np.atleast_2d(np.asarray(position, dtype=float))
    load = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    holding = holding_problem(robot, place, rotation, load, model)
    low = holding.arrays.force_min if lower_bound is None else np.asarray(lower_bound, dtype=float)
    high = holding.arrays.force_max if upper_bound is None else upper_bound
    floor = floor_at(holding, constant(low))
    problem = bounded_problem(holding, floor, high, longest, EuclideanNorm() if cost is None else cost)
    return solve_distribution(problem, lambda i: f"pose {i + 1}:", allow_unheld)


def holding_problem(
    robot: Robot | RobotArrays,
    position: np.ndarray,
    rotation: npt.ArrayLike,
    external_wrench: np.ndarray,
    model: str | CableModel = "sagging",
) -> HoldingProblem:
    """Poses (k, 3), (k, 3, 3) with their load (k, 6), without bounds."""
    arrays, k = RobotArrays.of(robot), len(position)
    turn = np.broadcast_to(np.asarray(rotation, dtype=float), (k, 3, 3))
    load = np.broadcast_to(external_wrench, (k, 6))
    none = np.zeros((k, arrays.cable_count))
    return HoldingProblem.at(arrays, cable_model(model), (position, turn), load, (none, none + np.inf))


def bounded_problem(
    holding: HoldingProblem,
    lower_bound: tuple[np.ndarray, np.ndarray],
    upper_bound: npt.ArrayLike,
    longest: npt.ArrayLike,
    cost: TensionCost,
) -> DistributionProblem:
    """The problem with lower bounds as found by `tension_bound` or from a frequency.

    lower_bound : chord tensions (k, m) and the tensions at the platform there (k, m) [N]

    Raises
    ------
    ValueError : upper bounds that are not positive, or a cost that needs upper bounds where there are none.
    """
    floor, low = lower_bound
    shape, size = floor.shape, np.linalg.norm(holding.load / holding.unit, axis=1, keepdims=True)
    high = np.broadcast_to(np.asarray(upper_bound, dtype=float), shape)
    if not (high > 0.0).all():
        raise ValueError(f"upper_bound must be > 0 N, got {high.min()!r}")
    if not np.isfinite(high).all() and cost.name in ("middle", "centre"):
        raise ValueError(f"cost {cost.name} needs a finite upper_bound")
    least = 1e-9 * (size + 1.0)
    if np.isfinite(longest).any():
        least = np.maximum(least, chord_tension_at_length(holding, np.asarray(longest, dtype=float)))
    if (least > floor).any():
        floor = np.maximum(floor, least)
        low = holding.model.hold(holding.arrays, holding.arms.points, floor).states.tension_at_platform
    ceiling = high
    if np.isfinite(high).any():
        tau, reached = chord_tension_at(holding, constant(np.where(np.isfinite(high), high, low)))
        ceiling = np.where(np.isfinite(high), np.where(reached > high * (1.0 + 1e-9), 0.0, tau), np.inf)
    return DistributionProblem(replace(holding, low=low, high=high), floor, ceiling, cost, size)


def solve_distribution(
    problem: DistributionProblem, where: Callable[[int], str], allow_unheld: bool = False
) -> TensionDistribution:
    """Tensions of least cost.

    Parameters
    ----------
    where : how an error names pose i, like "at t = 3 s"
    allow_unheld : return poses without a distribution with their status, instead of raising

    Raises
    ------
    UnholdablePoseError : no distribution within the bounds.
    """
    crossed = problem.ceiling <= problem.floor
    if crossed.any():
        raise _crossed_bounds(problem, crossed, where)
    optimum = problem.solve()
    failed = np.flatnonzero(~optimum.found)
    status = np.where(optimum.found, DistributionStatus.OPTIMAL, DistributionStatus.NOT_FOUND)
    if failed.size:
        ends = least_unbalance(problem.take(failed))
        again = failed[ends.feasible]
        if again.size:
            optimum = searched_elsewhere(problem, optimum, again, ends.chord_tension[ends.feasible])
            status[again[optimum.found[again]]] = DistributionStatus.OPTIMAL
        status[failed[ends.proven]] = DistributionStatus.INFEASIBLE
        optimum.chord_tension[failed[~ends.feasible]] = ends.chord_tension[~ends.feasible]
        if not allow_unheld:
            _require_held(problem, status, failed, ends, where)
    held = problem.hold(optimum.chord_tension)
    tangent = problem.tangent_of(held)
    if bettered(problem, optimum, tangent):
        held = problem.hold(optimum.chord_tension)
        tangent = problem.tangent_of(held)
    return _distribution(problem, optimum, held.states, tangent, status)


def _require_held(
    problem: DistributionProblem,
    status: np.ndarray,
    failed: np.ndarray,
    ends: LeastUnbalance,
    where: Callable[[int], str],
) -> None:
    """Raise about poses without a distribution."""
    out = ~ends.feasible
    lost = failed[out]
    if lost.size:
        left = LeastUnbalance(ends.chord_tension[out], ends.wrench[out], ends.feasible[out], ends.proven[out])
        raise explain(problem.take(lost), left, lambda i: where(int(lost[i])), len(status))
    stuck = np.flatnonzero(status != DistributionStatus.OPTIMAL)
    if stuck.size:
        name = where(int(stuck[0]))
        raise UnholdablePoseError(f"{name} tensions within the bounds exist, but the best were not reached.")


def _crossed_bounds(
    problem: DistributionProblem, crossed: np.ndarray, where: Callable[[int], str]
) -> UnholdablePoseError:
    excess = np.where(crossed, problem.holding.low - problem.holding.high, -np.inf)
    pose, cable = np.unravel_index(int(excess.argmax()), excess.shape)
    low, high = problem.holding.low[pose, cable], problem.holding.high[pose, cable]
    return UnholdablePoseError(
        f"{where(int(pose))} cable {cable + 1} must carry at least {low:.4g} N, {low - high:.4g} N above its upper "
        f"bound {high:.4g} N. Raise the upper bound, or ask for less.",
        int(cable) + 1,
        float(low - high),
    )


def _distribution(
    problem: DistributionProblem, optimum: Optimum, states: CableStates, tangent: Tangent, status: np.ndarray
) -> TensionDistribution:
    holding = problem.holding
    values = np.linalg.svd(tangent.matrix, compute_uv=False)
    finite = np.where(np.isfinite(holding.unit), holding.unit, 0.0)  # a guide takes what is left over there
    return TensionDistribution(
        cables=states,
        lengths=holding.arrays.reading(states.total_length),
        lower=holding.low,
        upper=holding.high,
        cost=problem.cost.total(states.tension_at_platform, holding.low, holding.high),
        residual_wrench=tangent.wrench * finite,
        kkt_residual=np.maximum(optimum.last_step, tangent.unbalanced),
        rank=(values > 1e-9 * values[:, :1]).sum(axis=1) + np.isinf(problem.holding.unit).sum(axis=1),
        status=status,
        iterations=optimum.iterations,
    )

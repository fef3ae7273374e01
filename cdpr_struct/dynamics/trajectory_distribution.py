"""Cable forces along a trajectory (chapter 5): lower bounds by rule, distribution, the frequencies that come of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from cdpr_struct.dynamics.fundamental_frequency import chord_tension_at_frequency, fundamental_frequency
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.tension_bound import chord_tension_at, constant, floor_at, printed_bound
from cdpr_struct.statics.tension_cost import EuclideanNorm, TensionCost
from cdpr_struct.statics.tension_distribution import (
    TensionDistribution,
    bounded_problem,
    holding_problem,
    solve_distribution,
)
from cdpr_struct.statics.trajectory import Trajectory
from cdpr_struct.statics.winch_work import WinchWork, winch_work

BoundRule = Literal["fixed", "pose-dependent", "frequency"]
BOUND_RULES: tuple[BoundRule, ...] = get_args(BoundRule)
THESIS_B = 4.0 * np.pi
"""[rad/s] section 5.3.2."""

_TIED = 1e-4  # relative: a bound this close to the largest sets it too


@dataclass(frozen=True, slots=True, eq=False)
class TrajectoryDistribution:
    """Cable forces at k instants of a trajectory.

    rule, b      : which lower bound, and the frequency it asks for [rad/s]
    demand       : (k, m) lower bound that each cable asks for at each instant [N]; "fixed" is the largest of them
    distribution : tensions (k, m) with their bounds
    frequency    : (k, m) lowest natural frequency of each cable, both ends held, exact model [rad/s]
    work         : of the winches
    raised       : (k, m) bool, where the cable's force_min lies above the rule's bound and stands in its place
    """

    robot: Robot
    trajectory: Trajectory
    rule: BoundRule
    b: float
    cost: TensionCost
    model: str
    demand: np.ndarray
    distribution: TensionDistribution
    frequency: np.ndarray
    work: WinchWork
    raised: np.ndarray

    @property
    def max_force(self) -> np.ndarray:
        """(m,) largest tension of each cable at the platform [N]."""
        return self.distribution.tensions.max(axis=0)

    @property
    def bound_is_set_by(self) -> list[tuple[int, float]]:
        """(cable, time [s]) where the lower bound is largest; of several cables that tie, each with its own instant."""
        peak, time = self.demand.max(axis=0), self.trajectory.time
        cables = np.flatnonzero(peak >= peak.max() * (1.0 - _TIED))
        return [(int(i) + 1, float(time[self.demand[:, i].argmax()])) for i in cables]

    @property
    def raised_share(self) -> float:
        """Share of the k m cable-instants at which the robot's force_min is the lower bound [-]."""
        return float(self.raised.mean())

    @property
    def missed(self) -> np.ndarray:
        """(k, m) bool: the cable's lowest frequency stays below b."""
        return self.frequency < self.b


def distribute_along(
    robot: Robot,
    trajectory: Trajectory,
    rule: BoundRule = "pose-dependent",
    b: float = THESIS_B,
    upper_bound: npt.ArrayLike | None = None,
    longest: npt.ArrayLike = np.inf,
    cost: TensionCost | None = None,
    model: str | CableModel = "sagging",
) -> TrajectoryDistribution:
    """Distribute the cable forces along a trajectory, inertia forces included.

    Parameters
    ----------
    rule : lower bound. "fixed" (5.16), "pose-dependent" (5.15), both as printed; "frequency": the tension at which the
           exact lowest frequency of the cable is b. Where the robot's force_min is larger, it stands instead
    b : [rad/s] > 0
    upper_bound, longest : (m,) or scalar, largest tension [N] (None: the robot's force_max) and unstrained length [m]
    cost : default the Euclidean norm of the tensions
    model : "sagging", or "ideal" for the straight weightless cables of the thesis's first guess

    Raises
    ------
    UnholdablePoseError : an instant has no distribution within the bounds; names time, cable and amount.
    ValueError : b not positive, or unusable bounds.
    """
    if not 0.0 < b < np.inf:
        raise ValueError(f"b must be positive, got {b!r}")
    price = EuclideanNorm() if cost is None else cost
    wrench = trajectory.inertia_wrench(robot.platform)
    holding = holding_problem(robot, trajectory.position, trajectory.rotation, wrench, model)
    wanted, demand = _BOUNDS[rule](robot, holding, b)
    lower_bound, raised = _at_least(wanted, robot.force_min, holding)
    highest = robot.force_max if upper_bound is None else upper_bound
    problem = bounded_problem(holding, lower_bound, highest, longest, price)
    time = trajectory.time
    distribution = solve_distribution(problem, lambda i: f"at t = {time[i]:.4g} s")
    frequency = fundamental_frequency(distribution.cables, robot.linear_density, robot.extensions)
    work = winch_work(time, distribution.cables)
    return TrajectoryDistribution(
        robot, trajectory, rule, b, price, holding.model.name, demand, distribution, frequency, work, raised
    )  # fmt: skip


Floor = tuple[np.ndarray, np.ndarray]
"""Chord tension and tension at the platform (k, m) [N] of the lower bound."""


def _at_least(wanted: Floor, force_min: np.ndarray, holding: HoldingProblem) -> tuple[Floor, np.ndarray]:
    """The bound of a rule, and instead of it that of the robot (m,) [N] where this is larger: there (k, m) is True."""
    raised = force_min > wanted[1]
    if not raised.any():
        return wanted, raised
    least = floor_at(holding, constant(force_min))
    return (np.where(raised, least[0], wanted[0]), np.where(raised, least[1], wanted[1])), raised


def _pose_dependent(robot: Robot, holding: HoldingProblem, b: float) -> tuple[Floor, np.ndarray]:
    floor = floor_at(holding, printed_bound(holding, b))
    return floor, floor[1]


def _fixed(robot: Robot, holding: HoldingProblem, b: float) -> tuple[Floor, np.ndarray]:
    """The largest of all pose-dependent bounds, for every cable and instant."""
    demand = chord_tension_at(holding, printed_bound(holding, b))[1]
    return floor_at(holding, constant(demand.max())), demand


def _frequency(robot: Robot, holding: HoldingProblem, b: float) -> tuple[Floor, np.ndarray]:
    floor = chord_tension_at_frequency(holding, robot.linear_density, b, robot.extensions)
    return floor, floor[1]


_BOUNDS: dict[BoundRule, Callable[[Robot, HoldingProblem, float], tuple[Floor, np.ndarray]]] = {
    "fixed": _fixed,
    "pose-dependent": _pose_dependent,
    "frequency": _frequency,
}

"""Do cables hold a pose under every wrench of a set, and with which margins of force?

At each wrench the sagging cables are balanced anew, lengths and shapes included, by the tensions of least norm within
the limits (`inverse`); no structure matrix of another state stands in for them. Between the vertices nothing is
computed. On straight weightless cables the wrenches that can be held are a convex set, so that vertices speak for the
whole set. The weight that a sagging cable lays on the platform changes with its tension: there this is an idealisation,
good to what that weight changes by between the vertices.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse


@dataclass(frozen=True, slots=True, eq=False)
class WrenchFeasibility:
    """Poses of a flat batch (n) under wrenches (w).

    feasible     : (n, w) bool, held within the limits under each wrench
    slack_margin : (n,) [N] smallest cable force less its lower limit, at the worst wrench; nan if one is not held. A
        force that lies beyond its limit by rounding has no margin: 0
    force_margin : (n,) [N] upper limit less the cable force, the least; inf without a limit
    """

    feasible: np.ndarray
    slack_margin: np.ndarray
    force_margin: np.ndarray


def force_margins(robot: Robot, tension: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(...) least distances of tensions (..., m) from the lower and from the upper limits [N]."""
    return (tension - robot.force_min).min(axis=-1), (robot.force_max - tension).min(axis=-1)


def wrench_feasibility(
    robot: Robot, position: np.ndarray, rotation: np.ndarray, wrenches: np.ndarray, found: InverseSolution | None = None
) -> WrenchFeasibility:
    """Of poses (n, 3) [m], (3, 3) or (n, 3, 3), under wrenches (w, 6) beside the robot's load, world axes [N, N m].

    found : the solutions (n,) under the robot's load alone, if they are known; they stand in where a wrench is zero
    """
    count = len(position)
    feasible = np.zeros((count, len(wrenches)), dtype=bool)
    slack, most = np.full(count, np.inf), np.full(count, np.inf)
    for number, wrench in enumerate(wrenches):
        if found is not None and not wrench.any():
            solution = found
        else:
            solution = inverse(robot, position, rotation, external_wrench=wrench, allow_unheld=True)
        feasible[:, number] = solution.held
        low, high = force_margins(robot, solution.tensions)
        slack, most = np.minimum(slack, low), np.minimum(most, high)
    good = feasible.all(axis=1)
    margins = (np.where(good, np.maximum(margin, 0.0), np.nan) for margin in (slack, most))
    return WrenchFeasibility(feasible, *margins)

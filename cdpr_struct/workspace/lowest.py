"""The lowest natural frequencies over the workspace, each in its bracket."""

import numpy as np

from cdpr_struct.dynamics.many_poses import lowest_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.workspace.rest_columns import rest_columns
from cdpr_struct.workspace.work_list import Columns

LOWEST = 12


def lowest(robot: Robot, positions: np.ndarray, rotation: np.ndarray, given: InverseSolution | None = None) -> Columns:
    """The first frequencies f1_Hz to f12_Hz, multiple ones repeated, and the widest bracket that holds one; exact
    catenaries.

    quick: without the certified modes of that pose, see `FrequenciesOfPoses`. Minimum-norm tensions within the robot's
    force limits. nan where the platform is not held, or balanced but not stable.
    """
    n = len(positions)
    hertz, width, quick = np.full((n, LOWEST), np.nan), np.full(n, np.nan), np.zeros(n, dtype=bool)
    solution = inverse(robot, positions, rotation, allow_unheld=True) if given is None else given
    held = np.flatnonzero(solution.held)
    if held.size:
        states = solution.cables if held.size == n else solution.cables.at(held)
        turned = np.broadcast_to(rotation, (n, 3, 3))[held]
        found = lowest_frequencies(OperatingPoint(robot, positions[held], turned, states), LOWEST)
        hertz[held], quick[held] = found.hertz, found.quick
        width[held] = np.ptp(found.bracket_hertz, axis=-1).max(axis=-1)
    return {
        **{f"f{i + 1}_Hz": hertz[:, i] for i in range(LOWEST)},
        "bracket_max_Hz": width,
        "quick": quick,
        **rest_columns(solution),
    }

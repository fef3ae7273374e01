"""Which stiffness have cables that stiffen with tension, once tensions and stiffness agree?"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays

MOST_ROUNDS = 50
_SAME = 1e-12  # relative change of EA that ends the search
_UNLIKE = 1e-8  # from which on it has not been found


def settled_stiffness(
    entered: RobotArrays, tension: np.ndarray, again: Callable[[RobotArrays], np.ndarray]
) -> np.ndarray:
    """Solve again with the stiffness that the cables have at their tension, until it stays; (n,) bool: where it does.

    entered : the robot, whose stiffness the first tensions (n, m) [N] were found with
    again   : solves with the robot's cables at another stiffness, and says the tensions (n, m) [N] then
    """
    before = entered.axial_stiffness
    for _ in range(MOST_ROUNDS):
        stiffness = entered.stiffness_at(tension)
        change = np.abs(stiffness / before - 1.0)
        if change.max() <= _SAME:
            break
        tension, before = again(replace(entered, axial_stiffness=stiffness)), stiffness
    settled = ~(change > _UNLIKE).any(axis=-1)
    return np.asarray(settled)

"""Balance at locked lengths, beside a rest, of robots whose cables stiffen with tension."""

from dataclasses import replace

import numpy as np

from cdpr_struct.errors import CdprError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.locked_balance import LockedBalance
from cdpr_struct.statics.stiffening import settled_stiffness

_STEP = 1e-4  # in ln T, by which the law of stiffness is differentiated


def settled(balance: LockedBalance, position: np.ndarray, rotation: np.ndarray) -> LockedBalance:
    """Robots (n) with the EA that their cables have at positions (n, 3) and rotations (n, 3, 3).

    Raises
    ------
    CdprError : the law has no such EA.
    """
    if not balance.arrays.stiffens:
        return balance
    entered = balance.arrays

    def tension(arrays: RobotArrays) -> np.ndarray:
        nonlocal balance
        balance = replace(balance, arrays=arrays)
        return balance.states(position, rotation).tension_at_platform

    if not settled_stiffness(entered, tension(entered), tension).all():
        raise CdprError("there is no band: the stiffness of a cable does not settle at its tension")
    return balance


def in_static_motion(entered: LockedBalance, position: np.ndarray, rotation: np.ndarray) -> LockedBalance:
    """Robots (n) with cables of constant EA that pull as they do at positions (n, 3) and rotations (n, 3, 3), and gain
    tension as fast in slow motion.

    Raises
    ------
    CdprError : as `settled`.
    """
    if not entered.arrays.stiffens:
        return entered
    balance = settled(entered, position, rotation)
    states = balance.states(position, rotation)
    up, down = (entered.arrays.stiffness_at(states.tension_at_platform * np.exp(way)) for way in (_STEP, -_STEP))
    ratio = 1.0 / (1.0 - np.log(up / down) / (2.0 * _STEP))
    stiffness = ratio * states.axial_stiffness + (ratio - 1.0) * states.tension
    longer = stiffness / (ratio * states.axial_stiffness)
    density = balance.arrays.linear_density / longer
    arrays = replace(balance.arrays, axial_stiffness=stiffness, linear_density=density)
    return replace(balance, arrays=arrays, length=balance.length * longer)

"""Which stiffness have cables that stiffen with tension, once tensions and stiffness agree, and in small motion?"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates

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


def in_small_motion(arrays: RobotArrays, states: CableStates) -> tuple[RobotArrays, CableStates]:
    """Robot and cables for motion about rest, in which the stiffness is the incremental one.

    Each cable is the one of constant EA that is as long, as heavy and as tight at rest, and gains tension over length
    as fast: q EA + (q - 1) T, q the ratio and EA the secant, on an unstrained length 1 + (1 - 1 / q) T / EA times its
    own. Cables that are of this kind already stay.
    """
    shape = np.broadcast_shapes(states.length.shape, (*arrays.incremental_ratio.shape, 1))
    ratio = np.broadcast_to(arrays.incremental_ratio[..., None], shape)
    if not (ratio != 1.0).any():
        return arrays, states
    tension, before = states.tension, states.incremental_ratio
    secant = (states.axial_stiffness - (before - 1.0) * tension) / before
    stiffness = ratio * secant + (ratio - 1.0) * tension
    whole = stiffness / (ratio * secant)
    longer = whole * before * secant / states.axial_stiffness
    lengths = {name: getattr(states, name) * longer for name in ("length", "wrapped_length", "let_out")}
    found = replace(
        states, axial_stiffness=stiffness, weight=states.weight / longer, incremental_ratio=ratio,
        lump_place=states.lump_place * longer[..., None], **lengths,
    )  # fmt: skip
    none = PARAMETERS["incremental_ratio"].without_effect()
    return replace(arrays, linear_density=arrays.linear_density / whole, incremental_ratio=none), found

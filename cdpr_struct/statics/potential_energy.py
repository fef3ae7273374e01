"""Potential energy of platform and cables at locked lengths: which of several equilibria lies lowest?

Along a hanging cable w z - T - T^2/(2 EA) does not change, so its weight and stretch together hold

    integral (T + T^2/EA) ds - L (T_0 + T_0^2/(2 EA) - w z_0),

0 the frame end. With W = w L, S = T_0 + T_1, r = W/S and the vertical pulls V,

    integral T ds   = L/2 [ S/2 + (V_0 + V_1)^2 / (2 S) + 2 H^2 artanh(r) / (r S) ],
    integral T^2 ds = L [ H^2 + (V_0^2 + V_0 V_1 + V_1^2) / 3 ],

which has no cancellation from taut to slack and holds for weightless cables, too.
"""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, weight_force
from cdpr_struct.statics.masts import MastShapes


def potential_energy(
    arrays: RobotArrays, position: np.ndarray, rotation: np.ndarray, states: CableStates, wrench: np.ndarray
) -> np.ndarray:
    """Energy of platforms (...) at rest at locked lengths, or tensions of winches [J]; only differences at the same
    lengths and tensions mean something.

    Weight, cables, constant forces, a hose, elements in line and masts are counted. Cable on a pulley counts by its
    stretch and its weight, as if it lay where the free cable begins. Cables whose EA depends on their tension are taken
    with EA as in `states`.

    Parameters
    ----------
    position, rotation : (..., 3) [m], (..., 3, 3)
    wrench : (..., 6); its force counts. A moment in it, or of the robot, has no potential and is left out

    nan where wind pushes hanging cables: its drag has no potential.
    """
    if arrays.has_cable_drag and states.weight.any():
        return np.full(position.shape[:-1], np.nan)
    arms = PlatformArms.at(arrays, position, rotation)
    platform = -(weight_force(arrays) * (position + arms.center)).sum(axis=-1)
    loads = -((arrays.constant_force + wrench[..., :3]) * position).sum(axis=-1)
    hose = 0.5 * arrays.hose * ((arrays.hose_center - position) ** 2).sum(axis=-1)
    height = ((arms.points - states.offset) * states.up).sum(axis=-1)
    cables = (_of_whole_cables(states, height) + _behind_frame(arrays, states, height)).sum(axis=-1)
    masts = MastShapes.soft(arrays).energy(states.force_at_frame) if arrays.has_masts else 0.0
    winches = _of_winches(arrays, states, height).sum(axis=-1) if arrays.has_tension_winches else 0.0
    return np.asarray(platform + loads + hose + cables + masts + winches)


def _of_winches(arrays: RobotArrays, states: CableStates, height: np.ndarray) -> np.ndarray:
    """(..., m) energy of winches that hold a tension T: they give cable away for T + T^2/(2 EA) a metre, and weight at
    the height of the frame end [J]."""
    tension = arrays.winch_tension
    given = (tension + 0.5 * tension**2 / states.axial_stiffness) * states.total_length
    return np.where(tension > 0.0, given - states.weight * height * states.length, 0.0)


def _behind_frame(arrays: RobotArrays, states: CableStates, height: np.ndarray) -> np.ndarray:
    """(..., m) energy of cable on pulleys, and of elements in line, which let cable out at the frame end [J]."""
    square = 0.5 * states.tension_at_frame**2
    wrapped = square * states.wrapped_length / states.axial_stiffness
    in_line = square * arrays.series_compliance / (1.0 + states.tension_at_frame / states.axial_stiffness)
    return np.asarray(wrapped + in_line + states.weight * height * (states.wrapped_length - states.let_out))


def _of_whole_cables(states: CableStates, height: np.ndarray) -> np.ndarray:
    """(..., m) energy of the free cables and the point masses on them, frame ends at `height` (..., m) [J]."""
    if not states.has_lumps:
        return _of_cables(states.force_x, states.force_z, states.length, states.axial_stiffness, states.weight, height)
    parts = states.segments
    arcs = 1.0 - np.cumsum(parts[2], axis=-1) / states.length[..., None]  # where they begin, from the frame end
    starts = height[..., None] + states.profile(arcs)[1]
    lifted = (states.lump_weight * starts[..., :-1]).sum(axis=-1)
    return np.asarray(_of_cables(parts[0], parts[1], parts[2], parts[3], parts[4], starts).sum(axis=-1) + lifted)


def _of_cables(
    force_x: np.ndarray, force_z: np.ndarray, length: np.ndarray, axial_stiffness: np.ndarray, weight: np.ndarray,
    height: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """(...) energy of uniform cables, their frame ends at `height` (...) [J]."""
    upper, lower = force_z, force_z - weight * length
    first, last = np.hypot(force_x, lower), np.hypot(force_x, upper)
    both = np.maximum(first + last, 1e-300)
    ratio = np.minimum(weight * length / both, 1.0)
    bend = np.where(ratio > 1e-8, np.arctanh(np.minimum(ratio, 1.0 - 1e-16)) / np.maximum(ratio, 1e-8), 1.0)
    pull = 0.5 * (0.5 * both + 0.5 * (lower + upper) ** 2 / both + 2.0 * force_x**2 * bend / both)
    square = force_x**2 + (lower**2 + lower * upper + upper**2) / 3.0
    there = first + 0.5 * first**2 / axial_stiffness - weight * height
    return np.asarray(length * (pull + square / axial_stiffness - there))

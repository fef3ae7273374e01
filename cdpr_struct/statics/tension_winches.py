"""Cables whose winches hold the tension at the frame end instead of the length.

However much cable that takes, it is paid out. Of the two hanging cables with the same tension the taut one is meant:
the other would run off its winch.
"""

from collections.abc import Callable

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates, span_and_rise

_ITERATIONS = 60
_SETTLED = 1e-14  # of the tension
_SLACKEST = 3.0  # largest w chord / (2 tau) that is tried: past the least tension of any level cable
_SAME = 1e-9  # of the tension: what counts as held
_NEAREST = 0.05  # least slope of the tension at the frame over that along the chord on the taut side of its minimum

Held = Callable[[np.ndarray], CableStates]
"""States of cables of given chord tensions (..., m) [N]."""


def with_winches(arrays: RobotArrays, locked: CableStates, held: CableStates) -> CableStates:
    """Cables at held tension where winches hold it, cables at locked lengths elsewhere."""
    winch = np.broadcast_to(arrays.winch_tension > 0.0, locked.length.shape)

    def chosen(name: str) -> np.ndarray:
        one, other = getattr(held, name), getattr(locked, name)
        mask = winch[..., None] if other.ndim > winch.ndim else winch
        return np.where(mask, one, other)

    return CableStates(*(chosen(name) for name in CableStates.__slots__))


def held_at_frame(arrays: RobotArrays, points: np.ndarray, hold: Held) -> CableStates:
    """Sagging cables that end at `points` (..., m, 3) with the tension of their winches at the frame end.

    Newton on the chord tension, from above: the tension at the frame is convex in it, and grows as fast where the cable
    is taut. Cables of other winches get a tension like that of their weight. Where the weight alone pulls more than the
    winch, the cable is that of least tension, near which the search stops.
    """
    offset = points - arrays.frame_anchors
    chord = np.linalg.norm(offset, axis=-1)
    shape = np.broadcast_shapes(chord.shape, arrays.winch_tension.shape)
    load, up = arrays.cable_load(offset)
    weight = np.broadcast_to(load * chord + arrays.lump_weight.sum(axis=-1), shape)
    wanted = np.broadcast_to(np.where(arrays.winch_tension > 0.0, arrays.winch_tension, 2.0 * weight), shape)
    rise = np.broadcast_to(span_and_rise(offset, up)[1], shape)
    tension = wanted + 0.5 * np.abs(weight * rise / chord) + 0.5 * weight
    least = 0.5 * weight / _SLACKEST
    states, slope = hold(tension), np.ones(shape)
    miss = states.tension_at_frame - wanted
    for _ in range(_ITERATIONS):
        step = np.maximum(np.maximum(-miss / slope, -0.5 * tension), least - tension)
        if (np.abs(step) <= _SETTLED * tension).all():
            break
        states = hold(tension + step)
        changed = states.tension_at_frame - wanted - miss
        safe = np.where(np.abs(step) > 1e-9 * tension, step, np.inf)
        slope = np.where(np.isfinite(safe), np.clip(changed / safe, _NEAREST, 1.0 / _NEAREST), slope)
        tension, miss = tension + step, miss + changed
    return states


def pulls_as_held(arrays: RobotArrays, states: CableStates) -> np.ndarray:
    """(...) bool: every winch that is to hold its tension does; else the weight of the cable alone pulls more."""
    miss = np.abs(states.tension_at_frame - arrays.winch_tension)
    return np.asarray(((arrays.winch_tension == 0.0) | (miss <= _SAME * arrays.winch_tension)).all(axis=-1))

"""Cables that carry given tensions at the platform: what load cells there say, put into the cable model.

`inverse` chooses tensions; here they are known, and so are the points between which the cables hang. What is left is
how much unstrained cable that takes.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.cable_response import let_out
from cdpr_struct.statics.cable_state import CableStates, heading_and_span, span_and_rise
from cdpr_struct.statics.catenary_length import CatenaryLength, solve_length
from cdpr_struct.statics.masts import with_settled_masts
from cdpr_struct.statics.pulley import pulley_exit, straight_exit

_EXIT_ITERATIONS = 30
_EXIT_SETTLED = 1e-12  # of the unit direction in which a cable leaves its pulley
_EXIT_MET = 1e-8  # of the same: above it the exit was not found


def tensioned(model: CableModel, arrays: RobotArrays, points: np.ndarray, tension: np.ndarray) -> CableStates:
    """Cables with tension (..., m) > 0 [N] at the platform that end at points (..., m, 3), world [m].

    E may change with the tension, masts give way under it, and what is elastic in line stretches. Of two sagging
    cables with the same tension the taut one; where no cable between these points pulls so little, the status is
    `TENSION_TOO_LOW`, and the cable is that of least tension.
    """
    stiff = replace(arrays, axial_stiffness=arrays.stiffness_at(tension)) if arrays.stiffens else arrays
    if model.name != "sagging":
        return model.hold(stiff, points, tension).states
    return with_settled_masts(stiff, lambda moved: _hanging(moved, points, tension), locked=False)[0]


def _hanging(arrays: RobotArrays, points: np.ndarray, tension: np.ndarray) -> CableStates:
    offset = points - arrays.frame_anchors
    if not arrays.has_pulleys:
        return _between(arrays, offset, tension, np.zeros(offset.shape[:-1]), None)[0]
    near: CatenaryLength | None = None
    direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
    for _ in range(_EXIT_ITERATIONS):
        leaving = pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius)
        wrap = arrays.pulley_radius * leaving.wrap_angle
        free = offset - leaving.point
        alike = near is not None and near.length.shape == np.broadcast_shapes(free.shape[:-1], tension.shape)
        states, near = _between(arrays, free, tension, wrap, near if alike else None)
        before = direction
        direction = states.force_at_frame / states.tension_at_frame[..., None]
        turned = float(np.abs(direction - before).max(initial=0.0))
        if turned <= _EXIT_SETTLED:
            break
    if not turned <= _EXIT_MET:
        hint = "The cables hang too slack over their pulleys for these tensions; check tensions and radii."
        raise ConvergenceError("exits from the pulleys at given tensions", turned, _EXIT_ITERATIONS, hint)
    return states


def _between(
    arrays: RobotArrays, offset: np.ndarray, tension: np.ndarray, wrap: np.ndarray, near: CatenaryLength | None
) -> tuple[CableStates, CatenaryLength]:
    """Free catenaries over `offset` (..., m, 3), a strained length `wrap` (..., m) on the pulleys behind them [m]."""
    load, up = arrays.cable_load(offset)
    (heading, span), rise = heading_and_span(offset, up), span_and_rise(offset, up)[1]
    held = solve_length(span, rise, tension, arrays.axial_stiffness, load, near)
    bottom = np.hypot(held.force_x, held.force_z - load * held.length)
    passed = let_out(arrays, bottom, arrays.axial_stiffness)
    shape = np.broadcast_shapes(held.length.shape, passed.shape)

    def whole(value: np.ndarray, core: tuple[int, ...] = ()) -> np.ndarray:
        return np.broadcast_to(value, shape + core)

    states = CableStates(
        whole(offset, (3,)), whole(heading, (3,)), whole(held.length),
        whole(wrap / (1.0 + bottom / arrays.axial_stiffness)),
        whole(held.force_x), whole(held.force_z), whole(arrays.axial_stiffness), whole(load),
        whole(held.status), whole(passed), whole(up, (3,)),
    )  # fmt: skip
    return states, held

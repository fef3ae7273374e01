"""Sagging cables at given length or given tension, over pulleys and with what is elastic in line behind them."""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import exit_jacobian, let_out
from cdpr_struct.statics.cable_segments import LoadedLength, Loading, forces_at_length, length_at_tension
from cdpr_struct.statics.cable_state import CableStates, heading_and_span, span_and_rise
from cdpr_struct.statics.catenary import CatenaryForces, solve_end_forces
from cdpr_struct.statics.catenary_length import CatenaryLength, length_at_chord_tension
from cdpr_struct.statics.fixed_point import FixedPoint
from cdpr_struct.statics.lost_cables import counted_lost
from cdpr_struct.statics.pulley import pulley_exit, straight_exit, turned_back, within_wheel
from cdpr_struct.statics.standstill import Standstill
from cdpr_struct.statics.tension_winches import held_at_frame, with_winches

_EXIT_ITERATIONS = 60  # slack cables whose pulleys turn them far back come slowly at first
_EXIT_REPEATED = 80  # times at most, at large wheels and short or slack cables
_EXIT_TOLERANCE = 1e-14  # of the tension and EA, or of the unit direction
_EXIT_MET = 1e-10  # of the same: above it the exit from the pulley was not found


def hanging(
    arrays: RobotArrays, points: np.ndarray, length: np.ndarray, near: CatenaryForces | None
) -> tuple[CableStates, CatenaryForces]:
    """Cables of unstrained `length` (..., m) [m] that end at `points` (..., m, 3), and their catenaries.

    near : those of cables nearly like these, to begin from
    """
    if arrays.has_tension_winches:
        held = held_at_frame(arrays, points, lambda tension: held_hanging(arrays, points, tension)[0])
        length = np.where(arrays.winch_tension > 0.0, held.total_length, length)
        locked, near = _at_length(arrays, points, length, near)
        return with_winches(arrays, locked, held), near
    return _at_length(arrays, points, length, near)


def _at_length(
    arrays: RobotArrays, points: np.ndarray, length: np.ndarray, near: CatenaryForces | None
) -> tuple[CableStates, CatenaryForces]:
    offset = points - arrays.frame_anchors
    if not (arrays.has_pulleys or arrays.series_compliance.any()):
        zero = np.zeros_like(length)
        return _catenary(arrays, offset, length, zero, zero, near)
    return _catenary_over_pulley(arrays, offset, length, near)


def held_hanging(arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> tuple[CableStates, np.ndarray]:
    """Cables of chord tension (..., m) [N], and the rate of their length with it [m/N]."""
    offset = points - arrays.frame_anchors
    if not arrays.has_pulleys:
        return _catenary_at_tension(arrays, offset, chord_tension, np.zeros(offset.shape[:-1]))
    return _held_over_pulley(arrays, offset, chord_tension)


def _catenary(
    arrays: RobotArrays,
    offset: np.ndarray,
    length: np.ndarray,
    wrapped: np.ndarray,
    passed: np.ndarray,
    near: CatenaryForces | None,
) -> tuple[CableStates, CatenaryForces]:
    load, up = arrays.cable_load(offset)
    (heading, span), rise = heading_and_span(offset, up), span_and_rise(offset, up)[1]
    stiff = np.broadcast_to(arrays.axial_stiffness, length.shape)
    weight = np.broadcast_to(load, length.shape)
    lumps = _lumps(arrays, length.shape)
    if arrays.has_lumps:
        forces = forces_at_length(span, rise, length, Loading(weight, *lumps, stiff), near)
    else:
        forces = solve_end_forces(span, rise, length, stiff, weight, near)
    pull = forces.force_x, forces.force_z
    return CableStates(
        offset, heading, length, wrapped, *pull, stiff, weight, forces.status, passed, up, *lumps
    ), forces


def _lumps(arrays: RobotArrays, shape: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights (..., m, k) of point masses on cables of a shape (..., m)."""
    place, weight = arrays.lump_place, arrays.lump_weight
    return np.broadcast_to(place, shape + place.shape[-1:]), np.broadcast_to(weight, shape + weight.shape[-1:])


def _catenary_over_pulley(
    arrays: RobotArrays, offset: np.ndarray, length: np.ndarray, near: CatenaryForces | None
) -> tuple[CableStates, CatenaryForces]:
    """Newton on the tension vector at the frame end: its direction places the exit from the pulley, its size strains
    the wrapped piece and what is in line behind it."""
    direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
    exit_ = pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius)
    strained = arrays.pulley_radius * exit_.wrap_angle + np.linalg.norm(offset - exit_.point, axis=-1)
    taut = arrays.axial_stiffness * np.maximum(strained / length - 1.0, 0.0)  # what is on the wheel stretches, too
    states, near = _leaving(arrays, offset, length, direction, taut, near)
    vector, standstill = states.force_at_frame, Standstill()
    for _ in range(_EXIT_ITERATIONS):
        tension = np.linalg.norm(vector, axis=-1)
        states, near = _leaving(arrays, offset, length, vector / tension[..., None], tension, near)
        error = states.force_at_frame - vector
        off, size = np.abs(error).max(axis=-1), tension + arrays.axial_stiffness
        open_ = ~(off <= _EXIT_TOLERANCE * size)
        if not open_.any() or standstill.reached(off, open_):
            break
        vector = vector + np.linalg.solve(exit_jacobian(arrays, states), error[..., None])[..., 0]
    back = turned_back(vector / tension[..., None], arrays.pulley_axis, arrays.pulley_radius)
    return counted_lost(states, back | ~(off <= _EXIT_MET * size)), near


def _leaving(
    arrays: RobotArrays,
    offset: np.ndarray,
    length: np.ndarray,
    direction: np.ndarray,
    tension: np.ndarray,
    near: CatenaryForces | None,
) -> tuple[CableStates, CatenaryForces]:
    """Free catenary of a cable that leaves its pulley in `direction` under `tension`."""
    exit_ = pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius)
    wrapped = arrays.pulley_radius * exit_.wrap_angle / (1.0 + tension / arrays.axial_stiffness)
    passed = np.broadcast_to(let_out(arrays, tension, arrays.axial_stiffness), length.shape)
    free = np.maximum(length - wrapped + passed, 1e-3 * length)
    return _catenary(arrays, offset - exit_.point, free, wrapped, passed, near)


def _catenary_at_tension(
    arrays: RobotArrays, offset: np.ndarray, chord_tension: np.ndarray, wrap: np.ndarray
) -> tuple[CableStates, np.ndarray]:
    """State, and rate of the length with the chord tension; `wrap` is the strained length on the pulley."""
    load, up = arrays.cable_load(offset)
    (heading, span), rise = heading_and_span(offset, up), span_and_rise(offset, up)[1]
    cable: CatenaryLength | LoadedLength
    if arrays.has_lumps:
        hung = Loading(load, arrays.lump_place, arrays.lump_weight, arrays.axial_stiffness)
        even = load + arrays.lump_weight.sum(axis=-1) / np.hypot(span, rise)
        nearly = length_at_chord_tension(span, rise, chord_tension, arrays.axial_stiffness, even)
        cable = length_at_tension(span, rise, chord_tension, hung, (nearly.force_z, nearly.length))
    else:
        cable = length_at_chord_tension(span, rise, chord_tension, arrays.axial_stiffness, load)
    bottom = np.hypot(cable.force_x, cable.force_z - load * cable.length - arrays.lump_weight.sum(axis=-1))
    wrapped = wrap / (1.0 + bottom / arrays.axial_stiffness)
    stiff = np.broadcast_to(arrays.axial_stiffness, wrapped.shape)
    weight = np.broadcast_to(load, wrapped.shape)
    states = CableStates(
        offset, heading, cable.length, wrapped, np.where(span > 0.0, cable.force_x, 0.0), cable.force_z, stiff,
        weight, cable.status, np.broadcast_to(let_out(arrays, bottom, stiff), wrapped.shape), up,
        *_lumps(arrays, wrapped.shape),
    )  # fmt: skip
    return states, cable.length_rate


def _held_over_pulley(
    arrays: RobotArrays, offset: np.ndarray, chord_tension: np.ndarray
) -> tuple[CableStates, np.ndarray]:
    """Fixed point of the exit direction; repetition contracts by about radius over chord, extrapolation does more."""
    direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
    search, nowhere = FixedPoint(), within_wheel(offset, arrays.pulley_axis, arrays.pulley_radius)
    for _ in range(_EXIT_REPEATED):
        exit_ = pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius)
        wrap = arrays.pulley_radius * exit_.wrap_angle
        states, length_rate = _catenary_at_tension(arrays, offset - exit_.point, chord_tension, wrap)
        leaving = states.force_at_frame / states.tension_at_frame[..., None]
        turned = np.abs(leaving - direction).max(axis=-1)
        if (nowhere | (turned <= _EXIT_TOLERANCE)).all():
            break
        direction = search.next(direction, leaving)
        direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
    back = turned_back(leaving, arrays.pulley_axis, arrays.pulley_radius)
    states = counted_lost(states, back | ~(turned <= _EXIT_MET))
    return states, length_rate * (1.0 + states.wrapped_length / states.length)  # the wrapped piece stretches alike

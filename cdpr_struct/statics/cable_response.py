"""How the force of a cable changes when its platform end moves or its length changes.

The pulley at the frame end and what is elastic in line behind it are included.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates, cable_stiffness
from cdpr_struct.statics.pulley import exit_rates

_STEEP = 1e-3  # span over chord below which a chord tension by span is rounded


@dataclass(frozen=True, slots=True, eq=False)
class CableResponse:
    """Derivatives of the pull on each cable at its platform end (minus the force on the platform), world.

    stiffness    : (..., m, 3, 3) with respect to the position of the platform end [N/m]
    length_rate  : (..., m, 3) with respect to the unstrained length paid out beyond the frame anchor [N/m]
    frame_rate   : (..., m, 3) of the tension vector at the frame end with respect to that length [N/m]
    """

    stiffness: np.ndarray
    length_rate: np.ndarray
    frame_rate: np.ndarray


def end_stiffness(arrays: RobotArrays, states: CableStates) -> np.ndarray:
    """(..., m, 3, 3) stiffness of each cable at its platform end, pulley and what is in line included, world [N/m]."""
    return cable_response(arrays, states).stiffness if arrays.has_yielding_frame_ends else cable_stiffness(states)


def let_out(arrays: RobotArrays, tension: np.ndarray, axial_stiffness: np.ndarray) -> np.ndarray:
    """(..., m) unstrained length that elements in line let pass the frame end under `tension` (..., m) there [m].

    They stretch by c T; what passes is strained like the cable.
    """
    return arrays.series_compliance * tension / (1.0 + tension / axial_stiffness)


def cable_response(arrays: RobotArrays, states: CableStates) -> CableResponse:
    """Exact derivatives of the static cable forces.

    Adding cable at the frame end adds it along the tension t there, so the free cable's length rate is
    -K t (1 + T/EA). On a pulley, moving the platform end also turns t, which moves the exit point E and takes cable
    on or off the wheel: the tension vector at E then solves a 3 x 3 linear system a cable. An element in line lets out
    cable as the tension grows, which enters that system alike. A winch that holds the tension lets out what keeps it.
    """
    free = cable_stiffness(states)
    free_rate = _free_rate(states, free)
    top_rate = free_rate - states.weight[..., None] * states.up
    if not arrays.has_yielding_frame_ends:
        return CableResponse(free, free_rate, top_rate)
    from_tension, matrix = _exit_equation(arrays, states, free, top_rate)
    inverse = np.linalg.inv(matrix)
    lets_out = np.einsum("...i,...ij->...j", from_tension, inverse)
    if arrays.has_tension_winches:
        lets_out, inverse = _at_held_tension(arrays, states, top_rate, lets_out, inverse)
    weight = states.weight[..., None] * states.up
    back = inverse + weight[..., :, None] * lets_out[..., None, :]
    length_rate = np.einsum("...ij,...j->...i", back, top_rate) + weight
    return CableResponse(back @ free, length_rate, np.einsum("...ij,...j->...i", inverse, top_rate))


def chord_tension_rate(arrays: RobotArrays, states: CableStates, response: CableResponse) -> np.ndarray:
    """(..., m) derivative of the chord tension fx c / s (2.17) by the length paid out [N/m]; nan at steep cables.

    The exit from the pulley moves with the direction of the tension there, and with it chord c and span s.
    """
    tension, direction = _pull_at_frame(states)
    turned = response.frame_rate - (response.frame_rate * direction).sum(axis=-1, keepdims=True) * direction
    moves = exit_rates(direction, arrays.pulley_axis, arrays.pulley_radius)[0]
    shift = -np.einsum("...ij,...j->...i", moves, turned / tension[..., None])
    span, chord = states.span, states.chord
    regular = span > _STEEP * chord
    across = np.where(regular, span, 1.0)
    growing = (response.length_rate * states.heading).sum(axis=-1) * chord
    lengthening = (shift * states.offset).sum(axis=-1) / chord - (shift * states.heading).sum(axis=-1) * chord / across
    return np.where(regular, (growing + states.force_x * lengthening) / across, np.nan)


def exit_jacobian(arrays: RobotArrays, states: CableStates) -> np.ndarray:
    """(..., m, 3, 3) Jacobian of the exit equation: the tension vector at E less the pull that follows from it."""
    free = cable_stiffness(states)
    return _exit_equation(arrays, states, free, _free_rate(states, free) - states.weight[..., None] * states.up)[1]


def _pull_at_frame(states: CableStates) -> tuple[np.ndarray, np.ndarray]:
    """Tension (..., m) [N], of one newton where the cable is slack, and unit direction (..., m, 3) at the frame end."""
    tension = np.where(states.slack, 1.0, states.tension_at_frame)
    return tension, states.force_at_frame / tension[..., None]


def _free_rate(states: CableStates, free: np.ndarray) -> np.ndarray:
    """(..., m, 3) derivative of the pull of the free cable by its unstrained length [N/m]."""
    stretch = 1.0 + states.tension_at_frame / states.axial_stiffness
    rate: np.ndarray = -stretch[..., None] * np.einsum("...ij,...j->...i", free, _pull_at_frame(states)[1])
    return rate


def _exit_equation(
    arrays: RobotArrays, states: CableStates, free: np.ndarray, top_rate: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """d(free length)/d(tension vector at E) (..., m, 3) and the Jacobian of the exit equation (..., m, 3, 3)."""
    tension, direction = _pull_at_frame(states)
    turn = (np.eye(3) - direction[..., :, None] * direction[..., None, :]) / tension[..., None, None]
    moves, winds = exit_rates(direction, arrays.pulley_axis, arrays.pulley_radius)
    stretch = (1.0 + states.tension_at_frame / states.axial_stiffness)[..., None]
    winding = -np.einsum("...j,...jk->...k", winds, turn) / stretch
    relaxing = direction * (states.wrapped_length / states.axial_stiffness)[..., None] / stretch
    relaxing = relaxing + direction * arrays.series_compliance[..., None] / stretch**2
    from_tension = winding + np.where(states.slack[..., None], 0.0, relaxing)
    matrix = np.eye(3) + free @ moves @ turn - top_rate[..., :, None] * from_tension[..., None, :]
    return from_tension, matrix


def _at_held_tension(
    arrays: RobotArrays, states: CableStates, top_rate: np.ndarray, lets_out: np.ndarray, inverse: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """d(free length)/d(pull of the free cable) and the inverse of the exit equation where winches hold the tension,
    else as they are.

    The limit of an element in line that grows ever softer: what is let out keeps the tension, t . dF = 0.
    """
    held = np.broadcast_to(arrays.winch_tension > 0.0, states.length.shape)[..., None]
    along = np.einsum("...i,...ij->...j", _pull_at_frame(states)[1], inverse)
    rate = np.einsum("...i,...i->...", along, top_rate)[..., None]
    kept = -along / np.where(held, rate, 1.0)
    pulled = np.einsum("...ij,...j->...i", inverse, top_rate)
    relaxed = inverse + pulled[..., :, None] * kept[..., None, :]
    passed = lets_out + (1.0 + np.einsum("...i,...i->...", lets_out, top_rate)[..., None]) * kept
    return np.where(held, passed, lets_out), np.where(held[..., None], relaxed, inverse)

"""The three cable models behind one interface: `sagging`, `spring`, `ideal`.

`states` answers which force a cable of given length has between given points (forward), `hold` which length it has at
given tension (inverse).
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from cdpr_struct.statics.cable_response import cable_response, exit_jacobian, let_out
from cdpr_struct.statics.cable_state import CableStates, heading_and_span
from cdpr_struct.statics.catenary import CableStatus, CatenaryForces, solve_end_forces
from cdpr_struct.statics.catenary_length import force_z_curvature, length_at_chord_tension
from cdpr_struct.statics.masts import with_settled_masts
from cdpr_struct.statics.pulley import pulley_exit, straight_exit
from cdpr_struct.statics.robot_arrays import RobotArrays

IDEAL_STIFFENING = 1e6  # an ideal cable at given length: spring with EA this many times larger
SLACKEST_HELD = (
    3.0  # largest w chord / (2 tau) of a cable chosen by `inverse`: sag over span 1.5, far past the least tension
)
_EXIT_ITERATIONS = 30
_EXIT_TOLERANCE = 1e-14  # of the tension, or of the unit direction


@dataclass(frozen=True, slots=True, eq=False)
class HeldCables:
    """Cables chosen by their tension.

    states      : CableStates (..., m)
    force_rate  : (..., m, 3) derivative of the force on the platform with respect to the chord tension [-]
    bend        : (..., m) second derivative of its z component, approximate, for optimisers only [1/N]
    """

    states: CableStates
    force_rate: np.ndarray
    bend: np.ndarray


class CableModel(Protocol):
    """What a cable does between its frame anchor and a point on the platform."""

    name: str

    def approach(self) -> "tuple[CableModel, ...]":
        """Models to go through, the last is this one: forward kinematics takes each solution as the next start."""

    def seen(self, arrays: RobotArrays) -> RobotArrays:
        """The robot as far as this model knows it."""

    def states(self, arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
        """State of cables of unstrained `length` (..., m) [m] that end at `points` (..., m, 3), world [m]."""

    def hold(self, arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> HeldCables:
        """Cables with chord tension (..., m) >= 0 [N] that end at `points`."""

    def least_chord_tension(self, arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
        """(..., m) smallest chord tension that `hold` accepts [N]."""


class SpringModel:
    """Straight weightless spring that cannot push."""

    name = "spring"

    def approach(self) -> "tuple[CableModel, ...]":
        return (self,)

    def seen(self, arrays: RobotArrays) -> RobotArrays:
        return arrays

    def states(self, arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
        return with_settled_masts(arrays, lambda moved: _spring(moved, points, length))[0]

    def hold(self, arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> HeldCables:
        states, _ = with_settled_masts(arrays, lambda moved: _held_spring(moved, points, chord_tension), locked=False)
        return HeldCables(states, -states.offset / states.chord[..., None], np.zeros_like(states.chord))

    def least_chord_tension(self, arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
        return np.zeros(points.shape[:-1])


class IdealModel(SpringModel):
    """Straight, weightless, inextensible, on rigid masts with nothing elastic in line. At given lengths the forces
    are those of a spring `IDEAL_STIFFENING` times stiffer: its stretch is below a micrometre for such cables."""

    name = "ideal"

    def __init__(self, stiffening: float = IDEAL_STIFFENING) -> None:
        self.stiffening = stiffening

    def approach(self) -> "tuple[CableModel, ...]":
        """Models of growing stiffness that lead here, each the next one's start."""
        return (SpringModel(), *(IdealModel(factor) for factor in (1e1, 1e2, 1e3, 1e4, 1e5)), self)

    def seen(self, arrays: RobotArrays) -> RobotArrays:
        return arrays.with_rigid_ends()

    def states(self, arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
        rigid = arrays.with_rigid_ends()
        return super().states(rigid.stiffened(self.stiffening), points, length)

    def hold(self, arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> HeldCables:
        held = super().hold(arrays.with_rigid_ends(), points, chord_tension)
        exit_ = _straight(arrays, points)
        states = replace(held.states, length=exit_.chord, wrapped_length=exit_.wrapped)
        stiff = states.axial_stiffness * self.stiffening
        return replace(held, states=replace(states, axial_stiffness=stiff))


class SaggingModel:
    """Elastic catenary, eqs. (2.11)-(2.12)."""

    name = "sagging"

    def approach(self) -> "tuple[CableModel, ...]":
        return (self,)

    def seen(self, arrays: RobotArrays) -> RobotArrays:
        return arrays

    def states(self, arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
        return with_settled_masts(arrays, lambda moved: _hanging(moved, points, length))[0]

    def hold(self, arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> HeldCables:
        def states_of(moved: RobotArrays) -> CableStates:
            return _held_hanging(moved, points, chord_tension)[0]

        _, arrays = with_settled_masts(arrays, states_of, locked=False)
        states, length_rate = _held_hanging(arrays, points, chord_tension)
        response = cable_response(replace(arrays, series_compliance=np.zeros(1)), states)
        bend = -force_z_curvature(states.span, states.offset[..., 2], chord_tension, states.weight)
        return HeldCables(states, -response.length_rate * length_rate[..., None], bend)

    def least_chord_tension(self, arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
        chord = np.linalg.norm(points - arrays.frame_anchors, axis=-1)
        return 0.5 * arrays.weight * chord / SLACKEST_HELD


def _spring(arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
    exit_ = _straight(arrays, points)
    excess = exit_.chord + exit_.wrapped - length
    give = length / arrays.axial_stiffness + arrays.series_compliance
    tension = np.where(excess <= 0.0, 0.0, excess / give)
    wrapped = exit_.wrapped / (1.0 + tension / arrays.axial_stiffness)
    passed = let_out(arrays, tension, arrays.axial_stiffness)
    return _straight_states(arrays, exit_, tension, length - wrapped + passed, wrapped)


def _held_spring(arrays: RobotArrays, points: np.ndarray, tension: np.ndarray) -> CableStates:
    exit_ = _straight(arrays, points)
    stretch = 1.0 + tension / arrays.axial_stiffness
    return _straight_states(arrays, exit_, tension, exit_.chord / stretch, exit_.wrapped / stretch)


def _hanging(arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
    offset = points - arrays.frame_anchors
    if not arrays.has_yielding_frame_ends:
        zero = np.zeros_like(length)
        return _catenary(arrays, offset, length, zero, zero)[0]
    return _catenary_over_pulley(arrays, offset, length)


def _held_hanging(arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> tuple[CableStates, np.ndarray]:
    """State, and rate of the length with the chord tension."""
    offset = points - arrays.frame_anchors
    if not arrays.has_pulleys:
        return _catenary_at_tension(arrays, offset, chord_tension, np.zeros(offset.shape[:-1]))
    return _held_over_pulley(arrays, offset, chord_tension)


MODELS: dict[str, CableModel] = {m.name: m for m in (SaggingModel(), SpringModel(), IdealModel())}


def cable_model(model: "str | CableModel") -> CableModel:
    """Model by name.

    Raises
    ------
    ValueError : no such model.
    """
    if not isinstance(model, str):
        return model
    if model not in MODELS:
        raise ValueError(f"model must be one of {', '.join(MODELS)}, got {model!r}")
    return MODELS[model]


@dataclass(frozen=True, slots=True, eq=False)
class _StraightCables:
    offset: np.ndarray
    chord: np.ndarray
    wrapped: np.ndarray  # strained


def _straight(arrays: RobotArrays, points: np.ndarray) -> _StraightCables:
    offset = points - arrays.frame_anchors
    if arrays.has_pulleys:
        direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
        exit_ = pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius)
        offset = offset - exit_.point
        wrapped = arrays.pulley_radius * exit_.wrap_angle
    else:
        wrapped = np.zeros(offset.shape[:-1])
    return _StraightCables(offset, np.linalg.norm(offset, axis=-1), wrapped)


def _straight_states(
    arrays: RobotArrays, exit_: _StraightCables, tension: np.ndarray, length: np.ndarray, wrapped: np.ndarray
) -> CableStates:
    heading, span = heading_and_span(exit_.offset)
    status = np.where(tension > 0.0, CableStatus.CONVERGED, CableStatus.WEIGHTLESS_SLACK)
    share = tension / exit_.chord
    stiff = np.broadcast_to(arrays.axial_stiffness, length.shape)
    passed = np.broadcast_to(let_out(arrays, tension, stiff), length.shape)
    return CableStates(
        exit_.offset, heading, length, wrapped, share * span, share * exit_.offset[..., 2], stiff,
        np.zeros_like(length), status, passed,
    )  # fmt: skip


def _catenary(
    arrays: RobotArrays,
    offset: np.ndarray,
    length: np.ndarray,
    wrapped: np.ndarray,
    passed: np.ndarray,
    near: CatenaryForces | None = None,
) -> tuple[CableStates, CatenaryForces]:
    heading, span = heading_and_span(offset)
    stiff = np.broadcast_to(arrays.axial_stiffness, length.shape)
    weight = np.broadcast_to(arrays.weight, length.shape)
    forces = solve_end_forces(span, offset[..., 2], length, stiff, weight, near)
    pull = forces.force_x, forces.force_z
    return CableStates(offset, heading, length, wrapped, *pull, stiff, weight, forces.status, passed), forces


def _catenary_over_pulley(arrays: RobotArrays, offset: np.ndarray, length: np.ndarray) -> CableStates:
    """Newton on the tension vector at the frame end: its direction places the exit from the pulley, its size strains
    the wrapped piece and what is in line behind it."""
    direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
    states, near = _leaving(arrays, offset, length, direction, np.zeros(length.shape))
    vector = states.force_at_frame
    for _ in range(_EXIT_ITERATIONS):
        tension = np.linalg.norm(vector, axis=-1)
        states, near = _leaving(arrays, offset, length, vector / tension[..., None], tension, near)
        error = states.force_at_frame - vector
        if (np.abs(error).max(axis=-1) <= _EXIT_TOLERANCE * (tension + arrays.axial_stiffness)).all():
            break
        vector = vector + np.linalg.solve(exit_jacobian(arrays, states), error[..., None])[..., 0]
    return states


def _leaving(
    arrays: RobotArrays,
    offset: np.ndarray,
    length: np.ndarray,
    direction: np.ndarray,
    tension: np.ndarray,
    near: CatenaryForces | None = None,
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
    heading, span = heading_and_span(offset)
    cable = length_at_chord_tension(span, offset[..., 2], chord_tension, arrays.axial_stiffness, arrays.weight)
    bottom = np.hypot(cable.force_x, cable.force_z - arrays.weight * cable.length)
    wrapped = wrap / (1.0 + bottom / arrays.axial_stiffness)
    stiff = np.broadcast_to(arrays.axial_stiffness, wrapped.shape)
    weight = np.broadcast_to(arrays.weight, wrapped.shape)
    states = CableStates(
        offset, heading, cable.length, wrapped, np.where(span > 0.0, cable.force_x, 0.0), cable.force_z, stiff,
        weight, cable.status, np.broadcast_to(let_out(arrays, bottom, stiff), wrapped.shape),
    )  # fmt: skip
    return states, cable.length_rate


def _held_over_pulley(
    arrays: RobotArrays, offset: np.ndarray, chord_tension: np.ndarray
) -> tuple[CableStates, np.ndarray]:
    """Fixed point of the exit direction; contracts by about radius over chord."""
    direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
    for _ in range(_EXIT_ITERATIONS):
        exit_ = pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius)
        wrap = arrays.pulley_radius * exit_.wrap_angle
        states, length_rate = _catenary_at_tension(arrays, offset - exit_.point, chord_tension, wrap)
        before = direction
        direction = states.force_at_frame / states.tension_at_frame[..., None]
        if np.abs(direction - before).max(initial=0.0) <= _EXIT_TOLERANCE:
            break
    return states, length_rate * (1.0 + states.wrapped_length / states.length)  # the wrapped piece stretches alike

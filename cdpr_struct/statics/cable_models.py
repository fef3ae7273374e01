"""The three cable models behind one interface: `sagging`, `spring`, `ideal`.

`states` answers which force a cable of given length has between given points (forward), `hold` which length it has at
given tension (inverse).
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import cable_response, chord_tension_rate, let_out
from cdpr_struct.statics.cable_state import CableStates, heading_and_span, span_and_rise
from cdpr_struct.statics.catenary import CableStatus
from cdpr_struct.statics.catenary_length import SLACKEST, force_z_curvature
from cdpr_struct.statics.hanging_cables import hanging, held_hanging
from cdpr_struct.statics.lost_cables import counted_lost
from cdpr_struct.statics.masts import with_settled_masts
from cdpr_struct.statics.pulley import behind_wheel, pulley_exit, straight_exit
from cdpr_struct.statics.tension_winches import with_winches

IDEAL_STIFFENING = 1e6  # an ideal cable at given length: spring with EA this many times larger
SLACKEST_HELD = 3.0  # largest w chord / (2 tau) of a level cable chosen by `inverse`: sag over span 1.5, far past the
# least tension. A steep cable may have more, up to the same ratio of length and chord: a vertical one, with whatever it
# weighs, may pull with next to nothing
_LARGEST = np.linspace(SLACKEST_HELD, SLACKEST, 61)
_LEVEL_LOGARITHM = np.log(np.sinh(_LARGEST) / _LARGEST) - np.log(np.sinh(SLACKEST_HELD) / SLACKEST_HELD)


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
        return with_settled_masts(arrays, lambda moved: _spring_on_winches(moved, points, length))[0]

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
    """Elastic catenary, eqs. (2.11)-(2.12); without gravity the straight spring."""

    name = "sagging"

    def approach(self) -> "tuple[CableModel, ...]":
        return (self,)

    def seen(self, arrays: RobotArrays) -> RobotArrays:
        return arrays

    def states(self, arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
        if arrays.is_weightless:
            return SpringModel().states(arrays, points, length)
        near = None

        def on_masts(moved: RobotArrays) -> CableStates:
            nonlocal near
            states, near = hanging(moved, points, length, near)
            return states

        return with_settled_masts(arrays, on_masts)[0]

    def hold(self, arrays: RobotArrays, points: np.ndarray, chord_tension: np.ndarray) -> HeldCables:
        if arrays.is_weightless:
            return SpringModel().hold(arrays, points, chord_tension)

        def states_of(moved: RobotArrays) -> CableStates:
            return held_hanging(moved, points, chord_tension)[0]

        _, arrays = with_settled_masts(arrays, states_of, locked=False)
        states, length_rate = held_hanging(arrays, points, chord_tension)
        locked = replace(arrays, series_compliance=np.zeros(1), winch_tension=np.zeros(1))
        response = cable_response(locked, states)
        if arrays.has_pulleys:
            tension_rate = chord_tension_rate(locked, states, response)
            length_rate = np.where(tension_rate < 0.0, 1.0 / tension_rate, length_rate)
        bend = -force_z_curvature(states.span, states.rise, chord_tension, states.weight)
        return HeldCables(states, -response.length_rate * length_rate[..., None], bend)

    def least_chord_tension(self, arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
        offset = points - arrays.frame_anchors
        chord = np.linalg.norm(offset, axis=-1)
        load, up = arrays.cable_load(offset)
        level = span_and_rise(offset, up)[0] / np.maximum(chord, 1e-300)
        most = np.interp(-np.log(np.maximum(level, 1e-9)), _LEVEL_LOGARITHM, _LARGEST)
        return np.asarray(0.5 * (load * chord + arrays.lump_weight.sum(axis=-1)) / most)


def _spring_on_winches(arrays: RobotArrays, points: np.ndarray, length: np.ndarray) -> CableStates:
    states = _spring(arrays, points, length)
    if not arrays.has_tension_winches:
        return states
    return with_winches(arrays, states, _held_spring(arrays, points, arrays.winch_tension))


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
    lost: np.ndarray  # bool: a cable behind its wheel


def _straight(arrays: RobotArrays, points: np.ndarray) -> _StraightCables:
    offset = points - arrays.frame_anchors
    wrapped, lost = np.zeros(offset.shape[:-1]), np.zeros(offset.shape[:-1], dtype=bool)
    if arrays.has_pulleys:
        wheel = arrays.pulley_axis, arrays.pulley_radius
        lost = behind_wheel(offset, *wheel)
        exit_ = pulley_exit(straight_exit(offset, *wheel), *wheel)
        offset = offset - exit_.point
        wrapped = arrays.pulley_radius * exit_.wrap_angle
    return _StraightCables(offset, np.linalg.norm(offset, axis=-1), wrapped, lost)


def _straight_states(
    arrays: RobotArrays, exit_: _StraightCables, tension: np.ndarray, length: np.ndarray, wrapped: np.ndarray
) -> CableStates:
    up = np.broadcast_to(arrays.up, exit_.offset.shape)
    (heading, span), rise = heading_and_span(exit_.offset, up), span_and_rise(exit_.offset, up)[1]
    status = np.where(tension > 0.0, CableStatus.CONVERGED, CableStatus.WEIGHTLESS_SLACK)
    share = tension / exit_.chord
    stiff = np.broadcast_to(arrays.axial_stiffness, length.shape)
    passed = np.broadcast_to(let_out(arrays, tension, stiff), length.shape)
    states = CableStates(
        exit_.offset, heading, length, wrapped, share * span, share * rise, stiff,
        np.zeros_like(length), status, passed, up,
    )  # fmt: skip
    return counted_lost(states, exit_.lost & (tension > 0.0))

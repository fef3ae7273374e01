"""Vibration in time with dry friction at the ends of the cables: modal superposition with a force that remembers.

Between two instants the modes move exactly under a modal force that is linear in time; the friction at the later
instant depends on where the ends have turned by then, and is found by repeated substitution. Tensions, and with them
the moments at which ends slide, are those at rest.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.modal_basis import ModalBasis
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import Port
from cdpr_struct.dynamics.presliding_friction import built_up, end_tensions, end_turns
from cdpr_struct.dynamics.transient import ComplexModes, Vibration, complex_modes, held_step, vibration
from cdpr_struct.errors import CdprError, ConvergenceError

_SUBSTEPS = 4  # of an instant of the record, each a thirty-second of the fastest period
_ROUNDS, _SAME = 60, 1e-10  # of the substitution; change of z at which it ends


@dataclass(frozen=True, slots=True)
class EndFriction:
    """Moment over tension at which the cables' ends slide, and the angle over which it builds up: frame, platform.

    frame, platform : (radius [m], presliding angle [rad]) each; a radius of zero for none
    """

    frame: tuple[float, float]
    platform: tuple[float, float]

    def __post_init__(self) -> None:
        for name in ("frame", "platform"):
            radius, angle = getattr(self, name)
            if not (0.0 <= radius < np.inf and 0.0 < angle < np.inf):
                raise ValueError(f"EndFriction.{name} must be a radius >= 0 and an angle > 0, got {(radius, angle)}")


@dataclass(frozen=True, slots=True, eq=False)
class RubbingEnds:
    """e ends as k modes turn them.

    turns : (k, e, 3) per modal amplitude [rad];  moment : (e,) [N m];  presliding : (e, 1) [rad]
    """

    turns: np.ndarray
    moment: np.ndarray
    presliding: np.ndarray

    @classmethod
    def of(cls, point: OperatingPoint, basis: ModalBasis, friction: EndFriction) -> "RubbingEnds":
        """Of a robot at rest. A cable counts as straight: its own vibration does not turn its ends.

        Raises
        ------
        CdprError : nothing holds the platform in some direction.
        """
        if not basis.omega.min() > 0.0:
            raise CdprError("friction at cable ends needs a platform that is held in every direction; this one is not")
        tension = end_tensions(point)
        each = np.repeat([friction.frame, friction.platform], len(tension) // 2, axis=0)
        return cls(end_turns(point, basis.modes.platform), each[:, 0] * tension, each[:, 1:])

    def force(self, state: np.ndarray) -> np.ndarray:
        """(k,) modal force of ends in the state z (e, 3)."""
        return -np.asarray(np.einsum("e,eb,keb->k", self.moment, state, self.turns))

    def lost(self, state: np.ndarray, turned: np.ndarray) -> float:
        """Work [J] done on ends in the mean state (e, 3) by a turn (e, 3)."""
        return float(np.einsum("e,eb,eb->", self.moment, state, turned))


@dataclass(frozen=True, slots=True, eq=False)
class RubbedMotion:
    """At n instants: states (n, 2 k) as in `transient`, modal force (n, k) of the friction, and its work (n,) [J]."""

    state: np.ndarray
    push: np.ndarray
    lost: np.ndarray


def rubbed_motion(
    modes: ComplexModes,
    omega: np.ndarray,
    ends: RubbingEnds,
    time: np.ndarray,
    drive: np.ndarray,
    jumps: Mapping[int, np.ndarray],
) -> RubbedMotion:
    """Motion from rest, friction relaxed.

    Parameters
    ----------
    time : (n,) evenly spaced [s];  drive : (n, k) modal force, linear between the instants
    jumps : by number of the instant, states (2 k,) that an impulse adds there

    Raises
    ------
    ConvergenceError : the friction is too stiff for the step.
    """
    k, n = len(omega), len(time)
    stepper = _Stepper.of(modes, omega, ends, float(time[1] - time[0]) / _SUBSTEPS)
    motion, state, lost = np.zeros(2 * k, dtype=complex), np.zeros(ends.turns.shape[1:]), 0.0
    found = RubbedMotion(np.zeros((n, 2 * k)), np.zeros((n, k)), np.zeros(n))
    shares = np.arange(_SUBSTEPS + 1)[:, None] / _SUBSTEPS
    for index in range(n):
        given = drive[index - 1] + shares * (drive[index] - drive[index - 1])
        for part in range(_SUBSTEPS if index else 0):
            motion, state, work = stepper.advance(motion, state, given[part], given[part + 1])
            lost += work
        if index in jumps:
            motion = motion + modes.inverse @ jumps[index]
        found.state[index], found.push[index] = (modes.vectors @ motion).real, ends.force(state)
        found.lost[index] = lost
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Stepper:
    """What a step does to complex modes: `growth`, and to a modal force `own` before and after it; `place` (k, 2 k)."""

    ends: RubbingEnds
    growth: np.ndarray
    before: np.ndarray
    after: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, modes: ComplexModes, omega: np.ndarray, ends: RubbingEnds, step: float) -> "_Stepper":
        growth, before, after = held_step(modes, step)
        own = modes.inverse[:, len(omega) :]
        return cls(
            ends, growth, before[:, None] * own, after[:, None] * own, modes.vectors[: len(omega)] / omega[:, None]
        )

    def advance(
        self, motion: np.ndarray, state: np.ndarray, earlier: np.ndarray, later: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """Complex modes (2 k,) and z (e, 3) a step later, under a drive (k,) earlier and later, and the work [J]."""
        ends, there = self.ends, (self.place @ motion).real
        held = self.growth * motion + self.before @ (earlier + ends.force(state)) + self.after @ later
        new = self._substituted(state, there, held)
        moved = held + self.after @ ends.force(new)
        turned = np.einsum("k,keb->eb", (self.place @ moved).real - there, ends.turns)
        return moved, new, ends.lost(0.5 * (state + new), turned)

    def _substituted(self, state: np.ndarray, there: np.ndarray, held: np.ndarray) -> np.ndarray:
        """z (e, 3) at the end of a step in which the motion without its force is `held` (2 k,)."""
        ends, later, change = self.ends, state, np.inf
        for _ in range(_ROUNDS):
            moved = (self.place @ (held + self.after @ ends.force(later))).real
            new = built_up(state, np.einsum("k,keb->eb", moved - there, ends.turns), ends.presliding)
            change = float(np.abs(new - later).max())
            later = new
            if change < _SAME:
                return later
        hint = (
            "The moment over the presliding angle is too stiff for this step: raise the highest frequency or the angle."
        )
        raise ConvergenceError("friction at cable ends", change, _ROUNDS, hint)


def rubbing_vibration(
    basis: ModalBasis,
    ends: RubbingEnds,
    acceleration: np.ndarray,
    stopped: tuple[int, np.ndarray],
    ports: tuple[Port, ...],
    time: np.ndarray,
) -> Vibration:
    """Vibration about a nominal motion and after its stop, as `transient.along_path` has it, with friction.

    Parameters
    ----------
    acceleration : (n, 6) of the nominal motion [m/s^2, rad/s^2], zero after the stop
    stopped : number of the instant at which a velocity (6,) is taken away, and that velocity; 0 for a stop alone
    time : (n,) evenly spaced [s]

    Its energy is that of the modes, without what the friction holds before it slides.
    """
    participation, mass = basis.rigid_motion()
    modes, (stop, velocity) = complex_modes(basis), stopped
    jump = np.concatenate([np.zeros(len(basis.omega)), participation @ velocity])
    jumps = {stop: jump} if velocity.any() else {}
    motion = rubbed_motion(modes, basis.omega, ends, time, acceleration @ -participation.T, jumps)
    largest = acceleration[np.linalg.norm(acceleration, axis=1).argmax()]
    excitation = (largest if largest.any() else velocity), mass
    return vibration(basis, modes, ports, time, motion.state, acceleration, participation, excitation, motion.push)

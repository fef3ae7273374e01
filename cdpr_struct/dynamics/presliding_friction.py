"""Dry friction at the ends of cables that gives way before it slides.

A cable end that turns by dv meets a moment M z. Its direction z builds up over an angle s (Dahl 1968, for a turn with
several components; Lugre-type models keep the same presliding),

    dz = (dv - z |dv|) / s,

so that a small turn meets the spring M / s and a large one the constant moment M. With one component and a turn of
amplitude A to and fro, the moment in phase with the turn and the loss are those of

    k' = 2 (M / A) I_1(a) / cosh(a),    k'' = 4 (M / s) (a - tanh a) / (pi a^2),    a = A / s,

I_1 the modified Bessel function: equivalent linearisation after Krylov and Bogoliubov. Several modes at once rub
together: their shares are averages over the motion of all.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import i1e

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment

_PERIODS, _STEPS = 24, 60  # of the slowest mode that are averaged; per period of the fastest
_SETTLING = 0.25  # of the record, left out
_GOLDEN = 0.6180339887498949  # phases of the modes are multiples of it, in turns


def in_phase_stiffness(moment: np.ndarray, presliding: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """k' [N m/rad] of a moment [N m] that builds up over an angle [rad], for turns of an amplitude [rad]."""
    a = np.asarray(amplitude) / presliding
    return np.asarray(4.0 * moment / amplitude * i1e(a) / (1.0 + np.exp(-2.0 * a)))


def loss_stiffness(moment: np.ndarray, presliding: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """k'' [N m/rad]: the loss in a period is pi k'' amplitude^2."""
    a = np.asarray(amplitude) / presliding
    lost = np.where(a < 0.02, a**3 / 3.0 * (1.0 - 0.4 * a**2), a - np.tanh(a))
    return np.asarray(4.0 * moment / presliding * lost / (np.pi * a**2))


def built_up(state: np.ndarray, turn: np.ndarray, presliding: float | np.ndarray) -> np.ndarray:
    """z (..., d) after a further turn (..., d) [rad] in a straight line; exact, so that |z| never exceeds 1."""
    size = np.linalg.norm(turn, axis=-1, keepdims=True)
    left = np.exp(-size / presliding)
    return np.asarray(state * left + (1.0 - left) * turn / np.maximum(size, 1e-300))


def end_turns(point: OperatingPoint, twists: np.ndarray) -> np.ndarray:
    """How far cable ends turn for motions (k, 6) of the platform origin: (k, 2 m, 3) [rad], world axes.

    First the m frame ends, by the change of the cable's direction, then the platform ends, by that change against the
    platform; neither counts a turn about the cable itself. The cable is straight from its exit on.
    """
    chord = np.linalg.norm(point.cables.offset, axis=-1)
    along = point.cables.offset / chord[:, None]
    moved = np.einsum("mij,kj->kmi", attachment(point), twists)
    swing = np.cross(along[None], moved) / chord[None, :, None]
    spin = twists[:, None, 3:]
    across = spin - (spin * along).sum(axis=-1, keepdims=True) * along
    return np.concatenate([swing, across - swing], axis=1)


def end_tensions(point: OperatingPoint) -> np.ndarray:
    """(2 m,) tensions of the cables at their ends, in the order of `end_turns` [N]."""
    return np.concatenate([point.cables.tension_at_frame, point.cables.tension_at_platform])


@dataclass(frozen=True, slots=True, eq=False)
class RubbingModes:
    """What friction does to b motions of k modes, per N m at which each of e cable ends slides.

    shift : (b, k, e) share by which the frequency shifts;  damping : (b, k, e) damping ratio; nan for modes at rest
    """

    shift: np.ndarray
    damping: np.ndarray


def rubbing_modes(
    turns: np.ndarray, presliding: float | np.ndarray, omega: np.ndarray, amplitudes: np.ndarray
) -> RubbingModes:
    """Equivalent linearisation of friction at cable ends for motions in which k modes swing together.

    Parameters
    ----------
    turns : (b, k, e, d) of the ends per modal amplitude, for unit modal mass [rad]
    presliding : angle over which the moment builds up, one or (b,) [rad]
    omega : (b, k) [rad/s];  amplitudes : (b, k) modal, zero for a mode at rest
    """
    time, weight = _averaging(omega)
    begin = 2.0 * np.pi * _GOLDEN * np.arange(omega.shape[1])
    state, angle = np.zeros((len(omega), *turns.shape[2:])), np.reshape(presliding, (-1, 1, 1))
    before = np.einsum("bk,bked->bed", amplitudes * np.cos(begin), turns)
    cosine, sine = np.zeros((2, *turns.shape[:3]))
    for instant, share in zip(time, weight, strict=True):
        phase = omega * instant + begin
        there = np.einsum("bk,bked->bed", amplitudes * np.cos(phase), turns)
        state, before = built_up(state, there - before, angle), there
        if share > 0.0:
            force = -share * np.einsum("bed,bked->bke", state, turns)
            cosine += force * np.cos(phase)[..., None]
            sine += force * np.sin(phase)[..., None]
    size = (np.where(amplitudes > 0.0, amplitudes, np.nan) * omega**2)[..., None]
    return RubbingModes(-cosine / size, sine / size)


def _averaging(omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Instants (n,) [s] and their weights (n,), which sum up to 1: none while the friction forgets its start."""
    duration = _PERIODS * 2.0 * np.pi / omega.min()
    steps = int(np.ceil(duration * omega.max() / (2.0 * np.pi) * _STEPS))
    time = duration / steps * np.arange(steps)
    late = (time / duration - _SETTLING) / (1.0 - _SETTLING)
    weight = np.where(late < 0.0, 0.0, np.sin(np.pi * late) ** 2)
    return time, weight / weight.sum()

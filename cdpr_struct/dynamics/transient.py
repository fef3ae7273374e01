"""Vibration in time: after an emergency stop, and along a trajectory.

State y = (omega x, x') of the undamped modes x; y' = A y + B a(t) with

    A = [0, omega; -omega, -C],    B = -[0; participation],

the platform driven by the acceleration a(t) of its own nominal motion (d'Alembert). An emergency stop is the impulse
that takes the nominal velocity away. A is solved by its complex modes, so the time step does not enter the accuracy.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from cdpr_struct.dynamics.modal_basis import ModalBasis
from cdpr_struct.dynamics.ports import Port
from cdpr_struct.errors import CdprError

_WORST_CONDITION = 1e9
_BLOCK = 4096


@dataclass(frozen=True, slots=True, eq=False)
class ComplexModes:
    """Damped modes: y = vectors exp(values t) inverse y(0).

    values  : (2 k,) [rad/s], in conjugate pairs; minus the real part is the decay rate
    """

    values: np.ndarray
    vectors: np.ndarray
    inverse: np.ndarray

    @property
    def damped_hertz(self) -> np.ndarray:
        """Frequencies of the oscillating modes, ascending [Hz]."""
        return np.sort(self.values.imag[self.values.imag > 0.0]) / (2.0 * np.pi)

    @property
    def damping_ratio(self) -> np.ndarray:
        """Decay rate over size, in the order of `damped_hertz` [-]."""
        swinging = self.values[self.values.imag > 0.0]
        order = np.argsort(swinging.imag)
        return (-swinging.real / np.abs(swinging))[order]


@dataclass(frozen=True, slots=True, eq=False)
class Vibration:
    """Motion about the nominal pose or path at n instants.

    time         : (n,) [s]
    displacement, velocity, acceleration : (n, r) of the r watched ports [m or rad, per s, per s^2]
    energy       : (n,) kinetic and potential energy of the vibration [J]
    energy_share : of the excitation's kinetic energy, what the modes that were kept can hold [-]
    modes        : the damped modes
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    energy: np.ndarray
    energy_share: float
    modes: ComplexModes


def complex_modes(basis: ModalBasis) -> ComplexModes:
    """Damped modes of the robot.

    Raises
    ------
    CdprError : two modes coalesce (critical damping), so that complex modes do not span the motion.
    """
    k = len(basis.omega)
    matrix = np.zeros((2 * k, 2 * k))
    matrix[:k, k:] = np.diag(basis.omega)
    matrix[k:, :k] = -matrix[:k, k:]
    matrix[k:, k:] = -basis.damping
    values, vectors = np.linalg.eig(matrix)
    condition = float(np.linalg.cond(vectors))
    if not condition < _WORST_CONDITION:
        raise CdprError(f"two damped modes coalesce (condition {condition:.1e}): change the damping slightly")
    return ComplexModes(values, vectors, np.linalg.inv(vectors))


def after_stop(basis: ModalBasis, twist: np.ndarray, ports: tuple[Port, ...], time: np.ndarray) -> Vibration:
    """Free vibration after an emergency stop at time zero.

    Parameters
    ----------
    twist : (6,) velocity of the platform origin and angular velocity just before, world axes [m/s, rad/s]
    time : (n,) [s]

    The lengths are locked from time zero on; each piece of cable starts with the share of its end's velocity that is
    linear in its place, zero at the frame.
    """
    participation, mass = basis.rigid_motion()
    modes = complex_modes(basis)
    start = np.concatenate([np.zeros(len(basis.omega)), participation @ twist])
    state = _free(modes, start, time)
    return vibration(basis, modes, ports, time, state, np.zeros((len(time), 6)), participation, (twist, mass))


def along_path(
    basis: ModalBasis,
    acceleration: np.ndarray,
    stop_velocity: np.ndarray,
    stop: int,
    ports: tuple[Port, ...],
    time: np.ndarray,
) -> Vibration:
    """Vibration about a nominal motion that begins steadily and ends with an emergency stop.

    Parameters
    ----------
    acceleration : (n, 6) of the nominal motion [m/s^2, rad/s^2], linear between the instants, zero after the stop
    stop_velocity : (6,) nominal velocity that the stop takes away (zero for a motion that ends at rest)
    stop : number of the instant at which the motion ends, n for one that goes on beyond the record
    time : (n,) evenly spaced [s]

    The robot is linearised at one pose; the nominal motion acts through its inertia,
    M q'' + C q' + K q = -M a(t), with M of the platform and of the cables' linear share.
    """
    participation, mass = basis.rigid_motion()
    modes = complex_modes(basis)
    drive = modes.inverse[:, len(basis.omega) :] @ -participation
    forced = _driven(modes, drive, acceleration, float(time[1] - time[0]))
    state = (forced @ modes.vectors.T).real
    jump = np.concatenate([np.zeros(len(basis.omega)), participation @ stop_velocity])
    if stop < len(time):
        state[stop:] += _free(modes, jump, time[stop:] - time[stop])
    largest = acceleration[np.linalg.norm(acceleration, axis=1).argmax()]
    excitation = stop_velocity if np.abs(largest).max() == 0.0 else largest
    return vibration(basis, modes, ports, time, state, acceleration, participation, (excitation, mass))


def _free(modes: ComplexModes, start: np.ndarray, time: np.ndarray) -> np.ndarray:
    """(n, 2 k) states after y(0) = start."""
    amplitude = modes.inverse @ start
    blocks = [
        ((np.exp(np.outer(part, modes.values)) * amplitude) @ modes.vectors.T).real
        for part in np.array_split(time, 1 + len(time) // _BLOCK)
    ]
    return np.concatenate(blocks)


def _driven(modes: ComplexModes, drive: np.ndarray, acceleration: np.ndarray, step: float) -> np.ndarray:
    """(n, 2 k) complex modal states from rest, exact for an acceleration that is linear between the instants."""
    growth, before, after = held_step(modes, step)
    force = acceleration @ drive.T
    states = np.empty_like(force)
    for i in range(len(growth)):
        states[:, i] = lfilter([after[i], before[i]], [1.0, -growth[i]], force[:, i])
        states[:, i] -= after[i] * force[0, i] * growth[i] ** np.arange(len(force))
    return states


def held_step(modes: ComplexModes, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(2 k,) each: what a step [s] does to a complex modal state, and to a force that changes linearly along it, by
    its value before and after."""
    z = modes.values * step
    growth = np.exp(z)
    small = np.abs(z) < 1e-4
    safe = np.where(small, 1.0, z)
    # integrals of exp(z (1 - s)) over the step, with 1 - s and s as weights
    whole = np.where(small, 1.0 + z / 2.0 + z**2 / 6.0, (growth - 1.0) / safe)
    after = np.where(small, 0.5 + z / 6.0 + z**2 / 24.0, (growth - 1.0 - z) / safe**2)
    return growth, step * (whole - after), step * after


def _displacement(omega: np.ndarray, state: np.ndarray, force: np.ndarray, time: np.ndarray) -> np.ndarray:
    """(n, k) modal coordinates; neutral freedoms (omega zero) drift: their velocity summed up, its rate `force` known.

    The sum is exact for a velocity that is a cubic between two instants.
    """
    k, drifting = len(omega), omega == 0.0
    found = state[:, :k] / np.where(drifting, 1.0, omega)
    if drifting.any():
        velocity, rate, step = state[:, k:][:, drifting], force[:, drifting], np.diff(time)[:, None]
        gained = 0.5 * step * (velocity[1:] + velocity[:-1]) + step**2 / 12.0 * (rate[:-1] - rate[1:])
        found[:, drifting] = np.concatenate([np.zeros((1, gained.shape[1])), np.cumsum(gained, axis=0)])
    return np.asarray(found)


def vibration(
    basis: ModalBasis,
    modes: ComplexModes,
    ports: tuple[Port, ...],
    time: np.ndarray,
    state: np.ndarray,
    acceleration: np.ndarray,
    participation: np.ndarray,
    excitation: tuple[np.ndarray, np.ndarray],
    push: np.ndarray | float = 0.0,
) -> Vibration:
    """States (n, 2 k) as what ports see; acceleration (n, 6) of the nominal motion, participation (k, 6).

    excitation : (twist (6,), mass (6, 6)) of what set the robot in motion;  push : (n, k) further modal force
    """
    k = len(basis.omega)
    stretched, velocity = state[:, :k], state[:, k:]
    force = -stretched * basis.omega - velocity @ basis.damping - acceleration @ participation.T + push
    shapes = np.stack([basis.shape_at(port) for port in ports], axis=1)
    twist, mass = excitation
    whole = float(twist @ mass @ twist)
    held = float(np.sum((participation @ twist) ** 2))
    return Vibration(
        time=time,
        displacement=_displacement(basis.omega, state, force, time) @ shapes,
        velocity=velocity @ shapes,
        acceleration=force @ shapes,
        energy=0.5 * (state**2).sum(axis=1),
        energy_share=held / whole if whole > 0.0 else 1.0,
        modes=modes,
    )

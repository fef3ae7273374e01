"""Frequency response functions of the robot between any two of its points, eqs (3.25)-(3.29)."""

from dataclasses import dataclass
from typing import Literal, Protocol, get_args

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.cable_poles import UPPER
from cdpr_struct.dynamics.damping import DampingLaw
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import Port, ReadyPorts, ready_ports
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.dynamics.swept_stiffness import SweptStiffness, swept_stiffness
from cdpr_struct.statics.small_systems import eliminate, substituted_back

Quantity = Literal["displacement", "velocity", "acceleration"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
_BLOCK = 10_240  # frequencies that go through together: fewer cost more calls, more do not stay near the processor
# C libraries hand freed memory back if it is more than twice the largest piece ever freed; to get it again from the
# system costs as much as the arithmetic in it. One large piece that is freed untouched costs nothing and prevents that.
_KEPT = 2**21
_SMALL = 1e-4  # of its row's largest entry: a pivot below it may cost digits
_EVERY = np.arange(6)


@dataclass(frozen=True, slots=True, eq=False)
class FrequencyResponse:
    """Responses to a unit harmonic force exp(i omega t) at one port.

    hertz    : (f,) ascending
    response : (f, n) complex, one column a responding port; [m/N] for a displacement of a point under a force,
               [rad] for a rotation, [1/(N m)] under a moment, times 1/s for velocity and 1/s^2 for acceleration
    """

    hertz: np.ndarray
    response: np.ndarray
    excite: Port
    respond: tuple[Port, ...]
    quantity: Quantity


class ResponseFunction(Protocol):
    """The responses of n ports as a function of frequency, ready to be evaluated again and again over one band."""

    def at(self, hertz: np.ndarray) -> np.ndarray:
        """(f, n) complex, as `FrequencyResponse.response`; hertz (f,) ascending, inside the band."""


@dataclass(frozen=True, slots=True, eq=False)
class DirectResponse:
    """H(omega) = D(omega)^-1 between ports, D with the damped cables' stiffness; made by `direct_response`."""

    stiffness: SweptStiffness
    ports: ReadyPorts
    quantity: Quantity

    def at(self, hertz: np.ndarray) -> np.ndarray:
        np.empty(_KEPT)
        found = np.empty((len(hertz), len(self.ports.ports) - 1), dtype=complex)
        for start in range(0, len(hertz), _BLOCK):
            part = slice(start, start + _BLOCK)
            found[part] = self._of_block(2.0 * np.pi * hertz[part])
        return found

    def _of_block(self, omega: np.ndarray) -> np.ndarray:
        ports = self.ports.at(omega)
        motion = symmetric_solutions(self.stiffness.upper(omega), ports.twist[:, 0].T)
        displacement = ports.responses(motion) + ports.direct[:, 1:, 0]
        return np.asarray(displacement * derivative_factor(self.quantity, omega))


def direct_response(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    excite: Port,
    respond: tuple[Port, ...],
    band: tuple[float, float],
    quantity: Quantity = "acceleration",
    assembly: Assembly = "consistent",
) -> DirectResponse:
    """The response function over a band (lowest, highest) [Hz]; `cables` made with `highest_omega` at its top."""
    low, high = 2.0 * np.pi * band[0], 2.0 * np.pi * band[1]
    stiffness = swept_stiffness(point, cables, law, (low, high), assembly)
    return DirectResponse(stiffness, ready_ports(point, cables, law, (excite, *respond), high), quantity)


def frequency_response(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    excite: Port,
    respond: tuple[Port, ...],
    hertz: np.ndarray,
    quantity: Quantity = "acceleration",
    assembly: Assembly = "consistent",
) -> FrequencyResponse:
    """H(omega) = (-omega^2 M + K_E(omega))^-1 between ports, and its products with i omega and -omega^2.

    Parameters
    ----------
    cables : made with `highest_omega` at the top of the band
    hertz : (f,) ascending, zero or above

    Eqs (3.25), (3.28), (3.29). Undamped and exactly at a natural frequency the response is infinite.
    """
    band = float(hertz[0]), float(hertz[-1])
    function = direct_response(point, cables, law, excite, respond, band, quantity, assembly)
    return FrequencyResponse(hertz, function.at(hertz), excite, respond, quantity)


def symmetric_solutions(upper: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Motion (6, f) of complex symmetric matrices, given as upper triangles (21, f), under forces (6, f) or (6, 1).

    Eliminated without exchange of rows, all frequencies at once; where a pivot is small, by LAPACK.
    """
    matrix = np.empty((6, 6, upper.shape[1]), dtype=complex)
    matrix[UPPER] = upper
    sizes = np.empty(matrix.shape)
    sizes[UPPER] = sizes[UPPER[::-1]] = _size(upper)
    largest = sizes.max(axis=0)
    with np.errstate(all="ignore"):
        shares = eliminate(matrix, 6)
        motion = np.array(np.broadcast_to(force, (6, upper.shape[1])), dtype=complex)
        for k in range(5):
            motion[k + 1 :] -= shares[k] * motion[k]
        pivots = matrix[_EVERY, _EVERY]
        motion = substituted_back(shares, (motion / pivots)[:, None])[:, 0]
        doubtful = np.flatnonzero(~(_size(pivots) > _SMALL * largest).all(axis=0))
    if doubtful.size:
        full = np.zeros((doubtful.size, 6, 6), dtype=complex)
        full[:, *UPPER] = full[:, *UPPER[::-1]] = upper[:, doubtful].T
        push = np.broadcast_to(force, (6, upper.shape[1]))[:, doubtful].T[..., None]
        motion[:, doubtful] = np.linalg.solve(full, push)[..., 0].T
    return motion


def _size(values: np.ndarray) -> np.ndarray:
    return np.asarray(np.maximum(np.abs(values.real), np.abs(values.imag)))


def derivative_factor(quantity: Quantity, omega: np.ndarray) -> np.ndarray:
    """(f, 1) by which a displacement becomes the quantity at omega (f,) [rad/s]."""
    powers = {"displacement": np.ones_like(omega), "velocity": 1j * omega, "acceleration": -(omega**2)}
    return powers[quantity][:, None]

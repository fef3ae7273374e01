"""Frequency response functions of the robot between any two of its points, eqs (3.25)-(3.29)."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from scipy.signal import find_peaks

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.damping import DampingLaw
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import Port, port_response
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.dynamics.swept_stiffness import swept_dynamic_stiffness

Quantity = Literal["displacement", "velocity", "acceleration"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
_PROMINENCE_DECADES = 0.02


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

    def peaks(self, column: int) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies (k,) [Hz] and magnitudes (k,) of the local maxima of a response.

        A maximum counts if it stands out by 5 % from its surroundings; a parabola through the logarithms of its three
        points places it between the grid points.
        """
        size = np.abs(self.response[:, column])
        log = np.log10(np.maximum(size, np.finfo(float).tiny))
        found, _ = find_peaks(log, prominence=_PROMINENCE_DECADES)
        before, here, after = log[found - 1], log[found], log[found + 1]
        shift = 0.5 * (before - after) / (before - 2.0 * here + after)
        spacing = 0.5 * (self.hertz[found + 1] - self.hertz[found - 1])
        return self.hertz[found] + shift * spacing, 10.0 ** (here - 0.25 * (before - after) * shift)


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
    omega = 2.0 * np.pi * hertz
    matrices = swept_dynamic_stiffness(point, cables, law, omega, assembly)
    ports = port_response(point, cables, law, (excite, *respond), omega)
    force = ports.twist[:, 0, :, None]
    motion = np.linalg.solve(matrices, np.broadcast_to(force, (len(omega), 6, 1)))
    displacement = (ports.twist[:, 1:] @ motion)[..., 0] + ports.direct[:, 1:, 0]
    return FrequencyResponse(hertz, displacement * _factor(quantity, omega), excite, respond, quantity)


def _factor(quantity: Quantity, omega: np.ndarray) -> np.ndarray:
    powers = {"displacement": np.ones_like(omega), "velocity": 1j * omega, "acceleration": -(omega**2)}
    return powers[quantity][:, None]

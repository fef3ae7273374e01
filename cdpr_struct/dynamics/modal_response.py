"""Frequency responses of a robot whose modes have damping ratios of their own: a sum over its modes.

The cables' modal expansion holds every mode up to a little above the band one by one, and all higher ones of a cable
in six condensed modes that answer its end alike. The sum over all of these modes so includes the residual flexibility.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.damping import ModalDamping
from cdpr_struct.dynamics.frequency_response import Quantity, derivative_factor
from cdpr_struct.dynamics.modal_basis import modal_basis
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import Port
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly

_BLOCK = 4096


@dataclass(frozen=True, slots=True, eq=False)
class ModalResponse:
    """Sum over k modes of residue / (omega_k^2 - omega^2 + 2 i zeta_k omega_k omega); made by `modal_response`.

    omega   : (k,) [rad/s];  ratio : (k,) zeta [-]
    residue : (k, n) product of the mode's displacement where the force acts and at each responding port, at unit
              modal mass
    """

    omega: np.ndarray
    ratio: np.ndarray
    residue: np.ndarray
    quantity: Quantity

    def at(self, hertz: np.ndarray) -> np.ndarray:
        """(f, n) as `ResponseFunction.at`."""
        found = np.empty((len(hertz), self.residue.shape[1]), dtype=complex)
        for start in range(0, len(hertz), _BLOCK):
            omega = 2.0 * np.pi * hertz[start : start + _BLOCK, None]
            gap = self.omega**2 - omega**2 + 2j * self.ratio * self.omega * omega
            gap = np.where(gap == 0.0, np.finfo(float).eps * self.omega**2, gap)
            found[start : start + _BLOCK] = (1.0 / gap) @ self.residue
        return found * derivative_factor(self.quantity, 2.0 * np.pi * hertz)


def modal_response(
    point: OperatingPoint,
    cables: CableDynamics,
    damping: ModalDamping,
    excite: Port,
    respond: tuple[Port, ...],
    highest: float,
    certified_hertz: np.ndarray,
    quantity: Quantity = "acceleration",
    assembly: Assembly = "consistent",
) -> ModalResponse:
    """The response function up to `highest` [rad/s], the top of the cables' modal expansion.

    certified_hertz : (c,) the robot's first eigenfrequencies [Hz]; they replace those of the modal expansion, which
                      are upper bounds
    """
    every = 7 + 3 * point.arrays.cable_count + cables.expansion(highest).omega_squared.size  # masts, internal mass
    basis = modal_basis(point, cables, damping, every, highest, assembly)
    omega = basis.omega.copy()
    known = min(len(certified_hertz), len(omega))
    omega[:known] = 2.0 * np.pi * certified_hertz[:known]
    shapes = np.stack([basis.shape_at(port) for port in respond], axis=1)
    residue = basis.shape_at(excite)[:, None] * shapes
    return ModalResponse(omega, damping.of_modes(len(omega)), residue, quantity)

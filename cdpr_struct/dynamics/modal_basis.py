"""The robot in the coordinates of its own undamped modes: frequencies, damping matrix, and what a motion excites."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.damping import Damping, ModalDamping, rates
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import CablePort, Port
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly

_AT_REST = 1.0  # [rad/s] at which the losses of a neutral freedom are taken: it has no frequency


@dataclass(frozen=True, slots=True, eq=False)
class ModalBasis:
    """k undamped modes of unit modal mass: coordinates x with x'' + C x' + omega^2 x = modal force.

    modes   : `RitzModes`
    damping : (k, k) C, symmetric [1/s]
    """

    modes: RitzModes
    damping: np.ndarray

    @property
    def omega(self) -> np.ndarray:
        """(k,) ascending [rad/s]."""
        return self.modes.omega

    def shape_at(self, port: Port) -> np.ndarray:
        """(k,) displacement (or rotation) of each mode at a port."""
        if not isinstance(port, CablePort):
            return self.modes.platform @ port.twist
        motion = self.modes.cable_motion(np.array([port.station]))
        return motion[:, port.cable, 0] @ port.direction

    def rigid_motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Modal coordinates (k, 6) of a unit platform motion that the cables share linearly along their length.

        Also the (6, 6) mass matrix of that motion: its kinetic energy is half of twist^T mass twist, of which the k
        modes hold half of twist^T coordinates^T coordinates twist.
        """
        modes = self.modes
        ramp_end, ramp_modal, ramp_mass = _ramp_products(modes.expansion)
        coordinates = modes.platform @ modes.platform_mass + modes.internal @ modes.internal_coupling.T
        coordinates += np.einsum("kma,mab,mbi->ki", modes.end, ramp_end, modes.to_cable, optimize=True)
        coordinates += np.einsum("kmp,mpa,mai->ki", modes.modal, ramp_modal, modes.to_cable, optimize=True)
        shared = np.einsum("ma,mai,maj->ij", ramp_mass, modes.to_cable, modes.to_cable)
        return coordinates, modes.platform_mass + shared


def modal_basis(
    point: OperatingPoint,
    cables: CableDynamics,
    law: Damping,
    count: int,
    highest: float,
    assembly: Assembly = "consistent",
) -> ModalBasis:
    """First `count` modes; cables resolved up to `highest` [rad/s].

    The damping matrix is that of the law where the law is a differential equation in time (`constant_rates`). Else it
    is diagonal, each mode with the losses that the law gives at its own frequency, or with its modal damping ratio.
    """
    modes = ritz_modes(point, cables.expansion(highest), count, assembly)
    return ModalBasis(modes, _damping(law, cables.first_frequency, modes))


def loss_rates(law: Damping, first: np.ndarray, modes: RitzModes) -> np.ndarray:
    """(k,) diagonal of the modal damping matrix [1/s]: 2 zeta omega of each mode, the law taken at its own frequency.

    first : (m,) first natural frequencies of the clamped cables [rad/s]
    """
    if isinstance(law, ModalDamping):
        return 2.0 * law.of_modes(len(modes.omega)) * modes.omega
    expansion, end = modes.expansion, modes.end
    omega = np.where(modes.omega > 0.0, modes.omega, _AT_REST)
    mass_rate, stiffness_time = rates(law, omega[:, None], first)
    elastic = np.einsum("kma,mab,kmb->km", end, expansion.static_stiffness, end, optimize=True)
    elastic += np.einsum("kmp,mp->km", modes.modal**2, expansion.omega_squared)
    return np.asarray((mass_rate * modes.cable_energy + stiffness_time * elastic).sum(axis=1))


def _damping(law: Damping, first: np.ndarray, modes: RitzModes) -> np.ndarray:
    """(k, k) sum over the cables of a_i M_i + b_i K_i in modal coordinates, or its diagonal."""
    if isinstance(law, ModalDamping) or not law.constant_rates:
        return np.diag(loss_rates(law, first, modes))
    mass_rate, stiffness_time = rates(law, modes.omega[-1:, None] + _AT_REST, first)
    total = np.zeros((len(modes.end), len(modes.end)))
    for i in range(len(first)):
        own_mass, own_stiffness = _cable_matrices(modes.expansion, modes.end[:, i], modes.modal[:, i], i)
        total += mass_rate[0, i] * own_mass + stiffness_time[0, i] * own_stiffness
    return 0.5 * (total + total.T)


def _cable_matrices(
    expansion: ModalExpansion, end: np.ndarray, modal: np.ndarray, i: int
) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness (k, k) of cable i, from the modes' end motion (k, 3) and clamped coordinates (k, p)."""
    cross = modal @ expansion.coupling[i] @ end.T
    mass = end @ expansion.end_mass[i] @ end.T + modal @ modal.T + cross + cross.T
    stiffness = end @ expansion.static_stiffness[i] @ end.T + (modal * expansion.omega_squared[i]) @ modal.T
    return mass, stiffness


def _ramp_products(expansion: ModalExpansion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass products of the linear share s with the static shapes (m, 3, 3), the modes (m, p, 3) and itself (m, 3) [kg].

    A direction in which no clamped mode moves carries no mass in its cable model (along the chord, in the closed form).
    """
    m, p = expansion.omega_squared.shape
    if p == 0:
        return np.zeros((m, 3, 3)), np.zeros((m, 0, 3)), np.zeros((m, 3))
    nodes, weights = np.polynomial.legendre.leggauss(24 + p)
    stations, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    static, modes = expansion.shapes(stations)
    whole = 1.0 / np.einsum("msa,s->m", modes[:, 0] ** 2, weights)
    mass = whole[:, None] * (np.abs(modes).max(axis=(1, 2)) > 0.0)
    share = stations * weights
    with_static = mass[:, :, None] * np.einsum("msab,s->mab", static, share)
    with_modes = mass[:, None, :] * np.einsum("mpsa,s->mpa", modes, share)
    return np.swapaxes(with_static, 1, 2), with_modes, mass / 3.0

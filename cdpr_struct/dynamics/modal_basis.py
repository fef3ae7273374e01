"""The robot in the coordinates of its own undamped modes: frequencies, damping matrix, and what a motion excites."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.damping import DampingLaw, rates
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import CablePort, Port
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    assemble,
    attachment,
    platform_mass_matrix,
)


@dataclass(frozen=True, slots=True, eq=False)
class ModalBasis:
    """k undamped modes of unit modal mass: coordinates x with x'' + C x' + omega^2 x = participation^T force.

    omega    : (k,) ascending [rad/s]
    platform : (k, 6) motion of the platform origin and rotation, world axes
    end      : (k, m, 3) motion of the cables' platform ends, local axes of `expansion`
    modal    : (k, m, p) coordinates of the clamped cables' modes
    damping  : (k, k) symmetric [1/s]
    """

    omega: np.ndarray
    platform: np.ndarray
    end: np.ndarray
    modal: np.ndarray
    damping: np.ndarray
    platform_mass: np.ndarray
    to_cable: np.ndarray
    expansion: ModalExpansion

    def shape_at(self, port: Port) -> np.ndarray:
        """(k,) displacement (or rotation) of each mode at a port."""
        if not isinstance(port, CablePort):
            return self.platform @ port.twist
        c = port.cable
        static, modes = self.expansion.shapes(np.array([port.station]))
        local = self.expansion.frame[c].T @ port.direction
        return self.end[:, c] @ (static[c, 0].T @ local) + self.modal[:, c] @ (modes[c, :, 0] @ local)

    def rigid_motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Modal coordinates (k, 6) of a unit platform motion that the cables share linearly along their length.

        Also the (6, 6) mass matrix of that motion: its kinetic energy is half of twist^T mass twist, of which the k
        modes hold half of twist^T coordinates^T coordinates twist.
        """
        ramp_end, ramp_modal, ramp_mass = _ramp_products(self.expansion)
        coordinates = self.platform @ self.platform_mass
        coordinates += np.einsum("kma,mab,mbi->ki", self.end, ramp_end, self.to_cable, optimize=True)
        coordinates += np.einsum("kmp,mpa,mai->ki", self.modal, ramp_modal, self.to_cable, optimize=True)
        shared = np.einsum("ma,mai,maj->ij", ramp_mass, self.to_cable, self.to_cable)
        return coordinates, self.platform_mass + shared


def modal_basis(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    count: int,
    highest: float,
    assembly: Assembly = "consistent",
) -> ModalBasis:
    """First `count` modes; cables resolved up to `highest` [rad/s].

    The damping matrix is that of the law where the law is a differential equation in time (`constant_rates`). Else it
    is diagonal, each mode with the losses that the law gives at its own frequency.
    """
    expansion = cables.expansion(highest)
    to_cable = np.swapaxes(expansion.frame, -1, -2) @ attachment(point)
    platform_mass = platform_mass_matrix(point.robot, point.rotation)
    stiffness, mass = _matrices(point, expansion, to_cable, platform_mass, assembly)
    size = len(mass)
    periods, vectors = scipy.linalg.eigh(mass, stiffness, subset_by_index=(size - count, size - 1))
    omega = 1.0 / np.sqrt(periods[::-1])
    vectors = vectors[:, ::-1] * omega
    platform = vectors[:6].T
    end = np.einsum("mai,ki->kma", to_cable, platform)
    modal = vectors[6:].T.reshape(count, *expansion.omega_squared.shape)
    damping = _damping(law, cables.first_frequency, omega, expansion, end, modal)
    return ModalBasis(omega, platform, end, modal, damping, platform_mass, to_cable, expansion)


def _matrices(
    point: OperatingPoint,
    expansion: ModalExpansion,
    to_cable: np.ndarray,
    platform_mass: np.ndarray,
    assembly: Assembly,
) -> tuple[np.ndarray, np.ndarray]:
    clamped = expansion.omega_squared.size
    mass = np.eye(6 + clamped)
    mass[:6, :6] = platform_mass + np.einsum("mai,mab,mbj->ij", to_cable, expansion.end_mass, to_cable)
    mass[6:, :6] = np.einsum("mpa,mai->mpi", expansion.coupling, to_cable).reshape(clamped, 6)
    mass[:6, 6:] = mass[6:, :6].T
    stiffness = np.diag(np.concatenate([np.zeros(6), expansion.omega_squared.ravel()]))
    ends = expansion.frame @ expansion.static_stiffness @ np.swapaxes(expansion.frame, -1, -2)
    stiffness[:6, :6] = assemble(point, ends, assembly)
    return stiffness, mass


def _damping(
    law: DampingLaw,
    first: np.ndarray,
    omega: np.ndarray,
    expansion: ModalExpansion,
    end: np.ndarray,
    modal: np.ndarray,
) -> np.ndarray:
    """(k, k) sum over the cables of a_i M_i + b_i K_i in modal coordinates."""
    mass_rate, stiffness_time = rates(law, omega[:, None], first)
    if law.constant_rates:
        a, b = mass_rate[0], stiffness_time[0]
        total = np.zeros((len(omega), len(omega)))
        for i in range(len(first)):
            own_mass, own_stiffness = _cable_matrices(expansion, end[:, i], modal[:, i], i)
            total += a[i] * own_mass + b[i] * own_stiffness
        return 0.5 * (total + total.T)
    mass = expansion.kinetic_energy(end, modal)
    elastic = np.einsum("kma,mab,kmb->km", end, expansion.static_stiffness, end)
    elastic += np.einsum("kmp,mp->km", modal**2, expansion.omega_squared)
    return np.diag((mass_rate * mass + stiffness_time * elastic).sum(axis=1))


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

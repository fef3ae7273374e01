"""Mode shapes of platform and cables, and where each mode's kinetic energy sits."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    assemble,
    attachment,
    platform_mass_matrix,
)


@dataclass(frozen=True, slots=True, eq=False)
class ModeShapes:
    """The first k modes, each of unit modal mass.

    hertz           : (k,) Ritz frequencies, upper bounds of the exact ones
    platform        : (k, 6) motion of the platform origin and rotation, world axes
    cable_motion    : (k, m, s, 3) motion at the s stations along each cable's chord, world axes
    platform_energy : (k,) share of the kinetic energy [-]
    cable_energy    : (k, m) shares [-]; all shares of a mode sum to one
    """

    hertz: np.ndarray
    platform: np.ndarray
    cable_motion: np.ndarray
    platform_energy: np.ndarray
    cable_energy: np.ndarray

    def kinds(self) -> list[str]:
        """ "platform", "cable i", or "cables" / "mixed" where no body holds half of the kinetic energy."""
        return [kind_of_mode(p, c) for p, c in zip(self.platform_energy, self.cable_energy, strict=True)]


def mode_shapes(
    point: OperatingPoint,
    cables: CableDynamics,
    count: int,
    highest: float,
    stations: np.ndarray,
    assembly: Assembly = "consistent",
) -> ModeShapes:
    """First `count` modes of the robot.

    Parameters
    ----------
    highest : the frequency [rad/s] up to which the cables' motion must be resolved (`highest_omega`)
    stations : (s,) fractions of each cable, 0 at the frame and 1 at the platform
    """
    expansion = cables.expansion(highest)
    to_cable = np.swapaxes(expansion.frame, -1, -2) @ attachment(point)
    platform_mass = platform_mass_matrix(point.robot, point.rotation)
    stiffness, mass = _matrices(point, expansion, to_cable, platform_mass, assembly)
    hertz, vectors = _slow_modes_first(stiffness, mass, count)
    platform = vectors[:6].T
    end = np.einsum("mai,ki->kma", to_cable, platform)
    modal = vectors[6:].T.reshape(count, *expansion.omega_squared.shape)
    return ModeShapes(
        hertz=hertz,
        platform=platform,
        cable_motion=expansion.motion(stations, end, modal),
        platform_energy=np.einsum("ki,ij,kj->k", platform, platform_mass, platform),
        cable_energy=expansion.kinetic_energy(end, modal),
    )


def _slow_modes_first(stiffness: np.ndarray, mass: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """First frequencies [Hz] and shapes of unit modal mass, from the eigenproblem of 1 / omega^2 (rounding)."""
    size = len(mass)
    periods, vectors = scipy.linalg.eigh(mass, stiffness, subset_by_index=(size - count, size - 1))
    periods, vectors = periods[::-1], vectors[:, ::-1]
    return 1.0 / (2.0 * np.pi * np.sqrt(periods)), vectors / np.sqrt(periods)


def _matrices(
    point: OperatingPoint,
    expansion: ModalExpansion,
    to_cable: np.ndarray,
    platform_mass: np.ndarray,
    assembly: Assembly,
) -> tuple[np.ndarray, np.ndarray]:
    modal_count = expansion.omega_squared.size
    mass = np.eye(6 + modal_count)
    mass[:6, :6] = platform_mass + np.einsum("mai,mab,mbj->ij", to_cable, expansion.end_mass, to_cable)
    mass[6:, :6] = np.einsum("mpa,mai->mpi", expansion.coupling, to_cable).reshape(modal_count, 6)
    mass[:6, 6:] = mass[6:, :6].T
    stiffness = np.diag(np.concatenate([np.zeros(6), expansion.omega_squared.ravel()]))
    ends = expansion.frame @ expansion.static_stiffness @ np.swapaxes(expansion.frame, -1, -2)
    stiffness[:6, :6] = assemble(point, ends, assembly)
    return stiffness, mass


def kind_of_mode(platform: float, cables: np.ndarray) -> str:
    """ "platform" or "cable i" if it holds half of the kinetic energy, else "cables" (nine tenths) or "mixed"."""
    if platform >= 0.5:
        return "platform"
    if cables.max() >= 0.5:
        return f"cable {int(cables.argmax()) + 1}"
    return "cables" if platform < 0.1 else "mixed"

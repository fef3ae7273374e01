"""Mode shapes of platform and cables, and where each mode's kinetic energy sits."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from cdpr_struct.dynamics.cable_modal_expansion import CableModalExpansion, expand
from cdpr_struct.dynamics.operating_point import OperatingPoint, TautCables, taut_cables
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    attachment,
    platform_dynamic_stiffness,
    platform_mass_matrix,
)

_SPARE_PAIRS = 6


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
        return [_kind(p, c) for p, c in zip(self.platform_energy, self.cable_energy, strict=True)]


def mode_shapes(
    point: OperatingPoint, count: int, stations: np.ndarray, assembly: Assembly = "consistent"
) -> ModeShapes:
    """Modes of the robot with the cables of the closed-form DSM.

    Parameters
    ----------
    stations : (s,) fractions of the chord, 0 at the frame and 1 at the platform
    """
    cables = taut_cables(point)
    expansion = expand(cables, _pairs_needed(cables, count))
    to_cable = np.swapaxes(cables.frame, -1, -2) @ attachment(point)
    platform_mass = platform_mass_matrix(point.robot, point.rotation)
    stiffness, mass = _matrices(point, expansion, to_cable, platform_mass, assembly)
    squared, vectors = scipy.linalg.eigh(stiffness, mass, subset_by_index=(0, count - 1))
    platform = vectors[:6].T
    end = np.einsum("mai,ki->kma", to_cable, platform)
    modal = vectors[6:].T.reshape(count, *expansion.omega_squared.shape)
    motion = expansion.motion(stations, end, modal)
    return ModeShapes(
        hertz=np.sqrt(np.maximum(squared, 0.0)) / (2.0 * np.pi),
        platform=platform,
        cable_motion=np.einsum("mab,kmsb->kmsa", cables.frame, motion),
        platform_energy=np.einsum("ki,ij,kj->k", platform, platform_mass, platform),
        cable_energy=_cable_energy(expansion, end, modal),
    )


def _pairs_needed(cables: TautCables, count: int) -> int:
    per_pair = 4 * len(cables.chord)
    spread = float(cables.frequency_scale.max() / cables.frequency_scale.min())
    return int(np.ceil(count / per_pair * spread)) + _SPARE_PAIRS


def _matrices(
    point: OperatingPoint,
    expansion: CableModalExpansion,
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
    stiffness[:6, :6] = platform_dynamic_stiffness(point, expansion.cables, np.zeros(1), assembly)
    return stiffness, mass


def _cable_energy(expansion: CableModalExpansion, end: np.ndarray, modal: np.ndarray) -> np.ndarray:
    own = np.einsum("kma,mab,kmb->km", end, expansion.end_mass, end)
    return own + (modal**2).sum(-1) + 2.0 * np.einsum("kmp,mpa,kma->km", modal, expansion.coupling, end)


def _kind(platform: float, cables: np.ndarray) -> str:
    if platform >= 0.5:
        return "platform"
    if cables.max() >= 0.5:
        return f"cable {int(cables.argmax()) + 1}"
    return "cables" if platform < 0.1 else "mixed"

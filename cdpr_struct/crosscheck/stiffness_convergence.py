"""The platform's dynamic stiffness K(omega) itself, between FEM meshes, the exact catenary and the closed form."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.dynamics.cable_dynamics import CableModel, cable_dynamics
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    platform_dynamic_stiffness,
    platform_mass_matrix,
    platform_static_stiffness,
)
from cdpr_struct.statics.guides import free_block
from cdpr_struct.statics.neutral_freedoms import NEUTRAL


@dataclass(frozen=True, slots=True, eq=False)
class StiffnessConvergence:
    """Largest error of K(omega) - omega^2 M over some omegas, against the exact catenary.

    Entries are scaled by the roots of the static stiffness's diagonal, so that forces and moments compare.

    omega_hertz : (w,) where it was compared, far from any pole
    fem_error   : (e, w) per element count, lumped mass;  dsm_error : (w,)
    """

    omega_hertz: np.ndarray
    fem_error: np.ndarray
    dsm_error: np.ndarray


def stiffness_convergence(
    point: OperatingPoint, meshes: Sequence[fem.RobotEquilibrium], frequencies: np.ndarray, assembly: Assembly
) -> StiffnessConvergence:
    """Compare K(omega) in the middle of the widest gaps between the natural frequencies (k,) [Hz]."""
    hertz = quiet_frequencies(frequencies)
    omega = 2.0 * np.pi * hertz
    scale = _scale(np.abs(np.diag(platform_static_stiffness(point, assembly))))
    exact = _model(point, "exact", omega, assembly)

    def error(stiffness: np.ndarray) -> np.ndarray:
        return np.abs(free_block((stiffness - exact) * scale[:, None] * scale, point.arrays)).max(axis=(-1, -2))

    geometric = assembly == "consistent"
    found = [fem.platform_dynamic_stiffness(mesh, omega, geometric_terms=geometric) for mesh in meshes]
    return StiffnessConvergence(
        hertz, np.array([error(k) for k in found]), error(_model(point, "dsm", omega, assembly))
    )


def _scale(diagonal: np.ndarray) -> np.ndarray:
    """(6,) one over the roots of a stiffness's diagonal (6,); zero in a direction that nothing holds."""
    largest = np.repeat(diagonal.reshape(2, 3).max(axis=1), 3)
    held = diagonal > NEUTRAL * largest
    return np.where(held, 1.0 / np.sqrt(np.where(held, diagonal, 1.0)), 0.0)


def quiet_frequencies(frequencies: np.ndarray, count: int = 8) -> np.ndarray:
    """Middles [Hz] of the `count` widest relative gaps between ascending natural frequencies, ascending."""
    edges = np.concatenate([[0.2 * frequencies[0]], frequencies])
    widest = np.argsort(edges[1:] / edges[:-1])[::-1][:count]
    return np.sort(0.5 * (edges[widest] + edges[widest + 1]))


def _model(point: OperatingPoint, model: CableModel, omega: np.ndarray, assembly: Assembly) -> np.ndarray:
    cables = cable_dynamics(point, model, float(omega.max()))
    mass = platform_mass_matrix(point.entered, point.rotation)
    squared = omega[:, None] ** 2
    return platform_dynamic_stiffness(point, cables, squared, assembly) - squared[..., None] * mass

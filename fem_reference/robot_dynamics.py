"""Dynamic stiffness of the robot at its platform, and the certified number of eigenfrequencies."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike

from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.bent_masts import softened
from cdpr_struct.fem_reference.cable_damping import damping_rates
from cdpr_struct.fem_reference.rigid_platform import platform_mass_matrix
from cdpr_struct.fem_reference.robot import RobotEquilibrium
from cdpr_struct.fem_reference.substructure import Pieces, condensed_and_counted, condensed_both_ends, dynamic_ends

NEUTRAL = 1e-9  # of the largest eigenvalue: what is less counts as nothing


def platform_dynamic_stiffness(
    equilibrium: RobotEquilibrium,
    omegas: ArrayLike,
    mass: MassModel = "lumped",
    geometric_terms: bool = True,
    damping_ratio: ArrayLike | None = None,
) -> np.ndarray:
    """Wrench at the platform per small platform motion in steady vibration, cables condensed.

    Parameters
    ----------
    equilibrium : RobotEquilibrium.
    omegas : (...) [rad/s], real or complex.
    mass : "lumped" or "consistent", of the cables.
    geometric_terms : False drops the second-order terms of the turning lever arms (cable forces, weight of
        an offset centre of mass, external force), to show their effect.
    damping_ratio : xi [-] of the cables, one or (m,), see `damping_rates`; None for none.

    Returns
    -------
    (..., 6, 6) symmetric, world axes, moments about the reference point; platform mass included, a guide left out.
    """
    omega = np.asarray(omegas)
    squares = (omega * omega * 1.0).reshape(-1)
    rates = damping_rates(equilibrium, damping_ratio, mass)
    motion = equilibrium.end_motion()
    if equilibrium.robot.surroundings.bending:
        matrix = np.array([_on_masts(equilibrium, w, mass, rates) for w in omega.reshape(-1)])
    else:
        ends = _cable_ends(equilibrium, omega.reshape(-1), mass, rates)
        matrix = np.einsum("mka,wmkl,mlb->wab", motion, ends, motion, optimize=True)
    platform = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    matrix = matrix - squares[:, None, None] * platform
    if geometric_terms:
        matrix = matrix + equilibrium.geometric_stiffness()
    return (0.5 * (matrix + np.swapaxes(matrix, -1, -2))).reshape(*omega.shape, 6, 6)


def neutral_freedoms(equilibrium: RobotEquilibrium) -> int:
    """Number of directions in which nothing pushes the platform back at rest: eigenvalues of its condensed stiffness,
    by its own mass, below `NEUTRAL` of the largest."""
    free = np.ix_(equilibrium.robot.free_unknowns, equilibrium.robot.free_unknowns)
    stiffness = platform_dynamic_stiffness(equilibrium, 0.0)[free]
    mass = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)[free]
    values = scipy.linalg.eigh(stiffness, mass, eigvals_only=True)
    return int((np.abs(values) <= NEUTRAL * values[-1]).sum())


def _on_masts(equilibrium: RobotEquilibrium, omega: complex, mass: MassModel, rates: np.ndarray) -> np.ndarray:
    """Stiffness (6, 6) at the platform of the cables on their masts at one omega [rad/s]."""
    squares = omega * omega - 1.0j * rates * omega if rates.any() else np.full(len(rates), omega * omega)
    matrices = equilibrium.element_stiffness() - squares[:, None, None, None] * equilibrium.element_mass(mass)
    pieces, _ = condensed_both_ends(matrices)
    return _softened(equilibrium, pieces, omega * omega)[0]


def _softened(equilibrium: RobotEquilibrium, pieces: Pieces, omega_squared: complex) -> tuple[np.ndarray, np.ndarray]:
    first, between, last = (block[..., 0, :, :] for block in (pieces.first, pieces.between, pieces.last))
    return softened(equilibrium.robot.soft_masts, last, first, between, equilibrium.end_motion(), omega_squared)


def _cable_ends(equilibrium: RobotEquilibrium, omegas: np.ndarray, mass: MassModel, rates: np.ndarray) -> np.ndarray:
    """End dynamic stiffness (w, m, 3, 3) of all cables for omegas (w,) and damping rates (m,) [1/s]."""
    stiffness, inertia, squares = equilibrium.element_stiffness(), equilibrium.element_mass(mass), omegas * omegas * 1.0
    if not rates.any():
        return dynamic_ends(stiffness, inertia, squares)
    each = [
        dynamic_ends(stiffness[index], inertia[index], squares - 1.0j * rate * omegas)
        for index, rate in enumerate(rates)
    ]
    return np.stack(each, axis=1)


def count_below(equilibrium: RobotEquilibrium, omega: float, mass: MassModel = "lumped") -> int:
    """Number of eigenfrequencies of the robot below omega [rad/s].

    Sylvester's law of inertia on K - omega^2 M: negative pivots of every cable, eliminated to its end, and of the
    masts, eliminated next, plus the negative eigenvalues of the free part of the remaining 6 x 6 matrix. No eigenvalue
    is computed, so none is missed.
    """
    matrices = equilibrium.element_stiffness() - omega**2 * equilibrium.element_mass(mass)
    platform = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    if equilibrium.robot.surroundings.bending:
        pieces, in_cables = condensed_both_ends(matrices)
        remaining, masts = _softened(equilibrium, pieces, omega**2)
        in_masts = int((np.linalg.eigvalsh(0.5 * (masts + masts.T)) < 0.0).sum())
    else:
        ends, in_cables = condensed_and_counted(matrices)
        motion, in_masts = equilibrium.end_motion(), 0
        remaining = np.einsum("mka,mkl,mlb->ab", motion, ends, motion, optimize=True)
    remaining = remaining + equilibrium.geometric_stiffness() - omega**2 * platform
    free = equilibrium.robot.free_unknowns
    remaining, size = remaining[np.ix_(free, free)], np.sqrt(np.diag(platform))[free]
    remaining = 0.5 * (remaining + remaining.T) / np.outer(size, size)
    return int(in_cables.sum()) + in_masts + int((np.linalg.eigvalsh(remaining) < 0.0).sum())

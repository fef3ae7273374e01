"""Dynamic stiffness of the robot at its platform, and the certified number of eigenfrequencies."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fem_reference.bar_element import MassModel
from fem_reference.rigid_platform import platform_mass_matrix
from fem_reference.robot import RobotEquilibrium
from fem_reference.substructure import condensed_and_counted, dynamic_ends


def platform_dynamic_stiffness(
    equilibrium: RobotEquilibrium, omegas: ArrayLike, mass: MassModel = "lumped", geometric_terms: bool = True
) -> np.ndarray:
    """Wrench at the platform per small platform motion in steady vibration, cables condensed.

    Parameters
    ----------
    equilibrium : RobotEquilibrium.
    omegas : (...) [rad/s], real or complex.
    mass : "lumped" or "consistent", of the cables.
    geometric_terms : False drops the second-order terms of the turning lever arms (cable forces, weight of
        an offset centre of mass, external force), to show their effect.

    Returns
    -------
    (..., 6, 6) symmetric, world axes, moments about the reference point; platform mass included.
    """
    omega = np.asarray(omegas)
    squares = (omega * omega * 1.0).reshape(-1)
    ends = dynamic_ends(equilibrium.element_stiffness(), equilibrium.element_mass(mass), squares)
    motion = equilibrium.end_motion()
    matrix = np.einsum("mka,wmkl,mlb->wab", motion, ends, motion, optimize=True)
    platform = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    matrix = matrix - squares[:, None, None] * platform
    if geometric_terms:
        matrix = matrix + equilibrium.geometric_stiffness()
    return (0.5 * (matrix + np.swapaxes(matrix, -1, -2))).reshape(*omega.shape, 6, 6)


def count_below(equilibrium: RobotEquilibrium, omega: float, mass: MassModel = "lumped") -> int:
    """Number of eigenfrequencies of the robot below omega [rad/s].

    Sylvester's law of inertia on K - omega^2 M: negative pivots of every cable, eliminated to its end, plus
    the negative eigenvalues of the remaining 6 x 6 matrix. No eigenvalue is computed, so none is missed.
    """
    matrices = equilibrium.element_stiffness() - omega**2 * equilibrium.element_mass(mass)
    ends, in_cables = condensed_and_counted(matrices)
    motion = equilibrium.end_motion()
    platform = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    remaining = np.einsum("mka,mkl,mlb->ab", motion, ends, motion, optimize=True)
    remaining = remaining + equilibrium.geometric_stiffness() - omega**2 * platform
    size = np.sqrt(np.diag(platform))
    remaining = 0.5 * (remaining + remaining.T) / np.outer(size, size)
    return int(in_cables.sum()) + int((np.linalg.eigvalsh(remaining) < 0.0).sum())

"""How does the platform answer a harmonic wrench, with viscous damping in the cables?"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.robot import RobotEquilibrium
from cdpr_struct.fem_reference.robot_dynamics import platform_dynamic_stiffness


def frequency_response(
    equilibrium: RobotEquilibrium,
    omegas: ArrayLike,
    damping_ratio: ArrayLike | None = None,
    mass: MassModel = "lumped",
) -> np.ndarray:
    """Small motion of the platform per wrench on it, in steady vibration exp(+i omega t).

    Parameters
    ----------
    equilibrium : RobotEquilibrium.
    omegas : (...) [rad/s], real or complex.
    damping_ratio : xi [-] of the cables, one or (m,), or None; see `damping_rates`. Each cable vibrates at
        omega_c^2 = omega^2 - 2i xi omega_1 omega, the platform itself is not damped.
    mass : "lumped" or "consistent", of the cables.

    Returns
    -------
    (..., 6, 6) symmetric, world axes: displacement of the reference point and rotation vector, per force and
    moment about the reference point; complex if the damping or an omega is. Zero where a guide holds the platform.

    Raises
    ------
    ValueError : unfit damping ratios.
    """
    stiffness = platform_dynamic_stiffness(equilibrium, omegas, mass, damping_ratio=damping_ratio)
    free = equilibrium.robot.free_unknowns
    rows, columns = np.ix_(free, free)
    moved = np.zeros_like(stiffness)
    moved[..., rows, columns] = np.linalg.inv(stiffness[..., rows, columns])
    return moved

"""A moment with constant axes has no potential: how much does what vibration leaves out of it matter?

Turned by theta, a force on an arm changes its moment; a moment whose axes stay those of the world does not. So the
stiffness of a platform at rest under it is not symmetric: beside the symmetric part it has half the cross-product
matrix of the moment. Natural frequencies need a symmetric matrix, and vibration takes that part. It is the whole
stiffness under a semitangential moment, such as the couple of two forces on crossed arms applies (Ziegler, Principles
of Structural Stability, 1968), and for distinct frequencies the rest changes them to second order only.
"""

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_mass_matrix, platform_static_stiffness
from cdpr_struct.statics.equilibrium import moment_skew
from cdpr_struct.statics.guides import free_block

WORTH_SAYING = 1e-3  # of a frequency
_ROUNDING = 1e-9  # of the largest squared frequency: imaginary parts below it are none


def frequency_change(point: OperatingPoint) -> float:
    """Largest change of a platform frequency, relative, by the part that vibration leaves out; cables massless.

    inf where that part makes a vibration grow, which needs frequencies close to each other.
    """
    stiffness, mass = platform_static_stiffness(point), platform_mass_matrix(point.arrays, point.rotation)
    whole = stiffness.copy()
    whole[..., 3:, 3:] += moment_skew(-point.arrays.moment)
    mass, stiffness, whole = (free_block(matrix, point.arrays) for matrix in (mass, stiffness, whole))
    taken, true = (np.linalg.eigvals(np.linalg.solve(mass, matrix)) for matrix in (stiffness, whole))
    if np.abs(true.imag).max() > _ROUNDING * np.abs(true).max():
        return np.inf
    before, after = np.sort(taken.real), np.sort(true.real)
    kept = before > _ROUNDING * before[-1]  # others are free motions, which have no frequency
    return float(np.abs(np.sqrt(np.maximum(after[kept] / before[kept], 0.0)) - 1.0).max())


def moment_sentence(point: OperatingPoint) -> str | None:
    """What is to be known of frequencies under the robot's constant moment; None where it matters little."""
    if not point.arrays.moment.any() or (change := frequency_change(point)) < WORTH_SAYING:
        return None
    said = "The constant moment has no potential; vibration takes the symmetric part of its stiffness. "
    if np.isinf(change):
        return said + "With the rest, a vibration of the platform would grow without damping (flutter)."
    return said + f"With the rest, a frequency of the platform would change by {100.0 * change:.2g} %."

"""Closed-form dynamic stiffness of taut sagging cables (thesis eqs 2.31-2.46), in the world frame."""

import numpy as np

from cdpr_struct.dynamics.operating_point import TautCables
from cdpr_struct.generated import cable_dsm


def cable_dynamic_stiffness(cables: TautCables, omega_c_squared: np.ndarray) -> np.ndarray:
    """Force that holds the platform end of each cable against a unit harmonic displacement.

    Parameters
    ----------
    cables : shape (..., m)
    omega_c_squared : broadcasts against (..., m) [rad^2/s^2]; complex for damped cables (`damped`)

    Returns
    -------
    (..., m, 3, 3) array [N/m], world axes, symmetric.

    Eqs (2.31)-(2.35), rotated by (2.46) and (3.7).
    """
    k_xx, k_xz, k_yy, k_zz = cable_dsm.dynamic_stiffness(
        omega_c_squared,
        cables.chord,
        cables.tension,
        cables.axial_stiffness,
        cables.effective_length,
        cables.linear_density,
        cables.perpendicular_weight,
    )
    zero = np.zeros_like(k_xx)
    local = np.stack(
        [
            np.stack([k_xx, zero, k_xz], axis=-1),
            np.stack([zero, k_yy, zero], axis=-1),
            np.stack([k_xz, zero, k_zz], axis=-1),
        ],
        axis=-2,
    )
    return cables.frame @ local @ np.swapaxes(cables.frame, -1, -2)


def damped(cables: TautCables, omega: np.ndarray) -> np.ndarray:
    """omega_c^2 (..., m) of viscously damped cables at omega (..., 1) [rad/s].

    omega_c^2 = omega^2 - 2 i xi omega_1 omega, xi referred to the cable's first out-of-plane frequency omega_1.
    """
    return cable_dsm.damped_omega_squared(omega, cables.damping_ratio, np.pi * cables.frequency_scale)

"""The dynamic stiffness of the small-sag cable written with entire functions of y^2 = (Omega_c/2)^2.

With c = cos y, s = sin(y)/y and G = (s - c)/(4 y^2) the auxiliary term kappa = tan(y)/y of eqs (2.32)-(2.34)
disappears, and with it the false poles of kappa and the 0/0 at Omega_c = 0 and lambda^2 = 0. Equality with
the solution of the differential equation is proved in cable_dsm.py.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations.special_functions import asinhc, cos_of_square, sinc_cos_gap, sinc_of_square
from cdpr_struct.derivations.symbols import (
    axial_stiffness,
    chord,
    effective_length,
    epsilon,
    frequency_parameter,
    lambda2,
    linear_density,
    omega_c_squared,
    perpendicular_weight,
    tension,
)


def half_frequency_squared() -> Any:
    """y^2 = (Omega_c/2)^2 [-]."""
    return omega_c_squared * chord**2 * linear_density / (4 * tension)


def sag_ratio() -> Any:
    """epsilon of eq. (2.37) [-]."""
    return perpendicular_weight * chord / tension


def irvine_parameter() -> Any:
    """lambda^2 of eq. (2.36) [-]."""
    return sag_ratio() ** 2 * axial_stiffness * chord / (tension * effective_length)


def clamped_denominator(square: Any, irvine: Any) -> Any:
    """cos(y) + lambda^2 (sin(y)/y - cos(y))/(4 y^2): zero where the clamped cable has a symmetric mode."""
    return cos_of_square(square) + irvine * sinc_cos_gap(square) / 4


def dynamic_stiffness() -> tuple[Any, Any, Any, Any]:
    """k_xx, k_xz, k_yy, k_zz [N/m]; chord frame with z up."""
    square, irvine = half_frequency_squared(), irvine_parameter()
    cosine, sinc, gap = cos_of_square(square), sinc_of_square(square), sinc_cos_gap(square)
    denominator = clamped_denominator(square, irvine)
    axial, transverse = axial_stiffness / effective_length, tension / chord
    k_xx = axial * cosine / denominator
    k_xz = -axial * sag_ratio() / 2 * square * gap / denominator
    k_yy = transverse * (cosine / sinc - square * sinc / cosine)
    k_zz = transverse * (cosine / sinc - square * (sinc + irvine * gap / 4) / denominator)
    return k_xx, k_xz, k_yy, k_zz


def clamped_frequency_function() -> Any:
    """clamped_denominator as a function of Omega and lambda^2."""
    return clamped_denominator(frequency_parameter**2 / 4, lambda2)


def effective_length_integral() -> Any:
    """int (ds/dx)^3 dx over the parabola [m]."""
    a = epsilon / 2
    return chord * ((2 * a**2 + 5) * sp.sqrt(1 + a**2) + 3 * asinhc(a)) / 8


def effective_length_approximation() -> Any:
    """The first two terms in epsilon [m]."""
    return chord * (1 + epsilon**2 / 8)

"""Docstring texts of the generated functions: what is returned, and which equation it is."""

from __future__ import annotations

_TAUT = "Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed."
_FOLDED = "Where force_x = 0 and the vertical end forces differ in sign, the true c_xx is infinite."
_CATENARY = "derivations/catenary.py."
_COMPLIANCE = "derivations/cable_compliance.py."
_DSM = "derivations/cable_dsm.py."
_LENGTH = "derivations/cable_length.py."
_PLATFORM = "derivations/platform.py."
_BOUND = "derivations/tension_bound.py."

DESCRIPTIONS: dict[str, tuple[str, tuple[str, ...]]] = {
    "end_point": (
        "Coordinates (x, z) of C from B [m]; x along force_x > 0, z up.",
        (_TAUT, f"Eqs (2.11)-(2.12), {_CATENARY}"),
    ),
    "profile": (
        "Coordinates (x, z) of the cable at s [m], from B; z up.",
        (_TAUT, f"Eqs (2.9)-(2.10), {_CATENARY}"),
    ),
    "elongation": ("Strained minus unstrained length [m].", (_TAUT, f"Eqs (2.15)-(2.16), {_CATENARY}")),
    "chord_tension": (
        "tau [N], tension where the cable is parallel to its chord.",
        (_TAUT, f"Eq. (2.17), {_CATENARY}"),
    ),
    "chord_parallel_coordinate": (
        "s_Q [m], unstrained coordinate where the cable is parallel to its chord.",
        (_TAUT, f"Eq. (2.21), {_CATENARY}"),
    ),
    "sag": ("d [m], sag perpendicular to the chord.", (_TAUT, f"Eq. (2.22), {_CATENARY}")),
    "compliance": (
        "(c_axial, c_xx_sag, c_xz_sag, c_zz_sag) [m/N]; c_axial belongs on both diagonal places.",
        (_TAUT, _FOLDED, f"Eqs (2.24)-(2.28), {_COMPLIANCE}"),
    ),
    "stiffness": (
        "(k_xx, k_xz, k_zz) [N/m], change of the force at C with its displacement; x, z as force_x, force_z.",
        (
            _TAUT,
            _FOLDED,
            "The determinant is a sum of positive terms.",
            f"Eq. (2.29) corrected, {_COMPLIANCE}",
        ),
    ),
    "dynamic_stiffness": (
        "(k_xx, k_xz, k_yy, k_zz) [N/m], force on the end C over its displacement.",
        (
            "Chord frame: x from B to C, z perpendicular to it and up, y = z cross x.",
            "Real input gives real output. Infinite at the clamped cable's frequencies.",
            f"Eqs (2.32)-(2.35), k_xz corrected, {_DSM}",
        ),
    ),
    "lambda_squared": ("lambda^2 [-], Irvine's parameter.", (f"Eq. (2.36), {_DSM}",)),
    "epsilon": ("epsilon [-], weight across the chord over tension, 8 d/l_c.", (f"Eq. (2.37), {_LENGTH}",)),
    "effective_length_integral": (
        "L_e [m], int (ds/dx)^3 dx over the parabola.",
        (f"Section 2.2.2, {_LENGTH}",),
    ),
    "effective_length_approximation": (
        "L_e [m] to second order in epsilon.",
        (f"Section 2.2.2, {_LENGTH}",),
    ),
    "damped_omega_squared": (
        "omega_c^2 [rad^2/s^2], complex; time dependence exp(i omega t).",
        (f"Eq. (2.39) completed, {_DSM}",),
    ),
    "clamped_frequency_function": (
        "Zero at the in-plane symmetric frequencies of the cable clamped at both ends [-].",
        ("Entire in Omega: it has no poles.", f"Denominator of eqs (2.32)-(2.34), {_DSM}"),
    ),
    "rotation": (
        "(..., 3, 3) rotation Rz(rz) Ry(ry) Rx(rx), platform to world [-].",
        (f"Product of three exponentials, {_PLATFORM}",),
    ),
    "attachment": (
        "(..., 3, 6) map from (delta, theta) to the attachment's displacement delta + theta x a.",
        ("Columns 0-2 [-], 3-5 [m], in the axes of the arm.", f"Eq. (3.9) corrected, {_PLATFORM}"),
    ),
    "attachment_printed": (
        "(..., 3, 6) eq. (3.9) as printed: the rotation is counted the other way round.",
        ("Columns 0-2 [-], 3-5 [m], in the axes of the arm.", f"Eq. (3.9) printed, {_PLATFORM}"),
    ),
    "geometric_stiffness": (
        "(..., 3, 3) symmetric stiffness [N m/rad] on theta from a constant force on a rotating arm.",
        ("Force and arm in the same axes. Adds to A^T K A.", f"Missing in eq. (3.8), {_PLATFORM}"),
    ),
    "mass_matrix": (
        "(..., 6, 6) mass matrix about the reference point, for (delta, theta).",
        ("Centre of mass and inertia in the axes of the result.", f"Eq. (3.12), {_PLATFORM}"),
    ),
    "lower_bound_printed": (
        "f_lb [N, with b taken as a pure number] as printed.",
        (f"Eq. (5.15) printed, {_BOUND}",),
    ),
    "lower_bound_frequency": (
        "f_lb [N] at which the first frequency of the cable is b.",
        (f"Eq. (5.15) corrected, {_BOUND}",),
    ),
}
"""Function name -> (first line, further lines)."""

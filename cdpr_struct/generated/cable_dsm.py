"""GENERATED FILE - do not edit.

Regenerate : python -m cdpr_struct.derivations
Source     : derivations/cable_dsm.py, eqs (2.31)-(2.41)
Made with  : sympy 1.14.0; 82 operations after cse
"""

from typing import Any

import numpy as np

from cdpr_struct.generated.special_functions import asinhc, cos_of_square, sinc_cos_gap, sinc_of_square


def dynamic_stiffness(omega_c_squared: Any, chord: Any, tension: Any, axial_stiffness: Any, effective_length: Any, linear_density: Any, perpendicular_weight: Any) -> Any:
    """(k_xx, k_xz, k_yy, k_zz) [N/m], force on the end C over its displacement.

    omega_c_squared      : [rad^2/s^2] real, or complex with damping (damped_omega_squared)
    chord                : l_c [m]
    tension              : tau [N], static tension where the cable is parallel to its chord
    axial_stiffness      : EA [N]
    effective_length     : L_e [m]
    linear_density       : rho [kg/m]
    perpendicular_weight : rho g cos(alpha) [N/m], weight component across the chord

    Chord frame: x from B to C, z perpendicular to it and up, y = z cross x.
    Real input gives real output. Infinite at the clamped cable's frequencies.
    Eqs (2.32)-(2.35), k_xz corrected, derivations/cable_dsm.py.
    """
    t0 = linear_density*omega_c_squared
    t1 = (1/4)*chord**2*t0/tension
    t2 = cos_of_square(t1)
    t3 = axial_stiffness/effective_length
    t4 = chord**3*sinc_cos_gap(t1)
    t5 = (1/4)*perpendicular_weight**2*t3*t4/tension**3
    t6 = 1/(t2 + t5)
    t7 = t3*t6
    t8 = sinc_of_square(t1)
    t9 = -t2/t8
    t10 = tension/chord
    return t2*t7, -1/8*perpendicular_weight*t0*t4*t7/tension**2, t10*(-t1*t8/t2 - t9), t10*(-t1*t6*(t5 + t8) - t9)


def lambda_squared(chord: Any, tension: Any, axial_stiffness: Any, effective_length: Any, perpendicular_weight: Any) -> Any:
    """lambda^2 [-], Irvine's parameter.

    chord                : l_c [m]
    tension              : tau [N], static tension where the cable is parallel to its chord
    axial_stiffness      : EA [N]
    effective_length     : L_e [m]
    perpendicular_weight : rho g cos(alpha) [N/m], weight component across the chord

    Eq. (2.36), derivations/cable_dsm.py.
    """
    return axial_stiffness*chord**3*perpendicular_weight**2/(effective_length*tension**3)


def epsilon(chord: Any, tension: Any, perpendicular_weight: Any) -> Any:
    """epsilon [-], weight across the chord over tension, 8 d/l_c.

    chord                : l_c [m]
    tension              : tau [N], static tension where the cable is parallel to its chord
    perpendicular_weight : rho g cos(alpha) [N/m], weight component across the chord

    Eq. (2.37), derivations/cable_length.py.
    """
    return chord*perpendicular_weight/tension


def effective_length_integral(chord: Any, epsilon: Any) -> Any:
    """L_e [m], int (ds/dx)^3 dx over the parabola.

    chord   : l_c [m]
    epsilon : [-] perpendicular_weight*chord/tension

    Section 2.2.2, derivations/cable_length.py.
    """
    t0 = epsilon**2
    return (1/8)*chord*(np.sqrt((1/4)*t0 + 1)*((1/2)*t0 + 5) + 3*asinhc((1/2)*epsilon))


def effective_length_approximation(chord: Any, epsilon: Any) -> Any:
    """L_e [m] to second order in epsilon.

    chord   : l_c [m]
    epsilon : [-] perpendicular_weight*chord/tension

    Section 2.2.2, derivations/cable_length.py.
    """
    return chord*((1/8)*epsilon**2 + 1)


def damped_omega_squared(omega: Any, damping_ratio: Any, reference_omega: Any) -> Any:
    """omega_c^2 [rad^2/s^2], complex; time dependence exp(i omega t).

    omega           : [rad/s]
    damping_ratio   : xi [-], referred to reference_omega
    reference_omega : omega_1 [rad/s], first natural frequency of the cable

    Eq. (2.39) completed, derivations/cable_dsm.py.
    """
    return -2*1j*damping_ratio*omega*reference_omega + omega**2


def clamped_frequency_function(frequency_parameter: Any, lambda2: Any) -> Any:
    """Zero at the in-plane symmetric frequencies of the cable clamped at both ends [-].

    frequency_parameter : Omega [-], omega*chord*sqrt(linear_density/tension)
    lambda2             : lambda^2 [-]

    Entire in Omega: it has no poles.
    Denominator of eqs (2.32)-(2.34), derivations/cable_dsm.py.
    """
    t0 = (1/4)*frequency_parameter**2
    return (1/4)*lambda2*sinc_cos_gap(t0) + cos_of_square(t0)

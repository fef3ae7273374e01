"""GENERATED FILE - do not edit.

Regenerate : python -m derivations
Source     : x
Made with  : sympy 1.14.0; 82 operations after cse
"""

from typing import Any

import numpy as np

from cdpr_struct.generated.special_functions import asinhc, cos_of_square, sinc_cos_gap, sinc_of_square


def dynamic_stiffness(omega_c_squared: Any, chord: Any, tension: Any, axial_stiffness: Any, effective_length: Any, linear_density: Any, perpendicular_weight: Any) -> Any:
    """(k_xx, k_xz, k_yy, k_zz) [N/m], chord frame, x from B to C, z perpendicular and up.

    omega_c_squared      : [rad^2/s^2] real, or complex with damping (damped_omega_squared)
    chord                : l_c [m]
    tension              : tau [N], static tension where the cable is parallel to its chord
    axial_stiffness      : EA [N]
    effective_length     : L_e [m]
    linear_density       : rho [kg/m]
    perpendicular_weight : rho g cos(alpha) [N/m], weight component across the chord

    s
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
    """r

    chord                : l_c [m]
    tension              : tau [N], static tension where the cable is parallel to its chord
    axial_stiffness      : EA [N]
    effective_length     : L_e [m]
    perpendicular_weight : rho g cos(alpha) [N/m], weight component across the chord

    s
    """
    return axial_stiffness*chord**3*perpendicular_weight**2/(effective_length*tension**3)


def epsilon(chord: Any, tension: Any, perpendicular_weight: Any) -> Any:
    """r

    chord                : l_c [m]
    tension              : tau [N], static tension where the cable is parallel to its chord
    perpendicular_weight : rho g cos(alpha) [N/m], weight component across the chord

    s
    """
    return chord*perpendicular_weight/tension


def effective_length_integral(chord: Any, epsilon: Any) -> Any:
    """r

    chord   : l_c [m]
    epsilon : [-] perpendicular_weight*chord/tension

    s
    """
    t0 = epsilon**2
    return (1/8)*chord*(np.sqrt((1/4)*t0 + 1)*((1/2)*t0 + 5) + 3*asinhc((1/2)*epsilon))


def effective_length_approximation(chord: Any, epsilon: Any) -> Any:
    """r

    chord   : l_c [m]
    epsilon : [-] perpendicular_weight*chord/tension

    s
    """
    return chord*((1/8)*epsilon**2 + 1)


def damped_omega_squared(omega: Any, damping_ratio: Any, reference_omega: Any) -> Any:
    """r

    omega           : [rad/s]
    damping_ratio   : xi [-], referred to reference_omega
    reference_omega : omega_1 [rad/s], first natural frequency of the cable

    s
    """
    return -2*1j*damping_ratio*omega*reference_omega + omega**2


def clamped_frequency_function(frequency_parameter: Any, lambda2: Any) -> Any:
    """r

    frequency_parameter : Omega [-], omega*chord*sqrt(linear_density/tension)
    lambda2             : lambda^2 [-]

    s
    """
    t0 = (1/4)*frequency_parameter**2
    return (1/4)*lambda2*sinc_cos_gap(t0) + cos_of_square(t0)

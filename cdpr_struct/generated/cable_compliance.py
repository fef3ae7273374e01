"""GENERATED FILE - do not edit.

Regenerate : python -m cdpr_struct.derivations
Source     : derivations/cable_compliance.py, eqs (2.24)-(2.29)
Made with  : sympy 1.14.0; 159 operations after cse
"""

from typing import Any

import numpy as np

from cdpr_struct.generated.special_functions import atanhc, tanh_remainder, tanhc


def compliance(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """(c_axial, c_xx_sag, c_xz_sag, c_zz_sag) [m/N]; c_axial belongs on both diagonal places.

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Where force_x = 0 and the vertical end forces differ in sign, the true c_xx is infinite.
    Eqs (2.24)-(2.28), derivations/cable_compliance.py.
    """
    t0 = force_x**2
    t1 = np.sqrt(force_z**2 + t0)
    t2 = length*weight
    t3 = -t2
    t4 = force_z + t3
    t5 = np.sqrt(t0 + t4**2)
    t6 = t1 + t5
    t7 = 1/(t6)
    t8 = t2*t7
    t9 = atanhc(t8, t7*(t0/(t5 + abs(t4)) + t0/(t1 + abs(force_z)) + 2*np.maximum(-force_z, np.maximum(0, t4))))
    t10 = 2*t9
    t11 = t10*t8
    t12 = force_z*t4
    t13 = 1/(t1*t5)
    t14 = length*t13
    t15 = t0 + t1*t5 + abs(t12)
    return length/axial_stiffness, length*t10*t7*(4*length**2*t9**2*weight**2*tanh_remainder(t11)/t6**2 + t12*t13*tanhc(t11)), -force_x*t14*t7*(2*force_z + t3), t14*np.where(t12 > 0, t0*t6/t15, t15*t7)


def stiffness(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """(k_xx, k_xz, k_zz) [N/m], change of the force at C with its displacement; x, z as force_x, force_z.

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Where force_x = 0 and the vertical end forces differ in sign, the true c_xx is infinite.
    The determinant is a sum of positive terms.
    Eq. (2.29) corrected, derivations/cable_compliance.py.
    """
    t0 = length/axial_stiffness
    t1 = force_x**2
    t2 = np.sqrt(force_z**2 + t1)
    t3 = length*weight
    t4 = -t3
    t5 = force_z + t4
    t6 = np.sqrt(t1 + t5**2)
    t7 = t2 + t6
    t8 = force_z*t5
    t9 = t1 + t2*t6 + abs(t8)
    t10 = 1/(t7)
    t11 = np.where(t8 > 0, t1*t7/t9, t10*t9)
    t12 = 1/(t2*t6)
    t13 = length*t12
    t14 = t11*t13
    t15 = length**2
    t16 = weight**2
    t17 = t10*t3
    t18 = atanhc(t17, t10*(t1/(t6 + abs(t5)) + t1/(t2 + abs(force_z)) + 2*np.maximum(-force_z, np.maximum(0, t5))))
    t19 = t17*t18
    t20 = 2*t19
    t21 = 2*length*t10*t18*(t12*t8*tanhc(t20) + 4*t15*t16*t18**2*tanh_remainder(t20)/t7**2)
    t22 = 1/(2*length**4*t11*t12*t16*t18**3*tanh_remainder(t19)/t7**3 + t0*(t14 + t21) + t15/axial_stiffness**2)
    return t22*(t0 + t14), force_x*t10*t13*t22*(2*force_z + t4), t22*(t0 + t21)

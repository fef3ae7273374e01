"""GENERATED FILE - do not edit.

Regenerate : python -m cdpr_struct.derivations
Source     : derivations/catenary.py, eqs (2.1)-(2.22)
Made with  : sympy 1.14.0; 335 operations after cse
"""

from typing import Any

import numpy as np

from cdpr_struct.generated.special_functions import atanhc, atanhc_remainder


def end_point(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """Coordinates (x, z) of C from B [m]; x along force_x > 0, z up.

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Eqs (2.11)-(2.12), derivations/catenary.py.
    """
    t0 = 1/(axial_stiffness)
    t1 = force_x**2
    t2 = np.sqrt(force_z**2 + t1)
    t3 = length*weight
    t4 = -t3
    t5 = force_z + t4
    t6 = np.sqrt(t1 + t5**2)
    t7 = 1/(t2 + t6)
    return force_x*(length*t0 + 2*length*t7*atanhc(t3*t7, t7*(t1/(t6 + abs(t5)) + t1/(t2 + abs(force_z)) + 2*np.maximum(-force_z, np.maximum(0, t5))))), length*(2*force_z + t4)*((1/2)*t0 + t7)


def profile(s: Any, force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """Coordinates (x, z) of the cable at s [m], from B; z up.

    s               : [m] unstrained coordinate from B (0) to C (length)
    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Eqs (2.9)-(2.10), derivations/catenary.py.
    """
    t0 = 1/(axial_stiffness)
    t1 = force_x**2
    t2 = length*weight
    t3 = force_z - t2
    t4 = np.sqrt(t1 + t3**2)
    t5 = weight*(length - s)
    t6 = force_z - t5
    t7 = np.sqrt(t1 + t6**2)
    t8 = 1/(t4 + t7)
    t9 = s*t8
    return force_x*(s*t0 + 2*t9*atanhc(t9*weight, t8*(t1/(t7 + abs(t6)) + t1/(t4 + abs(t3)) + 2*np.maximum(-t6, np.maximum(0, t3))))), s*((1/2)*t0 + t8)*(2*force_z - t2 - t5)


def elongation(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """Strained minus unstrained length [m].

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Eqs (2.15)-(2.16), derivations/catenary.py.
    """
    t0 = length*weight
    t1 = -t0
    t2 = force_x**2
    t3 = np.sqrt(force_z**2 + t2)
    t4 = force_z + t1
    t5 = np.sqrt(t2 + t4**2)
    t6 = t3 + t5
    t7 = 1/(t6)
    t8 = length/axial_stiffness
    return t2*t7*t8*atanhc(t0*t7, t7*(t2/(t5 + abs(t4)) + t2/(t3 + abs(force_z)) + 2*np.maximum(-force_z, np.maximum(0, t4)))) + (1/4)*t8*(t6 + t7*(2*force_z + t1)**2)


def chord_tension(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """tau [N], tension where the cable is parallel to its chord.

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Eq. (2.17), derivations/catenary.py.
    """
    t0 = 1/(axial_stiffness)
    t1 = force_x**2
    t2 = np.sqrt(force_z**2 + t1)
    t3 = length*weight
    t4 = -t3
    t5 = force_z + t4
    t6 = np.sqrt(t1 + t5**2)
    t7 = 1/(t2 + t6)
    t8 = length*t0 + 2*length*t7*atanhc(t3*t7, t7*(t1/(t6 + abs(t5)) + t1/(t2 + abs(force_z)) + 2*np.maximum(-force_z, np.maximum(0, t5))))
    return np.sqrt(length**2*(2*force_z + t4)**2*((1/2)*t0 + t7)**2 + t1*t8**2)/t8


def chord_parallel_coordinate(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """s_Q [m], unstrained coordinate where the cable is parallel to its chord.

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Eq. (2.21), derivations/catenary.py.
    """
    t0 = force_x**2
    t1 = np.sqrt(force_z**2 + t0)
    t2 = length*weight
    t3 = force_z - t2
    t4 = np.sqrt(t0 + t3**2)
    t5 = t1 + t4
    t6 = 1/(t5)
    t7 = t2*t6
    t8 = t6*(t0/(t4 + abs(t3)) + t0/(t1 + abs(force_z)) + 2*np.maximum(-force_z, np.maximum(0, t3)))
    return -2*length**3*weight*(force_z - 1/2*length*weight)*atanhc_remainder(t7, t8)/(t5**3*(2*length*t6*atanhc(t7, t8) + length/axial_stiffness)) + (1/2)*length


def sag(force_x: Any, force_z: Any, length: Any, axial_stiffness: Any, weight: Any) -> Any:
    """d [m], sag perpendicular to the chord.

    force_x         : [N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0
    force_z         : [N] vertical force on the cable at C, up; at B it is force_z - weight*length
    length          : [m] unstrained length
    axial_stiffness : EA [N]
    weight          : rho g [N/m], per unstrained length

    Domain: tension > 0 at both ends. weight = 0 and force_x = 0 are limits and allowed.
    Eq. (2.22), derivations/catenary.py.
    """
    t0 = 1/(axial_stiffness)
    t1 = force_x**2
    t2 = force_z**2
    t3 = np.sqrt(t1 + t2)
    t4 = length*weight
    t5 = -t4
    t6 = force_z + t5
    t7 = t6**2
    t8 = np.sqrt(t1 + t7)
    t9 = t3 + t8
    t10 = 1/(t9)
    t11 = t10*t4
    t12 = -force_z
    t13 = t10*(t1/(t8 + abs(t6)) + t1/(t3 + abs(force_z)) + 2*np.maximum(0, np.maximum(t12, t6)))
    t14 = length*t0 + 2*length*t10*atanhc(t11, t13)
    t15 = 2*force_z + t5
    t16 = (1/2)*t0
    t17 = t10 + t16
    t18 = np.sqrt(length**2*t15**2*t17**2 + t1*t14**2)
    t19 = 1/(t14)
    t20 = -length**3*t19*weight*abs(t15)*atanhc_remainder(t11, t13)/t9**3 + (1/2)*length
    t21 = t20*weight
    t22 = t15 >= 0
    t23 = np.sqrt(t1 + np.where(t22, t7, t2))
    t24 = t18*t19
    t25 = t23 + t24
    t26 = 1/(t25)
    t27 = np.where(t22, t6, t12)
    t28 = t19*abs(t15*t17)
    t29 = length*t28
    return t14*t20*(t16*t21 + t26*(2*t20**2*t29*weight**2*atanhc_remainder(t21*t26, t26*(t1/(length*abs(t28) + t24) + t1/(t23 + abs(t27)) + 2*np.maximum(-np.maximum(t27, t29), np.maximum(0, np.minimum(t27, t29)))))/t25**2 + t21))*abs(force_x)/t18

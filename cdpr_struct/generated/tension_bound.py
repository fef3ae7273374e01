"""GENERATED FILE - do not edit.

Regenerate : python -m cdpr_struct.derivations
Source     : derivations/tension_bound.py, eqs (5.10)-(5.16)
Made with  : sympy 1.14.0; 12 operations after cse
"""

from typing import Any

import numpy as np


def lower_bound_printed(b: Any, linear_density: Any, gravity: Any, length: Any) -> Any:
    """f_lb [N, with b taken as a pure number] as printed.

    b              : [rad/s] wanted lowest cable frequency
    linear_density : rho [kg/m]
    gravity        : g [m/s^2]
    length         : [m] unstrained length

    Eq. (5.15) printed, derivations/tension_bound.py.
    """
    return b**2*gravity*length*linear_density/np.pi**2


def lower_bound_frequency(b: Any, linear_density: Any, length: Any) -> Any:
    """f_lb [N] at which the first frequency of the cable is b.

    b              : [rad/s] wanted lowest cable frequency
    linear_density : rho [kg/m]
    length         : [m] unstrained length

    Eq. (5.15) corrected, derivations/tension_bound.py.
    """
    return b**2*length**2*linear_density/np.pi**2

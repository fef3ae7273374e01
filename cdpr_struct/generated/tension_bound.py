"""GENERATED FILE - do not edit.

Regenerate : python -m derivations
Source     : x
Made with  : sympy 1.14.0; 12 operations after cse
"""

from typing import Any

import numpy as np


def lower_bound_printed(b: Any, linear_density: Any, gravity: Any, length: Any) -> Any:
    """r

    b              : [rad/s] wanted lowest cable frequency
    linear_density : rho [kg/m]
    gravity        : g [m/s^2]
    length         : [m] unstrained length

    s
    """
    return b**2*gravity*length*linear_density/np.pi**2


def lower_bound_frequency(b: Any, linear_density: Any, length: Any) -> Any:
    """r

    b              : [rad/s] wanted lowest cable frequency
    linear_density : rho [kg/m]
    length         : [m] unstrained length

    s
    """
    return b**2*length**2*linear_density/np.pi**2

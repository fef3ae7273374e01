"""Dynamic stiffness of the small-sag cable at its moving end C, by solving its linearised motion.

Axes: x along the chord from the fixed end B (x = 0) to C (x = l), z perpendicular to it in the vertical
plane and UP, so the static parabola hangs towards -z: z0 = -(w/(2 tau)) x (l - x), w = rho g cos(alpha).
Start  : ((tau + h)(z0 + v)')' - w = rho d2v/dt2 + damping, linear in v and h; h constant along the cable
         (quasi-static stretching) with h L_e/EA = delta_x + int z0' v' dx.
Arrives: (2.32)-(2.35) with the sign of K_xz for z up, (2.36), and the clamped cable's frequencies.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import sympy as sp

from cdpr_struct.derivations.proof import require_same, require_zero_rational
from cdpr_struct.derivations.special_functions import cos_of_square, sinc_cos_gap, sinc_of_square
from cdpr_struct.derivations.symbols import (
    axial_stiffness,
    chord,
    effective_length,
    linear_density,
    omega_c_squared,
    tension,
)
from cdpr_struct.derivations.symbols import perpendicular_weight as w

X = sp.Symbol("x", real=True)
Y = sp.Symbol("y", positive=True)
"""Half of Omega_c."""
_T = sp.Symbol("t", positive=True)
_H, _DX, _DZ = sp.symbols("h delta_x delta_z", real=True)
STATIC_PROFILE = -w / (2 * tension) * X * (chord - X)
FREQUENCY = 2 * Y / chord * sp.sqrt(tension / linear_density)
"""omega_c in terms of y: Omega_c = 2 y, eq. (2.39)."""


def linearised_equation(v: Any) -> Any:
    """tau v'' + h z0'' + rho omega_c^2 v (to be 0), the vertical equilibrium expanded to first order."""
    small = sp.Symbol("small")
    slope = sp.diff(STATIC_PROFILE + small * v, X)
    equilibrium = sp.diff((tension + small * _H) * slope, X) - w
    require_same("the static profile is in equilibrium", equilibrium.subs(small, 0).doit(), 0)
    first_order = sp.diff(equilibrium, small).subs(small, 0).doit()
    return sp.expand(first_order + linear_density * FREQUENCY**2 * v)


def in_plane_shape() -> Any:
    """v(x) for given h, with v(0) = 0 and v(l) = delta_z."""
    v = sp.Function("v")
    k = 2 * Y / chord
    equation = linearised_equation(v(X))
    a, c = sp.symbols("a c")
    particular = sp.solve(equation.subs(v(X), a).doit(), a)[0]
    general = particular + a * sp.sin(k * X) + c * sp.cos(k * X)
    constants = sp.solve([general.subs(X, 0), general.subs(X, chord) - _DZ], [a, c], dict=True)[0]
    shape = general.subs(constants)
    require_same("equation of motion", sp.simplify(linearised_equation(shape)), 0)
    return shape


@lru_cache(maxsize=1)
def in_plane_stiffness() -> Any:
    """Matrix from (delta_x, delta_z) to the forces (f_x, f_z) on the cable end C [N/m], in y."""
    shape = in_plane_shape()
    slope = sp.diff(STATIC_PROFILE, X)
    stretch = _DX + sp.integrate(sp.expand(slope * sp.diff(shape, X)), (X, 0, chord))
    h = sp.solve(_H * effective_length / axial_stiffness - stretch, _H)[0]
    f_z = (tension * sp.diff(shape, X) + _H * slope).subs(X, chord).subs(_H, h)
    return sp.Matrix([h, f_z]).jacobian([_DX, _DZ])


def out_of_plane_stiffness() -> Any:
    """K_yy of the taut string tau v'' + rho omega_c^2 v = 0 [N/m], in y."""
    k = 2 * Y / chord
    v = _DZ * sp.sin(k * X) / sp.sin(k * chord)
    require_same("string equation", tension * sp.diff(v, X, 2) + linear_density * FREQUENCY**2 * v, 0)
    return (tension * sp.diff(v, X) / _DZ).subs(X, chord)


def half_angle(expression: Any) -> Any:
    """Rational form: sin, cos and tan of y and 2 y written with t = tan(y/2)."""
    sine, cosine = 2 * _T / (1 + _T**2), (1 - _T**2) / (1 + _T**2)
    values = {
        sp.sin(2 * Y): 2 * sine * cosine,
        sp.cos(2 * Y): cosine**2 - sine**2,
        sp.sin(Y): sine,
        sp.cos(Y): cosine,
        sp.tan(Y): sine / cosine,
    }
    return sp.sympify(expression).subs(values)


def equal(left: Any, right: Any) -> bool:
    """True when two forms in y agree identically (polynomial algebra in t = tan(y/2))."""
    return bool(sp.cancel(sp.together(half_angle(left) - half_angle(right))) == 0)


def irvine_parameter() -> Any:
    """lambda^2, read off the derived K_xx = (EA/L_e)/(1 + lambda^2/Omega_c^2 (kappa - 1))."""
    kappa = sp.tan(Y) / Y
    ratio = axial_stiffness / effective_length / in_plane_stiffness()[0, 0]
    return sp.cancel(sp.together(half_angle((ratio - 1) * (2 * Y) ** 2 / (kappa - 1))))


def printed_stiffness() -> dict[str, Any]:
    """Eqs (2.32)-(2.35) as printed, in y, with lambda^2 and epsilon of eqs (2.36)-(2.37)."""
    eps = w * chord / tension
    lam = eps**2 * axial_stiffness * chord / (tension * effective_length)
    return printed_forms(eps, lam, axial_stiffness / effective_length, tension / chord)


def printed_forms(eps: Any, lam: Any, axial: Any, transverse: Any) -> dict[str, Any]:
    """The printed expressions for any way of writing epsilon, lambda^2, EA/L_e and tau/l_c."""
    kappa, big = sp.tan(Y) / Y, 2 * Y
    bracket = 1 + lam / big**2 * (kappa - 1)
    second = eps**2 / lam * big**2 / 4 * (kappa + lam / big**2 * (kappa - 1)) / bracket
    return {
        "k_xx": axial / bracket,
        "k_xz": axial * eps / 2 * (kappa - 1) / bracket,
        "k_zz": axial * eps**2 / lam / kappa - axial * second,
        "k_yy": transverse * (4 - kappa**2 * big**2) / (4 * kappa),
    }


@lru_cache(maxsize=1)
def derived_stiffness() -> dict[str, Any]:
    """The solution of the boundary value problem, by name, in y."""
    matrix = in_plane_stiffness()
    if not equal(matrix[0, 1], matrix[1, 0]):
        raise ArithmeticError("the dynamic stiffness is not symmetric")
    return {
        "k_xx": matrix[0, 0],
        "k_xz": matrix[0, 1],
        "k_zz": matrix[1, 1],
        "k_yy": out_of_plane_stiffness(),
    }


def in_half_frequency(stable: Any) -> Any:
    """A stable form of cable_dsm_stable.py as a function of y."""
    expression = sp.sympify(stable).subs(omega_c_squared, FREQUENCY**2)
    expression = expression.replace(cos_of_square, lambda square: sp.cos(Y))
    expression = expression.replace(sinc_of_square, lambda square: sp.sin(Y) / Y)
    return expression.replace(sinc_cos_gap, lambda square: (sp.sin(Y) / Y - sp.cos(Y)) / Y**2)


def prove_stable_forms(stable: dict[str, Any]) -> None:
    """The stable forms equal the derived ones."""
    for name, derived in derived_stiffness().items():
        difference = half_angle(in_half_frequency(stable[name])) - half_angle(derived)
        require_zero_rational(f"stable {name}", difference)

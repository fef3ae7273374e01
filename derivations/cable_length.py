"""The cable length parameter L_e of the small-sag cable and the ratio epsilon, from the parabola.

Start  : z0' = epsilon (x/l - 1/2), the slope of the parabola of cable_dsm.py.
Arrives: epsilon = 8 d/l (2.37), the two lines of (2.41), L_e = int (ds/dx)^3 dx and its approximation.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations.cable_dsm import STATIC_PROFILE, X
from cdpr_struct.derivations.cable_dsm_stable import effective_length_integral as stable_length
from cdpr_struct.derivations.proof import require_same, verdict
from cdpr_struct.derivations.records import FormulaRecord
from cdpr_struct.derivations.special_functions import expand_definitions
from cdpr_struct.derivations.symbols import chord, epsilon, tension
from cdpr_struct.derivations.symbols import perpendicular_weight as w


def sag_over_chord() -> Any:
    """d/l in terms of epsilon, the lowest point of the parabola."""
    sag = -STATIC_PROFILE.subs(X, chord / 2)
    return sp.simplify((sag / chord).subs(w, epsilon * tension / chord))


def slope() -> Any:
    """z0' in terms of epsilon."""
    return sp.expand(sp.diff(STATIC_PROFILE, X).subs(w, epsilon * tension / chord))


def effective_length_integral() -> Any:
    """L_e = int_0^l (1 + z0'^2)^(3/2) dx [m], by the substitution u = z0'."""
    u, a = sp.Symbol("u", real=True), sp.Symbol("a", positive=True)
    root = sp.sqrt(1 + u**2)
    primitive = u * root**3 / 4 + 3 * (u * root + sp.asinh(u)) / 8
    require_same("primitive of (1 + u^2)^(3/2)", sp.simplify(sp.diff(primitive, u) - root**3), 0)
    require_same("end slopes", (slope().subs(X, 0), slope().subs(X, chord)), (-epsilon / 2, epsilon / 2))
    over_slope = primitive.subs(u, a) - primitive.subs(u, -a)
    return (over_slope * chord / (2 * a)).subs(a, epsilon / 2)


def effective_length_approximation() -> Any:
    """int (1 + 3/2 z0'^2) dx [m]: the integrand to second order in the slope."""
    size = sp.Symbol("size", positive=True)
    integrand = sp.series((1 + size**2) ** sp.Rational(3, 2), size, 0, 4).removeO().subs(size, slope())
    return sp.integrate(sp.expand(integrand), (X, 0, chord))


def formulas() -> tuple[FormulaRecord, ...]:
    """Eqs (2.37), (2.41) and the length parameter of section 2.2.2."""
    d = sp.Symbol("d", positive=True)
    eps_of_sag = sp.solve(sp.Eq(sag_over_chord(), d / chord), epsilon)[0]
    exact = effective_length_integral()
    require_same("stable length", _positive(expand_definitions(stable_length())), _positive(exact))
    approximation = sp.expand(effective_length_approximation().subs(epsilon, eps_of_sag))
    printed = chord * (1 + 8 * (d / chord) ** 2)
    note = "To second order in d/l; the generated code also has the closed form of the integral."
    return (
        verdict("cable_dsm.epsilon", "2.37", 8 * d / chord, eps_of_sag, left=r"\varepsilon"),
        verdict("cable_dsm.effective_length", "2.2.2, L_e", printed, approximation, note, left=r"L_e \simeq"),
        *_limits(*(eps_of_sag.subs(d, chord / n) for n in (80, 33))),
    )


def _limits(steep: Any, flat: Any) -> tuple[FormulaRecord, ...]:
    """Eq. (2.41): epsilon that belongs to the printed d/l."""
    note = (
        "epsilon = 8 d/l, so d/l <= 1/80 means epsilon <= 0.1; the print has 0.01. Section 2.3.2 itself "
        "accepts epsilon = 0.061 at alpha = 46.8 deg."
    )
    left = r"\varepsilon_{max}(d/l_c = 1/%d)"
    two_digits = sp.Rational(round(100 * flat), 100)
    rounded = "8/33 = 0.2424, printed with two digits."
    return (
        verdict("cable_dsm.limit_steep", "2.41, first line", sp.Float("0.01", 2), steep, note, left % 80),
        verdict("cable_dsm.limit_flat", "2.41, second line", sp.Rational(24, 100), two_digits, rounded, left % 33),
    )


def _positive(expression: Any) -> Any:
    return sp.expand(sp.sympify(expression).subs(epsilon, sp.Symbol("e", positive=True)))

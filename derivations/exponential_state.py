"""Proof parameters of the catenary in which all its closed forms are rational functions.

With E = exp(asinh(V/fx)) at each point and fx > 0:  V = fx (E - 1/E)/2 and T = fx (E + 1/E)/2. The only
transcendental quantity left is U = asinh(V1/fx) - asinh(V0/fx) = log(E1/E0). An identity between two closed
forms is then an identity of rational functions, which polynomial algebra decides. x is odd and z, tau, d
are even in fx, which covers fx < 0.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations.catenary_stable import Segment, complement
from cdpr_struct.derivations.proof import require_zero_rational
from cdpr_struct.derivations.special_functions import atanhc, atanhc_remainder, tanh_remainder, tanhc
from cdpr_struct.derivations.symbols import axial_stiffness, force_z, length, weight

FX, W, EA = sp.symbols("f_x w EA", positive=True)
E0, E1 = sp.symbols("E_0 E_1", positive=True)
U = sp.Symbol("U", real=True)
V0, V1 = sp.symbols("V_0 V_1", real=True)
T0, T1 = sp.symbols("T_0 T_1", positive=True)


def vertical(E: Any) -> Any:
    """V in terms of E."""
    return FX * (E - 1 / E) / 2


def tension(E: Any) -> Any:
    """T in terms of E."""
    return FX * (E + 1 / E) / 2


VALUES = {V0: vertical(E0), V1: vertical(E1), T0: tension(E0), T1: tension(E1)}


def symbolic_segment() -> Segment:
    """Segment in V0, V1, T0, T1 as independent symbols; w L = V1 - V0."""
    q = (V1 - V0) / (T0 + T1)
    return Segment(FX, W, (V1 - V0) / W, EA, V0, V1, T0, T1, q, 1 - q)


def rational(expression: Any) -> Any:
    """Rewrite a stable form as a rational function of E0, E1, fx, w, EA and U."""
    expression = expression.replace(atanhc, lambda q, p: U / (2 * q))
    expression = expression.replace(atanhc_remainder, lambda q, p: (U / (2 * q) - 1) / q**2)
    expression = expression.replace(tanhc, lambda u: _tanh(u) / u)
    expression = expression.replace(tanh_remainder, lambda u: (u - _tanh(u)) / u**3)
    return expression.subs(VALUES)


def raw(expression: Any, horizontal: Any) -> Any:
    """Rewrite a raw closed form in force_z, weight, length and `horizontal` > 0 the same way.

    asinh(V1/fx) becomes asinh(V0/fx) + U, both roots become tensions.
    """
    values = {horizontal: FX, force_z: V1, weight: W, length: (V1 - V0) / W, axial_stiffness: EA}
    expression = sp.sympify(expression).subs(values, simultaneous=True)
    lower = sp.Symbol("U_0", real=True)
    for force, tension_symbol, angle in ((V0, T0, lower), (V1, T1, lower + U)):
        expression = expression.subs(sp.asinh(force / FX), angle)
        expression = expression.subs(sp.sqrt(FX**2 + force**2), tension_symbol)
        expression = expression.subs(sp.sqrt(1 + force**2 / FX**2), tension_symbol / FX)
    return expression.subs(VALUES)


def _tanh(u: Any) -> Any:
    """tanh of U or U/2, with exp(U) = E1/E0."""
    multiple = sp.cancel(sp.together(u.subs(VALUES)) / U)
    ratio = {sp.Integer(1): (E1 / E0) ** 2, sp.Rational(1, 2): E1 / E0}[multiple]
    return (ratio - 1) / (ratio + 1)


def prove_addition_theorem() -> None:
    """exp(2 atanh q) = (1 + q)/(1 - q) is E1/E0, so 2 atanh(q) = U."""
    q = symbolic_segment().q.subs(VALUES)
    require_zero_rational("2 atanh(wL/(T0+T1)) = asinh(V1/fx) - asinh(V0/fx)", (1 + q) / (1 - q) - E1 / E0)


def prove_complement() -> None:
    """The positive sum for 1 - q, for both forces up, of opposite sign, both down."""
    a, d = sp.Symbol("a", positive=True), sp.Symbol("d", positive=True)
    cases = {"up": (a, a + d), "opposite": (-a, d), "down": (-a - d, -a)}
    for name, (low, high) in cases.items():
        positive_sum = complement(FX, low, high, T0, T1)
        at = sp.solve([low - V0, high - V1], [a, d], dict=True)[0]
        direct = 1 - (V1 - V0) / (T0 + T1)
        require_zero_rational(f"1 - q, {name}", (positive_sum.subs(at) - direct).subs(VALUES))


def branch(expression: Any, same_sign: bool) -> Any:
    """Take one branch of a Piecewise in the sign of V0 V1 and resolve |V0 V1| accordingly."""
    sign = 1 if same_sign else -1
    expression = expression.replace(sp.Piecewise, lambda *pairs: pairs[0 if same_sign else 1][0])
    return expression.subs(sp.Abs(V0) * sp.Abs(V1), sign * V0 * V1).subs(sp.Abs(V0 * V1), sign * V0 * V1)

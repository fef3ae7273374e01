"""Static elastic catenary: from equilibrium and Hooke's law to end point, elongation, tau, s_Q, sag.

Start  : eqs (2.1)-(2.4). Boundary: x(0) = z(0) = 0 at the fixed end B.
Arrives: (2.7)-(2.12), (2.16), (2.17), (2.21), (2.22), and proves catenary_stable.py equal.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import sympy as sp

from cdpr_struct.derivations import catenary_stable as stable
from cdpr_struct.derivations import exponential_state as state
from cdpr_struct.derivations.proof import require_same, require_zero_rational, verdict
from cdpr_struct.derivations.records import FormulaRecord, GeneratedFunction
from cdpr_struct.derivations.symbols import axial_stiffness, force_x, force_z, length, s, weight

SOURCE = "derivations/catenary.py, eqs (2.1)-(2.22)"
ARGUMENTS = (force_x, force_z, length, axial_stiffness, weight)
_V = sp.Symbol("V", real=True)
_H = sp.Symbol("H", positive=True)
_STRETCH = sp.Symbol("dp_ds", positive=True)
_BOTTOM = force_z - weight * length


def vertical_force(at: Any) -> Any:
    """f_Pz of eq. (2.3)."""
    return force_z - weight * (length - at)


def slopes() -> tuple[Any, Any, Any]:
    """dx/ds, dz/ds, dp/ds as functions of the vertical force V, from eqs (2.1)-(2.4)."""
    f = sp.Symbol("f", positive=True)
    dx_dp, dz_dp = force_x / f, _V / f
    tension = sp.sqrt(force_x**2 + _V**2)
    require_same("eq. (2.5)", (dx_dp**2 + dz_dp**2 - 1).subs(f, tension), 0)
    dp_ds = sp.solve(sp.Eq(f, axial_stiffness * (_STRETCH - 1)), _STRETCH)[0]
    x, z, p = (sp.expand((slope * dp_ds).subs(f, tension)) for slope in (dx_dp, dz_dp, sp.Integer(1)))
    return x, z, p


@lru_cache(maxsize=1)
def antiderivatives() -> tuple[Any, Any, Any]:
    """int (dx/ds, dz/ds, dp/ds) ds with ds = dV/weight, as functions of V, for both signs of force_x."""
    positive = [sp.integrate(sp.expand(slope.subs(force_x, _H)), _V) / weight for slope in slopes()]
    for slope, primitive in zip(slopes(), positive, strict=True):
        require_same("antiderivative", sp.diff(primitive, _V) * weight, slope.subs(force_x, _H))
    x, z, p = (primitive.subs(_H, sp.Abs(force_x)) for primitive in positive)
    return sp.sign(force_x) * x, z, p


def between(primitive: Any, lower: Any, upper: Any) -> Any:
    """Definite integral between two vertical forces."""
    return primitive.subs(_V, upper) - primitive.subs(_V, lower)


def profile() -> tuple[Any, Any]:
    """x(s), z(s) [m]."""
    x, z, _ = antiderivatives()
    return between(x, _BOTTOM, vertical_force(s)), between(z, _BOTTOM, vertical_force(s))


def end_point() -> tuple[Any, Any]:
    """x_C, z_C [m]."""
    x, z = profile()
    return x.subs(s, length), z.subs(s, length)


def elongation() -> Any:
    """int (dp/ds - 1) ds [m]."""
    return between(antiderivatives()[2], _BOTTOM, force_z) - length


def parallel_point(x: Any, z: Any) -> Any:
    """s_Q where the force is parallel to the chord (x, z): eqs (2.18)-(2.20) solved."""
    at = sp.Symbol("s_Q", real=True)
    xs, zs = sp.symbols("x_C z_C", real=True, nonzero=True)
    solution = sp.solve(sp.Eq(vertical_force(at) * xs, force_x * zs), at)[0]
    return solution.subs({xs: x, zs: z}, simultaneous=True)


def printed_profile(at: Any) -> tuple[Any, Any]:
    """Eqs (2.9), (2.10) as printed."""
    here, below = vertical_force(at), _BOTTOM
    x = force_x * at / axial_stiffness
    x += sp.Abs(force_x) / weight * (sp.asinh(here / force_x) - sp.asinh(below / force_x))
    z = force_z * at / axial_stiffness + weight / axial_stiffness * (at**2 / 2 - length * at)
    z += (sp.sqrt(force_x**2 + here**2) - sp.sqrt(force_x**2 + below**2)) / weight
    return x, z


def signed(expression: Any, sign: int) -> Any:
    """The expression for force_x = sign*H with H > 0."""
    return sp.sympify(expression).subs(force_x, sign * _H)


def formulas() -> tuple[FormulaRecord, ...]:
    """Eqs (2.7)-(2.22) against the derivation."""
    prove_stable_forms()
    return (*_profile_formulas(), *_parameter_formulas())


def _both_signs(expressions: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(signed(e, sign) for sign in (1, -1) for e in expressions)


def _profile_formulas() -> tuple[FormulaRecord, ...]:
    x_s, z_s, _ = (slope.subs(_V, vertical_force(s)) for slope in slopes())
    root = sp.sqrt(force_x**2 + vertical_force(s) ** 2)
    printed_x = force_x / axial_stiffness + force_x / root
    printed_z = vertical_force(s) / axial_stiffness + vertical_force(s) / root
    both = [("profile", "2.9-2.10", printed_profile(s), profile())]
    both += [("end_point", "2.11-2.12", printed_profile(length), end_point())]
    for name, _, printed, derived in both:
        require_same(f"{name}, both signs of force_x", _both_signs(printed), _both_signs(derived))
    positive = {name: (signed_pair(p), signed_pair(d)) for name, _, p, d in both}
    return (
        verdict("catenary.slope_x", "2.7", printed_x, x_s, left=r"\frac{dx}{ds}"),
        verdict("catenary.slope_z", "2.8", printed_z, z_s, left=r"\frac{dz}{ds}"),
        *(
            verdict(
                f"catenary.{name}",
                equation,
                positive[name][0],
                tuple(tidy(form) for form in positive[name][1]),
                left=r"\begin{bmatrix}x\\z\end{bmatrix}",
                note="Shown for f_Cx = H > 0; compared for both signs.",
            )
            for name, equation, _, _ in both
        ),
    )


def tidy(expression: Any) -> Any:
    """The same expression with its inextensible part first and its part in 1/EA behind."""
    flexibility = sp.Symbol("flexibility", positive=True)
    linear = expression.subs(axial_stiffness, 1 / flexibility)
    elastic = sp.factor(sp.simplify(sp.diff(linear, flexibility)))
    return _common_roots(sp.factor_terms(linear.subs(flexibility, 0))) + elastic / axial_stiffness


def _common_roots(expression: Any) -> Any:
    """1/sqrt(1 + V^2/H^2) as H/sqrt(H^2 + V^2)."""
    return expression.replace(
        lambda e: e.is_Pow and e.exp == -sp.Rational(1, 2) and e.base.is_Add,
        lambda e: _H / sp.sqrt(sp.expand(_H**2 * (e.base - 1)) + _H**2) if e.base.has(1 / _H**2) else e,
    )


def signed_pair(pair: tuple[Any, ...]) -> tuple[Any, ...]:
    """A tuple of expressions for force_x = H > 0."""
    return tuple(signed(e, 1) for e in pair)


def _parameter_formulas() -> tuple[FormulaRecord, ...]:
    x, z, xq, zq = sp.symbols("x_C z_C x_Q z_Q", real=True, nonzero=True)
    chord = sp.sqrt(x**2 + z**2)
    derived_sq = parallel_point(x, z)
    printed_sq = (force_x * z - force_z * x) / (weight * x) + length
    vertical_at_q = vertical_force(derived_sq)
    tau = sp.sqrt(force_x**2 + vertical_at_q**2)
    normal = sp.Matrix([z, -x]) / chord
    dx_ds, dz_ds, dp_ds = slopes()
    stretch = sp.simplify(sp.sqrt(sp.factor(dx_ds**2 + dz_ds**2)))
    return (
        verdict("catenary.strained_length", "2.15", stretch, dp_ds, left=r"\frac{dp}{ds}"),
        verdict(
            "catenary.chord_tension",
            "2.17",
            sp.Abs(force_x * chord / x),
            tau,
            left=r"\tau",
            note="f_Cx and x_C have the same sign, so the print needs no absolute value.",
        ),
        verdict("catenary.chord_parallel_coordinate", "2.21", printed_sq, derived_sq, left="s_Q"),
        verdict(
            "catenary.sag",
            "2.22",
            sp.Abs(z * xq - x * zq) / chord,
            sp.Abs(normal.dot(sp.Matrix([xq, zq]))),
            left="d",
        ),
    )


def prove_stable_forms() -> None:
    """Every formula of catenary_stable.py equals the raw closed form (rational identities)."""
    state.prove_addition_theorem()
    state.prove_complement()
    c = state.symbolic_segment()
    x_raw, z_raw, stretch = (state.raw(signed(form, 1), _H) for form in (*end_point(), elongation()))
    slope = sp.cancel(z_raw) / sp.cancel(x_raw)
    x, z = stable.end_point(c)
    for name, form, reference in (
        ("x", x, x_raw),
        ("z", z, z_raw),
        ("elongation", stable.elongation(c), stretch),
        ("tau^2", stable.chord_tension(c) ** 2, c.fx**2 * (1 + slope**2)),
        ("s_Q", stable.chord_parallel_coordinate(c), c.L + (c.fx * slope - c.V1) / c.w),
    ):
        require_zero_rational(name, state.rational(form) - sp.sympify(reference).subs(state.VALUES))
    _prove_sag_of_side()


def _prove_sag_of_side() -> None:
    """The sag from the lower end, and by the mirror image V -> -V from the upper one.

    The piece from B (index 0) to Q (index 1) of the symbolic segment; the chord direction is (fx, VQ)/tau.
    """
    c = state.symbolic_segment()
    x, z = stable.end_point(c)
    distance = (c.V1 / c.fx * x - z) * c.fx / c.T1
    stable_form = stable.sag_of_side(c.fx, c.w, c.EA, c.L, c.T1, c.T0, c.V1, c.p)
    require_zero_rational("sag from B", state.rational(distance) - state.rational(stable_form))


def functions() -> tuple[GeneratedFunction, ...]:
    """What cdpr_struct/generated/catenary.py holds."""
    cable = stable.whole_cable()
    piece = stable.segment(force_x, weight, s, axial_stiffness, _BOTTOM, vertical_force(s))
    x, z = end_point()
    s_q = parallel_point(x, z)
    xq, zq = (coordinate.subs(s, s_q) for coordinate in profile())
    chord = sp.sqrt(x**2 + z**2)
    tau = sp.Abs(force_x) * chord / sp.Abs(x)
    five = ARGUMENTS
    return (
        GeneratedFunction("end_point", five, stable.end_point(cable), (x, z)),
        GeneratedFunction("profile", (s, *five), stable.end_point(piece), profile()),
        GeneratedFunction("elongation", five, (stable.elongation(cable),), (elongation(),)),
        GeneratedFunction("chord_tension", five, (stable.chord_tension(cable),), (tau,)),
        GeneratedFunction("chord_parallel_coordinate", five, (stable.chord_parallel_coordinate(cable),), (s_q,)),
        GeneratedFunction("sag", five, (stable.sag(cable),), (sp.Abs(z * xq - x * zq) / chord,)),
    )

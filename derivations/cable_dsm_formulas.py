"""Verdicts on eqs (2.32)-(2.46) and the functions of cdpr_struct/generated/cable_dsm.py."""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations import cable_dsm, cable_length
from cdpr_struct.derivations import cable_dsm_stable as stable
from cdpr_struct.derivations.cable_dsm import Y
from cdpr_struct.derivations.proof import require_same, tex, verdict
from cdpr_struct.derivations.records import FormulaRecord, GeneratedFunction
from cdpr_struct.derivations.symbols import (
    axial_stiffness,
    chord,
    damping_ratio,
    effective_length,
    epsilon,
    frequency_parameter,
    lambda2,
    linear_density,
    omega,
    omega_c_squared,
    perpendicular_weight,
    reference_omega,
    tension,
)

SOURCE = "derivations/cable_dsm.py, eqs (2.31)-(2.41)"
_NAMES = ("k_xx", "k_xz", "k_yy", "k_zz")
_EQUATIONS = {"k_xx": "2.32", "k_xz": "2.33", "k_yy": "2.35", "k_zz": "2.34"}
_XZ_NOTE = (
    "With x from B to C and z UP, as in section 2.2.3 and fig. 2.3 (z of the global frame upward), the "
    "derivation gives the opposite sign: f_z = tau v'(l) + h z0'(l) with z0'(l) = +epsilon/2. The "
    "printed sign "
    "belongs to z pointing down, towards the sag (Irvine's axes), or to x from C to B. K_xz vanishes at "
    "omega = 0, so no static check can show it; frequencies of the robot do."
)


def _shown_forms() -> dict[str, Any]:
    """Printed forms in epsilon, lambda^2, EA/L_e, tau/l_c and Omega_c, for LaTeX."""
    forms = cable_dsm.printed_forms(epsilon, lambda2, axial_stiffness / effective_length, tension / chord)
    return {name: form.subs(Y, sp.Symbol("Omega_c", positive=True) / 2) for name, form in forms.items()}


def _stiffness_formulas() -> list[FormulaRecord]:
    derived, printed, shown = cable_dsm.derived_stiffness(), cable_dsm.printed_stiffness(), _shown_forms()
    records = []
    for name in _NAMES:
        agrees = cable_dsm.equal(printed[name], derived[name])
        if not agrees and not cable_dsm.equal(-printed[name], derived[name]):
            raise ArithmeticError(f"{name}: the derivation gives neither the print nor its negative")
        left = f"K_{{{name[2:]}}} = "
        right = shown[name] if agrees else -shown[name]
        status, note = ("verified", "") if agrees else ("corrected", _XZ_NOTE)
        records.append(
            FormulaRecord(
                f"cable_dsm.{name}",
                _EQUATIONS[name],
                status,
                note,
                left + tex(shown[name]),
                left + tex(right),
            )
        )
    return records


def clamped_equation() -> FormulaRecord:
    """Irvine's frequency equation as the zero of the denominator of the dynamic stiffness."""
    printed = sp.tan(Y) - Y + 4 / lambda2 * Y**3
    denominator = cable_dsm.in_half_frequency(stable.clamped_denominator(omega_c_squared, lambda2))
    derived = sp.expand(denominator * 4 * Y**3 / (lambda2 * sp.cos(Y)))
    if not cable_dsm.equal(printed, derived):
        raise ArithmeticError("the clamped cable does not have Irvine's frequency equation")
    note = "Irvine 1978, cited by the thesis; not printed there. y = Omega/2."
    return FormulaRecord(
        "cable_dsm.clamped_frequencies",
        "2.2.3 (Irvine)",
        "verified",
        note,
        tex(sp.Eq(printed, 0)),
        tex(sp.Eq(derived, 0)),
    )


def crossover() -> FormulaRecord:
    """lambda^2 at which the n-th symmetric clamped frequency meets the antisymmetric one, Omega = 2 n pi."""
    n = sp.Symbol("n", integer=True, positive=True)
    value = sp.Symbol("L", positive=True)
    at_crossing = (sp.tan(Y) - Y + 4 / value * Y**3).subs(Y, n * sp.pi)
    derived = sp.solve(at_crossing, value)[0]
    return verdict("cable_dsm.crossover", "2.2.3", 4 * n**2 * sp.pi**2, derived, left=r"\lambda^2_{crossover}")


def static_limit() -> FormulaRecord:
    """omega -> 0: the sagging cable as a spring along the chord and a taut string across it."""
    matrix, shown = cable_dsm.derived_stiffness(), cable_dsm.printed_stiffness()
    names = ("k_xx", "k_xz", "k_zz", "k_yy")
    derived = tuple(_at_zero(matrix[name]) for name in names)
    printed = tuple(_at_zero(shown[name]) for name in names)
    return verdict(
        "cable_dsm.static_limit",
        "2.32-2.35 (omega to 0)",
        printed,
        derived,
        "K_xx = (EA/L_e)/(1 + lambda^2/12), K_xz = 0, K_zz = K_yy = tau/l_c.",
    )


def _at_zero(form: Any) -> Any:
    """Value at y = 0: sine, cosine and tangent by their Taylor polynomials (zeros there: order 3)."""
    for function in (sp.sin, sp.cos, sp.tan):
        for angle in (Y, 2 * Y):
            polynomial = sp.series(function(Y), Y, 0, 8).removeO().subs(Y, angle)
            form = form.subs(function(angle), polynomial)
    return sp.factor(sp.cancel(sp.together(form)).subs(Y, 0))


def string_limit() -> FormulaRecord:
    """lambda -> 0 (weightless across the chord): the in-plane and out-of-plane string."""
    names = ("k_xx", "k_xz", "k_zz")
    derived = tuple(sp.simplify(cable_dsm.derived_stiffness()[name].subs(perpendicular_weight, 0)) for name in names)
    string = cable_dsm.out_of_plane_stiffness()
    return verdict(
        "cable_dsm.string_limit",
        "2.32-2.34 (lambda to 0)",
        (axial_stiffness / effective_length, sp.S.Zero, string),
        derived,
        "Axial spring and taut string, uncoupled.",
    )


def damping() -> FormulaRecord:
    """omega_c^2 of a viscously damped string: -rho omega_c^2 = -rho omega^2 + i omega c."""
    t, c = sp.Symbol("t", real=True), sp.Symbol("c", positive=True)
    motion = sp.exp(sp.I * omega * t)
    inertia_and_damping = linear_density * sp.diff(motion, t, 2) + c * sp.diff(motion, t)
    omega_c2 = sp.expand(-inertia_and_damping / motion / linear_density)
    critical = 2 * damping_ratio * reference_omega * linear_density
    derived = sp.expand(omega_c2.subs(c, critical))
    require_same("damped frequency", derived, damped_omega_squared())
    note = (
        "omega_c is used in (2.39) and never defined. Viscous damping, ratio xi referred to the "
        "cable's first "
        "natural frequency omega_1."
    )
    undefined, defined = r"\omega_c \text{ undefined}", r"\omega_c^2 = " + tex(derived)
    return FormulaRecord("cable_dsm.omega_c", "2.39", "corrected", note, undefined, defined)


def damped_omega_squared() -> Any:
    """omega_c^2 [rad^2/s^2]."""
    return omega**2 - 2 * sp.I * damping_ratio * reference_omega * omega


def global_rotation() -> FormulaRecord:
    """T of eq. (2.45): its columns are the chord's direction and the upward normal, in global axes."""
    x, z = sp.Symbol("x_C", positive=True), sp.Symbol("z_C", real=True, nonzero=True)
    length = sp.sqrt(x**2 + z**2)
    derived = sp.Matrix([[x, -z], [z, x]]) / length
    sine = sp.Abs(z) / length
    printed = sp.Matrix([[x / length, sine], [-sine, x / length]])
    falling = sp.Symbol("z_C", negative=True)
    require_same("T for a falling chord", printed.subs(z, falling), derived.subs(z, falling))
    note = (
        "Eq. (2.14) takes the absolute value of z_C/x_C, so T fits only a chord that falls from B "
        "to C (C below "
        "B, as in tables 2.2-2.4). For C above B the sign has to be kept: sin(alpha) = -z_C/l_c."
    )
    return verdict("cable_dsm.global_rotation", "2.45", printed, derived, note, left="T")


def formulas() -> tuple[FormulaRecord, ...]:
    """Eqs (2.32)-(2.46) against the derivation."""
    cable_dsm.prove_stable_forms(dict(zip(_NAMES, stable.dynamic_stiffness(), strict=True)))
    ratio = perpendicular_weight * chord / tension
    printed_parameter = ratio**2 * axial_stiffness * chord / (tension * effective_length)
    return (
        *_stiffness_formulas(),
        verdict(
            "cable_dsm.lambda_squared",
            "2.36",
            printed_parameter,
            cable_dsm.irvine_parameter(),
            left=r"\lambda^2",
        ),
        *cable_length.formulas(),
        damping(),
        clamped_equation(),
        crossover(),
        static_limit(),
        string_limit(),
        global_rotation(),
    )


def _reference_stiffness() -> tuple[Any, ...]:
    """The derived forms with y = omega_c l/2 sqrt(rho/tau)."""
    y = sp.sqrt(omega_c_squared) * chord / 2 * sp.sqrt(linear_density / tension)
    return tuple(cable_dsm.derived_stiffness()[name].subs(Y, y) for name in _NAMES)


def functions() -> tuple[GeneratedFunction, ...]:
    """What cdpr_struct/generated/cable_dsm.py holds."""
    rest = (tension, axial_stiffness, effective_length)
    seven = (omega_c_squared, chord, *rest, linear_density, perpendicular_weight)
    ratio = perpendicular_weight * chord / tension
    short = (chord, epsilon)
    return (
        GeneratedFunction("dynamic_stiffness", seven, stable.dynamic_stiffness(), _reference_stiffness()),
        GeneratedFunction(
            "lambda_squared",
            (chord, *rest, perpendicular_weight),
            (stable.irvine_parameter(),),
            (cable_dsm.irvine_parameter(),),
        ),
        GeneratedFunction("epsilon", (chord, tension, perpendicular_weight), (stable.sag_ratio(),), (ratio,)),
        *_length_functions(short),
        _damping_function(),
        _clamped_function(),
    )


def _length_functions(short: tuple[Any, ...]) -> tuple[GeneratedFunction, ...]:
    exact = cable_length.effective_length_integral()
    second_order = cable_length.effective_length_approximation()
    return (
        GeneratedFunction("effective_length_integral", short, (stable.effective_length_integral(),), (exact,)),
        GeneratedFunction(
            "effective_length_approximation",
            short,
            (stable.effective_length_approximation(),),
            (second_order,),
        ),
    )


def _damping_function() -> GeneratedFunction:
    arguments = (omega, damping_ratio, reference_omega)
    return GeneratedFunction("damped_omega_squared", arguments, (damped_omega_squared(),), (damped_omega_squared(),))


def _clamped_function() -> GeneratedFunction:
    y = frequency_parameter / 2
    raw = sp.cos(y) * (1 + lambda2 / (4 * y**3) * (sp.tan(y) - y))
    return GeneratedFunction(
        "clamped_frequency_function",
        (frequency_parameter, lambda2),
        (stable.clamped_frequency_function(),),
        (raw,),
    )

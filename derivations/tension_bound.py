"""Lower bound of the cable force from a wanted lowest cable frequency b (section 5.2).

Start  : taut string tau v'' + rho omega^2 v = 0, v(0) = v(l) = 0; tau is replaced by the cable force.
Arrives: omega_1 = (pi/l) sqrt(tau/rho) and f_lb = rho (b l/pi)^2, against (5.10)-(5.16).
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations.proof import require_same, tex
from cdpr_struct.derivations.records import FormulaRecord, GeneratedFunction
from cdpr_struct.derivations.symbols import b, gravity, length, linear_density, omega, tension

SOURCE = "derivations/tension_bound.py, eqs (5.10)-(5.16)"
_KG, _M, _S = sp.symbols("kg m s", positive=True)
_UNITS = {
    tension: _KG * _M / _S**2,
    linear_density: _KG / _M,
    gravity: _M / _S**2,
    length: _M,
    b: 1 / _S,
}
_FREQUENCY, _FORCE = 1 / _S, _KG * _M / _S**2
_X = sp.Symbol("x", real=True)
_FREQUENCY_NOTES = (
    ("fundamental_frequency", "5.10", "{dimension}"),
    ("fundamental_frequency_2", "2.3.2", "The same formula as (5.10). {dimension}"),
    ("frequency_of_force", "5.11", "As (5.10), with tau and l_c replaced by f_A and l_us. {dimension}"),
)
_BOUND_NOTES = (
    (
        "lower_bound",
        "5.13-5.15",
        "The printed bound equals the derived one only for a cable as long as g (9.81 m); longer "
        "cables get a "
        "frequency below b.",
    ),
    (
        "fixed_lower_bound",
        "5.16",
        "Both are largest for the longest cable, but the derived bound grows with its square.",
    ),
)


def unit_of(expression: Any) -> Any:
    """Factor by which the expression changes when every quantity is multiplied by its unit."""
    scaled = expression.subs({symbol: symbol * unit for symbol, unit in _UNITS.items()}, simultaneous=True)
    return sp.powsimp(sp.simplify(scaled / expression), force=True)


def string_frequency() -> Any:
    """Lowest omega > 0 of the string clamped at both ends [rad/s]."""
    k = omega * sp.sqrt(linear_density / tension)
    shape = sp.sin(k * _X)
    require_same("string", tension * shape.diff(_X, 2) + linear_density * omega**2 * shape, 0)
    first = sp.solve(sp.Eq(k * length, sp.pi), omega)[0]
    require_same("clamped end", shape.subs(_X, length).subs(omega, first), 0)
    return first


def printed_frequency() -> Any:
    """Eq. (5.10) as printed."""
    return sp.pi * sp.sqrt(tension / (linear_density * gravity * length))


def bound(frequency: Any) -> Any:
    """The force at which the frequency equals b [N]."""
    return sp.solve(sp.Eq(frequency, b), tension)[0]


def formulas() -> tuple[FormulaRecord, ...]:
    """Eqs (5.10)-(5.16) and the sentence of section 2.3.2 against the string."""
    derived, printed = string_frequency(), printed_frequency()
    require_same("unit of the derived frequency", unit_of(derived), _FREQUENCY)
    require_same("unit of the derived bound", unit_of(bound(derived)), _FORCE)
    meets = sp.solve(sp.Eq(bound(printed), bound(derived)), length)
    require_same("length at which both bounds agree", meets[0], gravity)
    frequency = {"printed": printed, "derived": derived, "left": r"\omega_1 = "}
    force = {"printed": bound(printed), "derived": bound(derived), "left": "f_{lb} = "}
    dimension = f"The print has the unit {unit_of(printed)} instead of 1/s; gravity under the root is wrong."
    return tuple(
        _record(f"tension_bound.{name}", equation, note.format(dimension=dimension), **forms)
        for forms, notes in ((frequency, _FREQUENCY_NOTES), (force, _BOUND_NOTES))
        for name, equation, note in notes
    )


def _record(formula_id: str, equation: str, note: str, printed: Any, derived: Any, left: str) -> FormulaRecord:
    agrees = sp.simplify(printed - derived) == 0 and unit_of(printed) == unit_of(derived)
    status = "verified" if agrees else "corrected"
    return FormulaRecord(formula_id, equation, status, note, left + tex(printed), left + tex(derived))


def functions() -> tuple[GeneratedFunction, ...]:
    """What cdpr_struct/generated/tension_bound.py holds."""
    weight_of_cable = linear_density * gravity * length
    return (
        GeneratedFunction(
            "lower_bound_printed",
            (b, linear_density, gravity, length),
            (bound(printed_frequency()),),
            (b**2 / sp.pi**2 * weight_of_cable,),
        ),
        GeneratedFunction(
            "lower_bound_frequency",
            (b, linear_density, length),
            (bound(string_frequency()),),
            (linear_density * (b * length / sp.pi) ** 2,),
        ),
    )

"""Static compliance and stiffness of the end C: derivative of the end point by the force there.

Start  : x_C, z_C as derived in catenary.py.
Arrives: (2.24)-(2.26), the split (2.28), the inverse (2.29), and proves the stable forms equal, among them
the determinant of the sag part as one product, c_zz delta D^2 r(D/2)/4 with D = w delta and
r(u) = (u - tanh u)/u^3.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations import catenary, exponential_state
from cdpr_struct.derivations import catenary_stable as stable
from cdpr_struct.derivations.proof import require_same, require_zero_rational, verdict
from cdpr_struct.derivations.records import FormulaRecord, GeneratedFunction
from cdpr_struct.derivations.symbols import axial_stiffness, force_x, force_z, length, weight

SOURCE = "derivations/cable_compliance.py, eqs (2.24)-(2.29)"
_H = sp.Symbol("H", positive=True)
_BOTTOM = force_z - weight * length


def compliance() -> Any:
    """Symmetric 2x2 matrix d(x_C, z_C)/d(f_Cx, f_Cz) [m/N], for force_x = H > 0."""
    x, z = catenary.signed_pair(catenary.end_point())
    matrix = sp.Matrix([x, z]).jacobian([_H, force_z])
    require_same("symmetry of the compliance", matrix[0, 1], matrix[1, 0])
    return matrix


def printed_compliance() -> tuple[Any, Any, Any]:
    """Eqs (2.24)-(2.26) as printed, in force_x."""
    top, bottom = (sp.sqrt(force_x**2 + v**2) for v in (force_z, _BOTTOM))
    rise = sp.asinh(force_z / force_x) - sp.asinh(_BOTTOM / force_x)
    xx = length / axial_stiffness + (sp.sign(force_x) * rise - force_z / top + _BOTTOM / bottom) / weight
    xz = (force_x / top - force_x / bottom) / weight
    zz = length / axial_stiffness + (force_z / top - _BOTTOM / bottom) / weight
    return xx, xz, zz


def inverse_of_symmetric() -> tuple[Any, Any]:
    """Printed and derived form of eq. (2.29) in C_xx, C_xz, C_zz."""
    xx, xz, zz = sp.symbols("C_xx C_xz C_zz", real=True)
    matrix = sp.Matrix([[xx, xz], [xz, zz]])
    printed = sp.Matrix([[xx, -xz], [-xz, zz]]) / matrix.det()
    derived = matrix.inv().applyfunc(sp.factor)
    require_same("derived inverse", matrix * derived, sp.eye(2))
    return printed, derived


def formulas() -> tuple[FormulaRecord, ...]:
    """Eqs (2.24)-(2.29) against the derivation."""
    prove_stable_forms()
    matrix = compliance()
    printed = catenary.signed_pair(printed_compliance())
    axial = length / axial_stiffness * sp.eye(2)
    require_same("the compliance is linear in 1/EA", _second_derivative_in_flexibility(matrix), sp.zeros(2))
    return (
        verdict("cable_compliance.c_xx", "2.24", printed[0], catenary.tidy(matrix[0, 0]), left="C_{xx}"),
        verdict("cable_compliance.c_xz", "2.25", printed[1], catenary.tidy(matrix[0, 1]), left="C_{xz}"),
        verdict("cable_compliance.c_zz", "2.26", printed[2], catenary.tidy(matrix[1, 1]), left="C_{zz}"),
        verdict(
            "cable_compliance.axial",
            "2.28",
            axial,
            (-axial_stiffness * matrix.diff(axial_stiffness)).applyfunc(sp.expand),
            "The part proportional to 1/EA; the rest is the compliance of the inextensible cable.",
            left="C_{axial}",
        ),
        _stiffness_formula(),
    )


def _second_derivative_in_flexibility(matrix: Any) -> Any:
    flexibility = sp.Symbol("flexibility", positive=True)
    return matrix.subs(axial_stiffness, 1 / flexibility).diff(flexibility, 2)


def _stiffness_formula() -> FormulaRecord:
    printed, derived = inverse_of_symmetric()
    note = (
        "The print has C_xx in the (1,1) and C_zz in the (2,2) place of the adjugate; the inverse of a "
        "symmetric 2x2 matrix exchanges them. Table 2.3 was computed with the right inverse (its K_xx is the "
        "smaller entry where C_xx is the larger one), so only the formula is misprinted."
    )
    return verdict("cable_compliance.stiffness", "2.29", printed, derived, note, left="K")


def prove_stable_forms() -> None:
    """Compliance, its determinant and the stiffness of catenary_stable.py equal the raw forms."""
    c = exponential_state.symbolic_segment()
    matrix = compliance().applyfunc(lambda entry: exponential_state.raw(entry, _H))
    axial = c.L / c.EA
    raw = (matrix[0, 0] - axial, matrix[0, 1], matrix[1, 1] - axial)
    for same_sign in (True, False):
        forms = [exponential_state.branch(form, same_sign) for form in stable.sag_compliance(c)]
        for name, form, reference in zip(("xx", "xz", "zz"), forms, raw, strict=True):
            _require(f"sag compliance {name}, same sign {same_sign}", form, reference)
        determinant = exponential_state.branch(stable.sag_determinant(c), same_sign)
        _require("sag determinant", determinant, raw[0] * raw[2] - raw[1] ** 2)
    _prove_determinant_split()


def _prove_determinant_split() -> None:
    a, xx, xz, zz = sp.symbols("a xx xz zz")
    full = sp.Matrix([[a + xx, xz], [xz, a + zz]]).det()
    require_same("determinant split", full, a**2 + a * (xx + zz) + (xx * zz - xz**2))


def _require(name: str, stable_form: Any, raw: Any) -> None:
    difference = exponential_state.rational(stable_form) - exponential_state.rational(sp.sympify(raw))
    require_zero_rational(name, difference)


def functions() -> tuple[GeneratedFunction, ...]:
    """What cdpr_struct/generated/cable_compliance.py holds."""
    cable = stable.whole_cable()
    axial = length / axial_stiffness
    xx, xz, zz = printed_compliance()
    determinant = xx * zz - xz**2
    split = (axial, xx - axial, xz, zz - axial)
    inverse = (zz / determinant, -xz / determinant, xx / determinant)
    five = catenary.ARGUMENTS
    return (
        GeneratedFunction("compliance", five, (axial, *stable.sag_compliance(cable)), split),
        GeneratedFunction("stiffness", five, stable.stiffness(cable), inverse),
    )

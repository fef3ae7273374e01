"""Decides whether two closed forms are the same, and writes the verdict on a printed equation."""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations.records import FormulaRecord
from cdpr_struct.derivations.symbols import LATEX


def tex(expression: Any) -> str:
    """LaTeX of an expression in the symbols of the thesis."""
    return str(sp.latex(expression, symbol_names=LATEX))


def _entries(expression: Any) -> list[Any]:
    if isinstance(expression, sp.MatrixBase | tuple | list):
        return list(expression)
    return [expression]


def same(left: Any, right: Any) -> bool:
    """True when every entry of left - right is reduced to zero by sympy.

    A zero that sympy misses shows as a status that changed, in the drift check.
    """
    pairs = zip(_entries(left), _entries(right), strict=True)
    return all(_is_zero(sp.sympify(a) - sp.sympify(b)) for a, b in pairs)


def _is_zero(expression: Any) -> bool:
    if expression == 0 or sp.expand(expression) == 0:
        return True
    return bool(sp.simplify(expression) == 0)


def require_same(what: str, left: Any, right: Any) -> None:
    """Stop the derivation when a step that must hold does not."""
    if not same(left, right):
        raise ArithmeticError(f"derivation step {what!r} does not hold: {left} is not {right}")


def require_zero_rational(what: str, expression: Any) -> None:
    """Stop unless a rational function is identically zero (decided by polynomial algebra)."""
    if sp.cancel(sp.together(expression)) != 0:
        raise ArithmeticError(f"derivation step {what!r} does not hold")


def verdict(
    formula_id: str, equation: str, printed: Any, derived: Any, note: str = "", left: str = ""
) -> FormulaRecord:
    """Compare the print with the derivation; `left` is the LaTeX of the left-hand side.

    The note of a correction is given by the derivation; a verified formula may carry one too.
    """
    status = "verified" if same(printed, derived) else "corrected"
    prefix = f"{left} = " if left else ""
    return FormulaRecord(
        formula_id, equation, status, note, prefix + tex(_shown(printed)), prefix + tex(_shown(derived))
    )


def _shown(expression: Any) -> Any:
    return sp.Matrix(list(expression)) if isinstance(expression, tuple | list) else expression

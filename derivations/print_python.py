"""Prints a set of expressions as a numpy module: shared subexpressions, broadcasting, docstrings."""

from __future__ import annotations

import re
from typing import Any

import sympy as sp
from sympy.printing.numpy import NumPyPrinter

from cdpr_struct.derivations.descriptions import DESCRIPTIONS
from cdpr_struct.derivations.records import GeneratedFunction
from cdpr_struct.derivations.special_functions import ALL
from cdpr_struct.derivations.symbols import MEANING


class _ArrayPrinter(NumPyPrinter):
    """NumPyPrinter that broadcasts: nested np.where, np.maximum, np.minimum; special functions by name."""

    def _print_Piecewise(self, expr: Any) -> str:
        value, condition = expr.args[-1]
        text = self._print(value)
        for value, condition in reversed(expr.args[:-1]):
            text = f"np.where({self._print(condition)}, {self._print(value)}, {text})"
        return str(text)

    def _print_Relational(self, expr: Any) -> str:
        return f"{self._print(expr.lhs)} {expr.rel_op} {self._print(expr.rhs)}"

    def _nested(self, name: str, arguments: list[str]) -> str:
        text = arguments[-1]
        for argument in reversed(arguments[:-1]):
            text = f"np.{name}({argument}, {text})"
        return text

    def _print_Max(self, expr: Any) -> str:
        return self._nested("maximum", sorted(map(self._print, expr.args)))

    def _print_Min(self, expr: Any) -> str:
        return self._nested("minimum", sorted(map(self._print, expr.args)))

    def _print_Pow(self, expr: Any, rational: bool = False) -> str:
        if expr.exp == -1:
            return f"1/({self._print(expr.base)})"
        return str(super()._print_Pow(expr, rational=rational))

    def _print_ImaginaryUnit(self, expr: Any) -> str:
        return "1j"


def _printer() -> _ArrayPrinter:
    names = {function.__name__: function.__name__ for function in ALL}
    return _ArrayPrinter({"user_functions": names, "fully_qualified_modules": True})


def _code(expression: Any) -> str:
    text = _printer().doprint(expression)
    return re.sub(r"\bnumpy\.", "np.", text)


def operation_count(function: GeneratedFunction) -> int:
    """Operations after common subexpression elimination."""
    replacements, reduced = sp.cse(function.outputs, symbols=sp.numbered_symbols("t"), list=False)
    return int(sum(sp.count_ops(value) for _, value in replacements) + sum(map(sp.count_ops, reduced)))


def _docstring(function: GeneratedFunction) -> list[str]:
    result, remarks = DESCRIPTIONS[function.name]
    lines = [f'    """{result}', ""]
    width = max(len(str(argument)) for argument in function.arguments)
    lines += [f"    {argument!s:{width}} : {MEANING[str(argument)]}" for argument in function.arguments]
    return [*lines, "", *(f"    {remark}" for remark in remarks), '    """']


def _return_lines(function: GeneratedFunction, values: list[str]) -> list[str]:
    if not function.shape:
        return [f"    return {', '.join(values)}"]
    columns = function.shape[-1]
    rows_columns = ", ".join(map(str, function.shape))
    values = [f"{value}.0" if value.isdigit() else value for value in values]
    rows = [", ".join(values[i : i + columns]) for i in range(0, len(values), columns)]
    entries = ",\n        ".join(rows)
    return [
        f"    entries = np.broadcast_arrays(\n        {entries},\n    )",
        f"    return np.stack(entries, axis=-1).reshape((*entries[0].shape, {rows_columns}))",
    ]


def function_text(function: GeneratedFunction) -> str:
    """Source of one generated function."""
    replacements, reduced = sp.cse(function.outputs, symbols=sp.numbered_symbols("t"), list=False)
    names = ", ".join(f"{argument}: Any" for argument in function.arguments)
    lines = [f"def {function.name}({names}) -> Any:", *_docstring(function)]
    lines += [f"    {symbol} = {_code(value)}" for symbol, value in replacements]
    lines += _return_lines(function, [_code(sp.sympify(value)) for value in reduced])
    return "\n".join(lines) + "\n"


def header(source: str, operations: int | None) -> str:
    """Docstring of a generated module."""
    cost = "" if operations is None else f"; {operations} operations after cse"
    return (
        '"""GENERATED FILE - do not edit.\n\n'
        "Regenerate : python -m cdpr_struct.derivations\n"
        f"Source     : {source}\n"
        f"Made with  : sympy {sp.__version__}{cost}\n"
        '"""\n\n'
    )


def module_text(source: str, functions: tuple[GeneratedFunction, ...]) -> str:
    """Source of one generated module."""
    bodies = [function_text(function) for function in functions]
    used = sorted(f.__name__ for f in ALL if any(re.search(rf"\b{f.__name__}\(", body) for body in bodies))
    imports = "from typing import Any\n"
    if any("np." in body for body in bodies):
        imports += "\nimport numpy as np\n"
    if used:
        imports += f"\nfrom cdpr_struct.generated.special_functions import {', '.join(used)}\n"
    total = sum(map(operation_count, functions))
    return header(source, total) + imports + "\n\n" + "\n\n".join(bodies)

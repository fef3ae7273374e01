"""Runs all sheets, renders the files they stand for, and writes or compares them."""

from __future__ import annotations

import difflib
import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import cdpr_struct
from cdpr_struct.derivations import (
    cable_compliance,
    cable_dsm_formulas,
    catenary,
    platform_formulas,
    special_functions,
    tension_bound,
)
from cdpr_struct.derivations.check_values import value_errors
from cdpr_struct.derivations.print_latex import formula_sheet
from cdpr_struct.derivations.print_python import header, module_text
from cdpr_struct.derivations.print_special_functions import module_body
from cdpr_struct.derivations.records import DerivationReport, FormulaRecord, GeneratedFunction

SHEETS: dict[str, ModuleType] = {
    "catenary": catenary,
    "cable_compliance": cable_compliance,
    "cable_dsm": cable_dsm_formulas,
    "platform": platform_formulas,
    "tension_bound": tension_bound,
}
GENERATED = "cdpr_struct/generated"
FORMULA_SHEET = "cdpr_struct/derivations/latex/formula_sheet.tex"
_VERSION = re.compile(r"^Made with  : sympy [^;\n]+", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Rendering:
    """Everything the derivations print: path from the folder that holds the package -> text."""

    formulas: tuple[FormulaRecord, ...]
    functions: dict[str, tuple[GeneratedFunction, ...]]
    texts: dict[str, str]


def render(progress: Callable[[str], None] = lambda name: None) -> Rendering:
    """Derive, and print all files into memory; `progress` is called with the name of each sheet that begins."""
    progress("special functions")
    special_functions.prove_series()
    formulas: tuple[FormulaRecord, ...] = ()
    for name, sheet in SHEETS.items():
        progress(name.replace("_", " "))
        formulas += tuple(sheet.formulas())
    progress("printing")
    functions = {name: sheet.functions() for name, sheet in SHEETS.items()}
    texts = {f"{GENERATED}/{name}.py": module_text(SHEETS[name].SOURCE, f) for name, f in functions.items()}
    special = header("derivations/special_functions.py, derivations/print_special_functions.py", None)
    texts[f"{GENERATED}/special_functions.py"] = special + module_body()
    texts[FORMULA_SHEET] = formula_sheet(formulas)
    return Rendering(formulas, functions, texts)


def same(committed: str, fresh: str) -> bool:
    """Whether two texts say the same; which SymPy printed it does not matter."""
    return _VERSION.sub("", committed) == _VERSION.sub("", fresh)


def drift(texts: dict[str, str], root: Path) -> str:
    """Unified diff of the files under root against the fresh texts."""
    parts: list[str] = []
    for name, fresh in sorted(texts.items()):
        path = root / name
        committed = path.read_text(encoding="utf-8") if path.exists() else ""
        if not same(committed, fresh):
            parts += difflib.unified_diff(
                committed.splitlines(True), fresh.splitlines(True), f"committed/{name}", f"fresh/{name}"
            )
    return "".join(parts)


def write(texts: dict[str, str], root: Path) -> tuple[str, ...]:
    """Write the texts that differ; returns their names."""
    changed = []
    for name, text in sorted(texts.items()):
        path = root / name
        if path.exists() and same(path.read_text(encoding="utf-8"), text):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        changed.append(name)
    return tuple(changed)


def regenerate(
    check: bool, output: Path | None, progress: Callable[[str], None] = lambda name: None
) -> DerivationReport:
    """See derivations.run."""
    start = time.perf_counter()
    root = Path(cdpr_struct.__file__).resolve().parents[1] if output is None else Path(output)
    rendering = render(progress)
    diff = drift(rendering.texts, root)
    written = () if check else write(rendering.texts, root)
    progress("comparing numbers at 50 digits")
    errors = value_errors(rendering.functions, root / GENERATED)
    seconds = time.perf_counter() - start
    return DerivationReport(rendering.formulas, diff if check else "", errors, seconds, written)

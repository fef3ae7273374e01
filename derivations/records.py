"""What a derivation hands on: formulas with their verdict on the print, functions to generate, the report.

Imports nothing heavy, so that `import cdpr_struct.derivations` stays light.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

STATUSES = ("verified", "corrected")


@dataclass(frozen=True, slots=True)
class FormulaRecord:
    """One thesis formula: what is printed, what the derivation arrives at, and whether they agree.

    id              : "sheet.formula"
    thesis_equation : number as printed, e.g. "2.11", or the section
    status          : "verified" (the derivation reproduces the print) or "corrected" (it does not)
    note            : why the print is wrong; obligatory when corrected
    proof           : how the comparison was decided ("symbolic" or "50 digits at n points")
    """

    id: str
    thesis_equation: str
    status: str
    note: str
    printed_latex: str
    derived_latex: str
    proof: str = "symbolic"

    def __post_init__(self) -> None:
        if self.status not in STATUSES:
            raise ValueError(f"FormulaRecord.status must be one of {STATUSES}, got {self.status!r}")
        if self.status == "corrected" and not self.note:
            raise ValueError(f"FormulaRecord {self.id!r} is corrected, so it needs a note that says why")


@dataclass(frozen=True, slots=True)
class GeneratedFunction:
    """One function of a generated module.

    outputs   : stable sympy expressions that are printed (a flat tuple; row-major for a matrix)
    shape     : () for a tuple of arrays, (rows, columns) for a (..., rows, columns) result
    reference : raw closed forms of the derivation, same order; the numbers are checked against these
    The docstring's texts are in descriptions.py.
    """

    name: str
    arguments: tuple[Any, ...]
    outputs: tuple[Any, ...]
    reference: tuple[Any, ...]
    shape: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class DerivationReport:
    """Outcome of one run of all derivations.

    formulas     : every formula with its status
    diff         : unified diff of the committed against the fresh text, empty when current
    value_errors : one line per generated number that left the 50-digit value of its derivation
    seconds      : wall time of the run
    """

    formulas: tuple[FormulaRecord, ...]
    diff: str
    value_errors: tuple[str, ...]
    seconds: float
    written: tuple[str, ...] = ()

    @property
    def current(self) -> bool:
        """True when the committed text is the fresh text and every number agrees."""
        return not self.diff and not self.value_errors

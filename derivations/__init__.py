"""Symbolic derivations of every closed form, printed as numpy modules and as a LaTeX formula sheet.

`run` regenerates or checks; importing this package stays light (sympy is loaded inside `run`).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from cdpr_struct.derivations.records import DerivationReport, FormulaRecord

__all__ = ["STEPS", "DerivationReport", "FormulaRecord", "run"]

STEPS = 8
"""Calls of `progress` in a run."""


def run(
    check: bool = False, output: Path | None = None, progress: Callable[[str], None] = lambda name: None
) -> DerivationReport:
    """Derive everything; write the results, or compare them with what is there.

    Parameters
    ----------
    check : True compares and writes nothing; False writes.
    output : folder that holds cdpr_struct/generated and cdpr_struct/derivations/latex; None is the one that this
        package was imported from.
    progress : called with the name of each of the `STEPS` steps as it begins.

    Returns
    -------
    DerivationReport. `current` is False when a text drifted or a generated number left its 50-digit value.

    Raises
    ------
    ArithmeticError : a step of a derivation does not hold.
    """
    from cdpr_struct.derivations.regenerate import regenerate

    return regenerate(check, output, progress)

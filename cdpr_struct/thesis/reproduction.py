"""What a reproduction of a thesis table or figure is: printed value beside ours, cell by cell."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources

import numpy as np


@dataclass(frozen=True, slots=True)
class Cell:
    """One printed number and ours.

    row, column : where it stands
    printed     : as text, so that its digits tell how well it is known
    ours        : recomputed, same unit
    tolerance   : allowed deviation; None for what the rounding of the print explains
    converged   : what ours tends to where the thesis's way depends on a mesh; None where it does not
    """

    row: str
    column: str
    printed: str
    ours: float
    tolerance: float | None = None
    converged: float | None = None

    @property
    def deviation(self) -> float:
        """Ours minus printed."""
        return self.ours - float(self.printed)

    @property
    def half_digit(self) -> float:
        """Half of the last printed digit: what rounding alone explains."""
        decimals = len(self.printed.partition(".")[2])
        return 0.5 * 10.0**-decimals

    @property
    def allowed(self) -> float:
        """The tolerance, stated or of the print's rounding."""
        return self.half_digit if self.tolerance is None else self.tolerance

    @property
    def within_print(self) -> bool:
        """Ours rounds to the printed number."""
        return abs(self.deviation) <= self.half_digit * (1.0 + 1e-9)

    @property
    def within(self) -> bool:
        """Ours is within the tolerance."""
        return abs(self.deviation) <= self.allowed * (1.0 + 1e-9)


@dataclass(frozen=True, slots=True)
class Statement:
    """A sentence of the thesis about a figure, and whether ours shows it.

    text : what the thesis says;  ours : what we find, with numbers;  holds : whether they agree
    """

    text: str
    ours: str
    holds: bool


@dataclass(frozen=True, slots=True, eq=False)
class Reproduction:
    """One thesis item recomputed.

    note       : what the numbers mean: which deviations are larger than the tolerance, and why
    statements : what the thesis says in words
    columns    : the data of a figure, all columns of one length; empty for a table
    """

    id: str
    title: str
    cells: tuple[Cell, ...]
    note: str
    statements: tuple[Statement, ...] = ()
    columns: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def worst(self) -> Cell:
        """The cell with the largest deviation in units of its tolerance."""
        return max(self.cells, key=lambda cell: abs(cell.deviation) / cell.allowed)

    @property
    def within_tolerance(self) -> int:
        """How many cells are within their tolerance."""
        return sum(cell.within for cell in self.cells)

    @property
    def holds(self) -> bool:
        """Every cell is within its tolerance, and every statement holds."""
        return self.within_tolerance == len(self.cells) and all(s.holds for s in self.statements)


def printed_table(name: str) -> list[dict[str, str]]:
    """Rows of a table as printed in the thesis."""
    text = resources.files("cdpr_struct.thesis.tables").joinpath(f"{name}.csv").read_text("utf-8")
    return list(csv.DictReader(text.splitlines()))

"""What a reproduction of a thesis table is: printed value beside ours, cell by cell."""

import csv
from dataclasses import dataclass
from importlib import resources


@dataclass(frozen=True, slots=True)
class Cell:
    """One printed number and ours.

    row, column : where it stands
    printed     : as text, so that its digits tell how well it is known
    ours        : recomputed, same unit
    """

    row: str
    column: str
    printed: str
    ours: float

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
    def within_print(self) -> bool:
        """Ours rounds to the printed number."""
        return abs(self.deviation) <= self.half_digit * (1.0 + 1e-9)


@dataclass(frozen=True, slots=True)
class Reproduction:
    """One thesis item recomputed.

    note : what the numbers mean: which deviations go beyond the print's rounding, and why
    """

    id: str
    title: str
    cells: tuple[Cell, ...]
    note: str

    @property
    def worst(self) -> Cell:
        """The cell with the largest deviation in units of its printed rounding."""
        return max(self.cells, key=lambda cell: abs(cell.deviation) / cell.half_digit)

    @property
    def within_tolerance(self) -> int:
        """How many cells round to the printed number."""
        return sum(cell.within_print for cell in self.cells)


def printed_table(name: str) -> list[dict[str, str]]:
    """Rows of a table as printed in the thesis."""
    text = resources.files("cdpr_struct.thesis.tables").joinpath(f"{name}.csv").read_text("utf-8")
    return list(csv.DictReader(text.splitlines()))

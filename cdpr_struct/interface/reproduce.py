"""Thesis tables and figures, printed value beside ours."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of
from cdpr_struct.interface.given import Progress
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.reports import reproduce_page
from cdpr_struct.reports.figures.reproductions import FIGURES
from cdpr_struct.reports.trust_without_robot import reproduction_trust, with_trust
from cdpr_struct.thesis.catalogue import ITEMS
from cdpr_struct.thesis.reproduction import Reproduction

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ReproduceResult(Result):
    """Items of the thesis, recomputed.

    items : one a table or figure, in the order asked for
    """

    items: tuple[Reproduction, ...]

    @property
    def title(self) -> str:
        """Which items."""
        return "The thesis, recomputed: " + ", ".join(item.id for item in self.items)

    def text(self) -> str:
        """Printed value, ours and deviation of every number."""
        return "\n\n".join(reproduce_page.reproduction_text(item) for item in self.items)

    def sentences(self) -> Sequence[str]:
        """How many items agree with the print."""
        return reproduce_page.reproduction_sentences(self.items)

    def columns(self) -> Mapping[str, Any]:
        """Columns of the items' CSV files, one item below the other."""
        parts = [reproduce_page.cell_columns(item) for item in self.items]
        names = [item.id for item in self.items for _ in item.cells]
        return {"item": names, **{key: [value for part in parts for value in part[key]] for key in parts[0]}}

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The figure of the first item that has one.

        Raises
        ------
        InputError : none has.
        """
        drawn = next((item for item in self.items if item.id in FIGURES), None)
        if drawn is None:
            raise InputError("items", "", self.title, f"items with a figure are: {', '.join(FIGURES)}")
        draw, size, _ = FIGURES[drawn.id]
        return lambda figure: draw(figure, drawn), size

    def files(self) -> Files:
        """Tables, figures and page."""
        return reproduce_page.reproduction_files(self.items)


@answered
def reproduce(*items: str, progress: Progress = silent) -> ReproduceResult:
    """Recompute tables and figures of the thesis and show the deviations.

    Parameters
    ----------
    items : like "table-2.2"; default: all
    progress : called with the name of each item

    Raises
    ------
    InputError : there is no such item.
    """
    found = []
    names = [one_of(name, "items", ITEMS) for name in dict.fromkeys(items or ITEMS)]
    for name in names:
        progress(name)
        found.append(ITEMS[name]())
    told = {"items": [reproduce_page.reproduction_json(item) for item in found]}
    return ReproduceResult(with_trust(told, reproduction_trust(found)), tuple(found))

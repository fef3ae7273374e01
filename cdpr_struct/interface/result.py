"""What every function of the interface answers: a result that shows itself as text, table, figure and JSON."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from cdpr_struct.reports.plain_json import plain_result
from cdpr_struct.reports.remarks import extensions_of, remarks, rest_of, warnings_of

if TYPE_CHECKING:
    import pandas as pd

    from cdpr_struct.reports.figures.shown import Axes, Draw

Files = Mapping[str, str | bytes | Iterable[bytes]]
_ROWS = 12  # of a table in a notebook


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Result(ABC):
    """An answer of this package, which shows itself as text, table, figure and JSON.

    `print` shows what the command prints, a notebook a table. The numerics' own objects are attributes.

    answer : by key of the command's result.json, numbers and arrays as they were computed
    """

    answer: Mapping[str, Any]

    @property
    def warnings(self) -> list[str]:
        """Sentences that a reader of the result must not miss."""
        return warnings_of(self.answer)

    def to_json(self) -> dict[str, Any]:
        """The keys and values of the command's result.json: lists, numbers, text; None where a number is nan or inf."""
        return plain_result(self.answer)

    def frame(self) -> "pd.DataFrame":
        """The command's main CSV file as a table, units in the names of its columns."""
        import pandas as pd

        return pd.DataFrame(dict(self.columns()))

    def plot(self) -> "Axes":
        """The command's main figure in a new pyplot figure; the axes carry the title, the others are in `.figure`."""
        from cdpr_struct.reports.figures.shown import shown

        return shown(*self.figure(), self.title)

    @property
    @abstractmethod
    def title(self) -> str:
        """Whose result it is, and of what."""

    @abstractmethod
    def text(self) -> str:
        """What the command prints, without its remarks."""

    @abstractmethod
    def sentences(self) -> Sequence[str]:
        """The outcome in words."""

    @abstractmethod
    def columns(self) -> Mapping[str, Any]:
        """Columns of the command's main CSV file."""

    @abstractmethod
    def figure(self) -> tuple["Draw", tuple[float, float]]:
        """What draws the command's main figure into an empty one, and its size [inch]."""

    @abstractmethod
    def files(self) -> Files:
        """Contents of the files that the command writes beside result.json, by name."""

    def __str__(self) -> str:
        """What the command prints."""
        return "\n\n".join([self.text(), *remarks(self.answer)])

    def __repr__(self) -> str:
        """One line; `print` shows the whole."""
        said = " ".join(self.sentences()[:1])
        return f"<{type(self).__name__} {self.title}: {said}>"

    def _repr_html_(self) -> str:
        """Title, outcome, warnings and the first rows of the table, for notebooks."""
        table = self.frame()
        said = [*self.sentences(), *rest_of(self.answer), *extensions_of(self.answer)]
        warned = [f"<p><b>Warning:</b> {escape(sentence)}</p>" for sentence in self.warnings]
        size = f"<p>{len(table)} rows, {len(table.columns)} columns: <code>.frame()</code></p>"
        return "".join(
            [
                f"<div><h4>{escape(self.title)}</h4>",
                *(f"<p>{escape(sentence)}</p>" for sentence in said),
                *warned,
                table.head(_ROWS).to_html(index=False, border=0, float_format=lambda value: f"{value:.6g}"),
                size if len(table) > _ROWS else "",
                "</div>",
            ]
        )

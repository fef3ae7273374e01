"""What a command found for many inputs: one table for the screen, for CSV, and for the page."""

from collections.abc import Mapping, Sequence
from typing import Any

from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import plain_table

Row = Mapping[str, Any]
Columns = Mapping[str, tuple[str, str]]
"""Heading: key of a row, and format of its value."""

_MOST_SHOWN = 40


def unanswered(rows: Sequence[Row]) -> list[str]:
    """A sentence for each input without an answer."""
    failed = [row for row in rows if row["message"]]
    return [m if (m := row["message"]).startswith(row["input"]) else f"{row['input']}: {m}" for row in failed]


def rows_text(title: str, columns: Columns, rows: Sequence[Row]) -> str:
    """A table for the terminal; of very many inputs the first ones."""
    told = [cells(columns, row) for row in rows if not row["message"]]
    parts = [plain_table(title, list(columns), told[:_MOST_SHOWN])] if told else [title]
    if len(told) > _MOST_SHOWN:
        parts.append(f"{len(told) - _MOST_SHOWN} more are in the table of --out DIR and in --json.")
    failed = unanswered(rows)
    if failed:
        parts.append("\n".join([f"Without an answer: {len(failed)} of {len(rows)}.", *failed[:_MOST_SHOWN]]))
    return "\n\n".join(parts)


def cells(columns: Columns, row: Row) -> list[str]:
    """A row's values as text; a missing one is a dash."""
    values = [(row.get(key), form) for key, form in columns.values()]
    return ["-" if value is None else format(_cell(value), form) for value, form in values]


def rows_csv(rows: Sequence[Row]) -> str:
    """All values of all rows; empty where a row has none."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    return csv_text({key: [_cell(row.get(key)) for row in rows] for key in keys})


def _cell(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return " + ".join(map(str, value))
    return "" if value is None else value


def rows_files(
    title: str, verdict: Sequence[str], facts: Sequence[tuple[str, str]], plates: Sequence[Plate], columns: Columns,
    rows: Sequence[Row], prose: frozenset[int],
) -> dict[str, str | bytes]:  # fmt: skip
    """The report page with its figures: figures, the table, and what could not be answered."""
    failed = unanswered(rows)
    table = HtmlTable(
        title,
        list(columns),
        [cells(columns, row) for row in rows],
        "Each input has a report page of its own: report.html in the folder of its name.",
        frozenset(number for number, row in enumerate(rows) if row["message"]),
        prose,
    )
    listings = [("Without an answer", "\n".join(failed))] if failed else []
    page = Page(title, f"{len(rows)} inputs", verdict, not failed, facts, plates, [table], [], listings)
    return page_files(page)

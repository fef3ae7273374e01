"""Where the numbers of a table begin, and what its columns are called, whatever lines a logger writes above them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, time, timedelta

from cdpr_struct.recordings.channel import Channel
from cdpr_struct.recordings.unit import kind_of, unit_in_name

LOOKED_AT = 200  # rows of a table in which its numbers begin
_NUMBER = re.compile(r"\s*[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d+)?\s*$")
_INSTANT = re.compile(r"\s*\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
_BLANK = ("", "nan", "-nan", "inf", "-inf", "null", "none", "n/a")


@dataclass(frozen=True, slots=True)
class Heading:
    """The columns of a table.

    channels : one a column, in order;  first : number of the row, from 0, in which the numbers begin
    """

    channels: tuple[Channel, ...]
    first: int


def heading(rows: Sequence[Sequence[object]], group: str = "", before: str = "") -> Heading | None:
    """The columns of a table by its first rows of cells; None if there are no two rows of numbers alike.

    group  : of the channels;  before : what the channels' names begin with
    """
    for first, row in enumerate(rows[:-1]):
        if _is_data(row) and len(rows[first + 1]) == len(row) and _is_data(rows[first + 1]):
            names, units = _above(rows[:first], len(row))
            units = ["s" if _is_instant(cell) else unit for cell, unit in zip(row, units, strict=True)]
            return Heading(_channels(names, units, group, before), first)
    return None


def is_number(cell: object) -> bool:
    """Whether a cell holds a number or an instant, decimals with a point or a comma."""
    if isinstance(cell, str) and _NUMBER.match(cell):
        return True
    return _is_instant(cell) or isinstance(cell, int | float)


def _is_instant(cell: object) -> bool:
    """Whether it is read as a number of seconds."""
    return bool(_INSTANT.match(cell)) if isinstance(cell, str) else isinstance(cell, datetime | time | timedelta)


def _is_data(row: Sequence[object]) -> bool:
    """Half of the cells are numbers, the others blank or words such as a state."""
    numbers = sum(is_number(cell) for cell in row)
    blank = sum(cell is None or str(cell).strip().lower() in _BLANK for cell in row)
    return numbers > 0 and 2 * (numbers + blank) >= len(row)


def _above(rows: Sequence[Sequence[object]], width: int) -> tuple[list[str], list[str]]:
    """Names and units of the columns from the rows above the numbers; units "" where no row gives them."""
    texts = [[_text(cell) for cell in row] for row in rows if any(_text(cell) for cell in row)]
    fitting = [row for row in texts[-2:] if len(row) == width]
    if len(fitting) == 2 and texts[-2:] == fitting and _are_units(fitting[1]):
        return fitting[0], fitting[1]
    names = fitting[-1] if fitting and texts[-1] == fitting[-1] else [""] * width
    return names, [""] * width


def _are_units(row: Sequence[str]) -> bool:
    """Whether most of the cells that are not empty are units that are known, or stand in brackets."""
    given = [cell for cell in row if cell]
    known = [cell for cell in given if kind_of(cell) or cell.strip()[:1] in "[("]
    return bool(known) and 2 * len(known) >= len(given)


def _text(cell: object) -> str:
    return "" if cell is None else str(cell).strip()


def _channels(names: Sequence[str], units: Sequence[str], group: str, before: str) -> tuple[Channel, ...]:
    """Channels of columns; those without a name are counted, and of equal names the later ones are numbered."""
    found: dict[str, Channel] = {}
    for number, (name, unit) in enumerate(zip(names, units, strict=True), start=1):
        called = before + (name or f"column {number}")
        while called in found:
            called += f" #{number}"
        found[called] = Channel(called, group, unit.strip("[]() ") or unit_in_name(name))
    return tuple(found.values())

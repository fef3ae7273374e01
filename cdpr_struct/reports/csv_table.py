"""Columns as CSV text that reads back as the same numbers."""

import csv
import io
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

_FORMULA = re.compile(r"[=@\t\r]|[+-].*[(|!]")  # a name that a spreadsheet would run; -z and -1.5 are none
_ROWS = 4096  # of a long table that are in memory as text


def csv_text(columns: Mapping[str, Iterable[Any]]) -> str:
    """One row per entry; floats with all their digits, nan as an empty field, formulas as text.

    Raises
    ------
    ValueError : columns of different lengths.
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_field(value) for value in row] for row in zip(*columns.values(), strict=True))
    return buffer.getvalue()


@dataclass(frozen=True, slots=True, eq=False)
class LongTable:
    """The bytes of `csv_text`, some rows at a time, as often as they are asked for; columns of one length."""

    columns: Mapping[str, Any]

    def __iter__(self) -> Iterator[bytes]:
        buffer = io.StringIO()
        csv.writer(buffer, lineterminator="\n").writerow(self.columns)
        yield buffer.getvalue().encode("utf-8")
        rows = zip(*self.columns.values(), strict=True)
        while part := list(islice(rows, _ROWS)):
            buffer = io.StringIO()
            csv.writer(buffer, lineterminator="\n").writerows([_field(value) for value in row] for row in part)
            yield buffer.getvalue().encode("utf-8")


def _field(value: Any) -> str:
    value = value.item() if hasattr(value, "item") else value
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    text = str(value)
    return f"'{text}" if _FORMULA.match(text) else text

"""Columns as CSV text that reads back as the same numbers."""

import csv
import io
import math
from collections.abc import Iterable, Mapping
from typing import Any


def csv_text(columns: Mapping[str, Iterable[Any]]) -> str:
    """One row per entry; floats with all their digits, nan as an empty field.

    Raises
    ------
    ValueError : columns of different lengths.
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_field(value) for value in row] for row in zip(*columns.values(), strict=True))
    return buffer.getvalue()


def _field(value: Any) -> str:
    value = value.item() if hasattr(value, "item") else value
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    return str(value)

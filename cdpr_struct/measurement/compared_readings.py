"""Readings of one state of rest, to be held against a prediction: a CSV file with the columns of data files."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cdpr_struct.errors import NOTHING, InputError
from cdpr_struct.measurement.campaign import Sigmas
from cdpr_struct.measurement.campaign_rows import POSE
from cdpr_struct.measurement.column_names import renaming
from cdpr_struct.measurement.data_table import DataTable, read_table

COLUMNS = ("mode", "frequency_hz", "cable", "tension_N", *POSE, "sigma")
_READ = ("frequency_hz", "tension_N", *POSE)


@dataclass(frozen=True, slots=True)
class Reading:
    """A measured number.

    column : that it stood in, with its unit;  line : of the file
    number : of the mode or cable from 1, 0 where the file does not say it or there is none
    measured, sigma : in the unit of the column
    """

    column: str
    line: int
    number: int
    measured: float
    sigma: float


def read_readings(path: Path, cables: int) -> list[Reading]:
    """All readings of a file; where it has no column `sigma`, sigmas are the defaults of campaigns.

    Raises
    ------
    InputError : a column or cell that cannot be used, and what would be right.
    """
    table = read_table(path)
    table.require_rows()
    _check_columns(table)
    rows = [dict(zip(table.names, row, strict=False)) for row in table.rows]
    found = [one for row, line in zip(rows, table.line, strict=True) for one in _of_row(table.file, row, line, cables)]
    if not found:
        raise InputError(table.file, "", "no readings", f"numbers in at least one of the columns {', '.join(_READ)}")
    return found


def _check_columns(table: DataTable) -> None:
    for name in table.names:
        if name and name not in COLUMNS:
            meant, _ = renaming([name], COLUMNS)
            raise InputError(table.file, "header", name, meant or f"columns are {', '.join(COLUMNS)}")
    if not any(name in table.names for name in _READ):
        raise InputError(table.file, "header", ", ".join(table.names), f"at least one of {', '.join(_READ)}")


def _of_row(file: str, row: Mapping[str, str], line: int, cables: int) -> Iterator[Reading]:
    given = [name for name in _READ if row.get(name)]
    own = _number(file, row, line, "sigma") if row.get("sigma") else None
    if own is not None and (own <= 0.0 or len(given) > 1):
        expected = "a number above 0, in the unit of the row's one reading; give each reading a row of its own"
        raise InputError(file, f"line {line}, sigma", row["sigma"], expected)
    for name in given:
        value = _number(file, row, line, name)
        if name == "frequency_hz" and value <= 0.0:
            raise InputError(file, f"line {line}, {name}", row[name], "a frequency in Hz, above zero")
        number = _numbered(file, row, line, name, cables)
        yield Reading(name, line, number, value, own or _default(name, value))


def _number(file: str, row: Mapping[str, str], line: int, name: str) -> float:
    try:
        value = float(row[name])
    except ValueError:
        value = math.nan
    if not abs(value) < 1e12:
        raise InputError(file, f"line {line}, {name}", row[name], "a finite number, decimals with a point")
    return value


def _numbered(file: str, row: Mapping[str, str], line: int, name: str, cables: int) -> int:
    """The mode or cable that a reading belongs to; 0 of a frequency without one, and of a pose."""
    if name in POSE:
        return 0
    column, most = ("mode", 500) if name == "frequency_hz" else ("cable", cables)
    text = row.get(column, "")
    if not text and column == "mode":
        return 0
    if not text.isdigit() or not 1 <= int(text) <= most:
        raise InputError(file, f"line {line}, {column}", text or NOTHING, f"a whole number from 1 to {most}")
    return int(text)


def _default(name: str, value: float) -> float:
    used = Sigmas()
    if name == "frequency_hz":
        return float(used.frequency(np.array(value)))
    if name == "tension_N":
        return used.tension_N
    return used.position_m if name.endswith("_m") else used.rotation_deg

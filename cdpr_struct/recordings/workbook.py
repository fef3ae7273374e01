"""Recordings as Excel workbooks: each sheet with a table of numbers is a group of channels."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, time, timedelta
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Piece, Recording
from cdpr_struct.recordings.form import CALLED
from cdpr_struct.recordings.heading import LOOKED_AT, Heading, heading
from cdpr_struct.recordings.library import library, reading

_EPOCH = datetime(1970, 1, 1)
_ROWS = 20_000  # read at once


@dataclass(frozen=True, slots=True, eq=False)
class Workbook(Recording):
    """A workbook.

    sheets : name of each sheet that holds a table, with its columns
    """

    sheets: Sequence[tuple[str, Heading]]

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        with reading(self.path, self.form):
            book = _book(self.path)
            try:
                for sheet, table in self.sheets:
                    places = [i for i, channel in enumerate(table.channels) if channel.name in names]
                    if places:
                        yield from _columns(book[sheet], table, places)
            finally:
                book.close()


def _columns(sheet: Any, table: Heading, places: Sequence[int]) -> Iterator[Piece]:
    rows = sheet.iter_rows(min_row=table.first + 1, values_only=True)
    while block := list(islice(rows, _ROWS)):
        filled = [row for row in block if any(cell is not None for cell in row)]
        for place in places if filled else ():
            values = np.array([_number(row[place] if place < len(row) else None) for row in filled])
            yield Piece(table.channels[place].name, values)


def _number(cell: object) -> float:
    """The number of a cell; instants as seconds since 1970, times of day and durations in seconds; else nan."""
    if isinstance(cell, datetime):
        return (cell.replace(tzinfo=None) - _EPOCH).total_seconds()
    if isinstance(cell, time):
        return cell.hour * 3600.0 + cell.minute * 60.0 + cell.second + 1e-6 * cell.microsecond
    if isinstance(cell, timedelta):
        return cell.total_seconds()
    try:
        return float(cell) if isinstance(cell, int | float | str) else np.nan
    except (ValueError, OverflowError):
        return np.nan


def _book(path: Path) -> Any:
    return library("openpyxl", CALLED["xlsx"], path).load_workbook(path, read_only=True, data_only=True)


def open_workbook(path: Path) -> Workbook:
    """The workbook of a file.

    Raises
    ------
    InputError : openpyxl is not installed, the file is damaged, or no sheet has two rows of numbers alike.
    """
    form = CALLED["xlsx"]
    with reading(path, form):
        book = _book(path)
        try:
            heads = {s.title: list(islice(s.iter_rows(values_only=True), LOOKED_AT)) for s in book.worksheets}
        finally:
            book.close()
    several = len(heads) > 1
    tables = {name: heading(rows, name, f"{name}/" if several else "") for name, rows in heads.items()}
    sheets = [(name, table) for name, table in tables.items() if table is not None]
    if not sheets:
        expected = "a sheet with columns of numbers below a row of names"
        raise InputError(str(path), "", f"no table of numbers in the sheets {', '.join(heads)}", expected)
    channels = tuple(channel for _, table in sheets for channel in table.channels)
    return Workbook(path, form, channels, sheets)

"""Recordings as text tables: CSV and what loggers call so, with any separator, decimal sign and lines above."""

import csv
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Piece, Recording
from cdpr_struct.recordings.form import CALLED
from cdpr_struct.recordings.heading import LOOKED_AT, Heading, heading
from cdpr_struct.recordings.library import reading

_SEPARATORS = (";", "\t", ",", "|")
_SPACES = r"\s+"
_ROWS = 100_000  # read at once
_NANOSECOND = 1e-9
_MARKS = "#%"  # before the first name in some files
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")


@dataclass(frozen=True, slots=True, eq=False)
class TextTable(Recording):
    """A text table.

    separator, decimal, encoding : of the file;  first : number of its line, from 0, in which the numbers begin
    """

    separator: str
    decimal: str
    encoding: str
    first: int

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        import pandas as pd

        places = [i for i, channel in enumerate(self.channels) if channel.name in names]
        with reading(self.path, self.form):
            chunks = pd.read_csv(
                self.path, sep=self.separator, decimal=self.decimal, encoding=self.encoding, header=None,
                skiprows=self.first, names=list(range(len(self.channels))), usecols=places, chunksize=_ROWS,
                index_col=False, comment="#", skipinitialspace=True, encoding_errors="replace",
            )  # fmt: skip
            for chunk in chunks:
                for place in places:
                    yield Piece(self.channels[place].name, numbers(chunk[place], self.decimal))


def numbers(cells: object, decimal: str = ".") -> np.ndarray:
    """Cells (n,) of a pandas column as numbers; instants as seconds since 1970; nan where a cell holds neither."""
    import pandas as pd

    column = pd.Series(cells)
    if column.dtype.kind not in "OTUS":
        return np.asarray(column, dtype=float)
    words = column.astype("string")
    found = pd.to_numeric(words.str.replace(",", ".") if decimal == "," else words, errors="coerce")
    if not found.notna().any():
        instants = pd.to_datetime(words, errors="coerce", format="ISO8601", utc=True)
        if instants.notna().any():
            since = instants.dt.as_unit("ns").astype("int64").to_numpy().astype(float) * _NANOSECOND
            return np.where(instants.notna().to_numpy(), since, np.nan)
    return found.to_numpy(dtype=float, na_value=np.nan)


def open_text(path: Path) -> TextTable:
    """The text table of a file.

    Raises
    ------
    InputError : it has no two rows of numbers alike.
    """
    form = CALLED["text"]
    encoding = _encoding(path)
    with reading(path, form), path.open(encoding=encoding, errors="replace", newline=None) as file:
        lines = list(islice(file, LOOKED_AT))
    found = [(separator, table) for separator in (*_SEPARATORS, _SPACES) if (table := _table(lines, separator))]
    if not found:
        expected = "columns of numbers below a line of names, separated by commas, semicolons, tabs or spaces"
        raise InputError(str(path), "", f"no table of numbers in its first {len(lines)} lines", expected)
    separator, table = max(found, key=lambda pair: len(pair[1].channels))
    decimal = _decimal(lines[table.first :], separator)
    return TextTable(path, form, table.channels, separator, decimal, encoding, table.first)


def _encoding(path: Path) -> str:
    with path.open("rb") as file:
        head = file.read(65536)
    if head.startswith(_UTF_16):
        return "utf-16"
    try:
        head[:-4].decode("utf-8-sig")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def _table(lines: Sequence[str], separator: str) -> Heading | None:
    """The table that lines hold if columns are separated so."""
    return heading([_cells(line, separator) for line in lines])


def _cells(line: str, separator: str) -> list[str]:
    line = line.strip("\r\n").removeprefix("\ufeff").lstrip(_MARKS)
    if separator == _SPACES:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:
        return []


def _decimal(lines: Sequence[str], separator: str) -> str:
    cells = [cell for line in lines for cell in _cells(line, separator)]
    commas = sum("," in cell for cell in cells)
    return "," if separator != "," and commas > sum("." in cell for cell in cells) else "."

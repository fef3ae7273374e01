"""A CSV file as text cells under named columns, whatever program wrote it."""

import csv
import io
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cdpr_struct.errors import InputError, not_utf8
from cdpr_struct.measurement.conversion import converted, is_excel_mark, text_command
from cdpr_struct.measurement.foreign_file import refuse_foreign

_HEADER = "a CSV file with a header line"
_SEPARATORS = {";": "';'", "\t": "tabs", "|": "'|'", " ": "spaces"}
_SHOWN = 8  # values of a row that does not fit: of more, their number is said
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")


@dataclass(frozen=True, slots=True, eq=False)
class DataTable:
    """Text cells of a CSV file.

    names : of the c columns, as in the header but without spaces around them; "" of a column without a name
    rows  : n rows of c cells, without spaces around them; more only in a row that has more values than the header
    line  : n numbers of the rows' lines in the file, from 1
    """

    file: str
    names: tuple[str, ...]
    rows: Sequence[Sequence[str]]
    line: Sequence[int]

    def column(self, name: str) -> list[str]:
        """Cells (n,) of a column.

        Raises
        ------
        InputError : two columns of that name.
        """
        if Counter(self.names)[name] > 1:
            raise InputError(self.file, "header", f"{name} twice", "each column once")
        place = self.names.index(name)
        return [row[place] for row in self.rows]

    def require_rows(self) -> None:
        """Refuse a table that is a header only, and rows that do not fit to the header.

        Raises
        ------
        InputError : no rows, or one with more values than the header has names.
        """
        if not self.rows:
            raise InputError(self.file, "", "no rows", "at least one row of data below the header")
        for number, (row, line) in enumerate(zip(self.rows, self.line, strict=True), start=1):
            if len(row) > len(self.names):
                expected = f"{len(self.names)} values as in the header, decimals with a point"
                expected += " (are they commas?)" if len(row) > len(self.names) + 1 else ""
                given = ", ".join(row) if len(row) <= _SHOWN else f"{len(row)} values"
                raise InputError(self.file, f"row {number}, line {line}", given, expected)


def read_table(path: Path) -> DataTable:
    """Table of a CSV file: UTF-8, with or without byte order mark; lines that begin with # and empty ones are left out.

    Commas at the ends of lines, and nameless columns without a value, are no columns.

    Raises
    ------
    InputError : no such file, a workbook or other binary file, another encoding or separator (each with the command
                 that converts it), or no header line.
    """
    try:
        content = path.read_bytes()
    except (OSError, ValueError) as error:
        raise InputError(str(path), "", getattr(error, "strerror", None) or str(error), _HEADER) from error
    refuse_foreign(path, content)
    text = _decoded(path, content)
    lines = _table_lines(text)
    if not lines:
        raise InputError(str(path), "", "an empty file", _HEADER)
    _check_separator(path, text, lines[0][1])
    try:
        return _table(str(path), lines)
    except csv.Error as error:
        raise InputError(str(path), "", str(error), _HEADER) from error


def _decoded(path: Path, content: bytes) -> str:
    if content.startswith(_UTF_16):
        text = content.decode("utf-16", "replace")
        raise _other_encoding(path, text, "text in UTF-16", "a text file in UTF-8", "utf-16")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        told = not_utf8(str(path), error)
        raise _other_encoding(path, content.decode("latin-1"), str(told.value), told.expected, "cp1252") from error


def _other_encoding(path: Path, text: str, value: str, expected: str, encoding: str) -> InputError:
    lines = _table_lines(text)
    separator = _separator(lines[0][1]) if lines else ","
    return InputError(str(path), "", value, f"{expected}. {_convert(path, text, separator, encoding)}")


def _convert(path: Path, text: str, separator: str, encoding: str | None = None) -> str:
    return f"Convert it: {text_command(path, text, separator, encoding)}, and give {converted(path).name}"


def _table_lines(text: str) -> list[tuple[int, str]]:
    """Lines of the table with their numbers in the file."""
    numbered = enumerate(io.StringIO(text, newline=None), start=1)
    lines = [(number, line) for number, line in numbered if line.strip() and not line.startswith("#")]
    return lines[1:] if lines and is_excel_mark(lines[0][1]) else lines


def _separator(header: str) -> str:
    """The sign between names of a header."""
    often = max(_SEPARATORS, key=lambda mark: header.count(mark) if mark != " " else 0)
    if header.count(often) > header.count(","):
        return often
    return " " if "," not in header and len(header.split()) > 2 else ","


def _check_separator(path: Path, text: str, header: str) -> None:
    separator = _separator(header)
    if separator != ",":
        expected = "columns separated by commas, decimals with a point. " + _convert(path, text, separator)
        raise InputError(str(path), "header", f"columns separated by {_SEPARATORS[separator]}", expected)


def _table(file: str, lines: list[tuple[int, str]]) -> DataTable:
    reader = csv.reader((line for _, line in lines), skipinitialspace=True)
    names = [name.strip() for name in next(reader)]
    while names and not names[-1]:
        names.pop()
    _check_header(file, names)
    rows: list[list[str]] = []
    places: list[int] = []
    for row in reader:
        cells = _cells(row, len(names))
        if any(cells):
            rows.append(cells)
            places.append(lines[reader.line_num - 1][0])
    empty = {i for i, name in enumerate(names) if not name and not any(row[i] for row in rows)}
    if empty:
        names, *rows = ([cell for i, cell in enumerate(row) if i not in empty] for row in (names, *rows))
    return DataTable(file, tuple(names), rows, places)


def _check_header(file: str, names: list[str]) -> None:
    if names and all(_is_number(name) for name in names):
        expected = "a first line that names the columns; a line that begins with # is a comment"
        raise InputError(file, "header", ",".join(names), expected)


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _cells(row: list[str], width: int) -> list[str]:
    """Cells of a row, `width` of them or more, without empty ones behind these and without a remark after a #."""
    cells = list(map(str.strip, row))
    if len(cells) == width and "#" not in cells[-1]:  # of most rows, and records have a million of them
        return cells
    for i in range(max(width - 1, 0), len(cells)):
        if "#" in cells[i]:
            cells[i:] = [cells[i].partition("#")[0].strip()]
            break
    while len(cells) > width and not cells[-1]:
        cells.pop()
    return cells + [""] * (width - len(cells))

"""Do two runs of one command say the same? Numbers of result.json and of the CSV tables, key by key."""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cdpr_struct.cli.run_record import RUN
from cdpr_struct.cli.written_files import RESULT
from cdpr_struct.errors import InputError
from cdpr_struct.reports.plain_json import SCHEMA

_OF_THE_RUN = {"files", RUN, "command", "seconds", SCHEMA}  # not of the result
_ZERO = 1e-12  # sizes that are rounding in SI units


@dataclass(frozen=True, slots=True)
class Difference:
    """A key under which two runs differ.

    file, key : where: the file, and the key of result.json or the column of a table
    was, now  : the values that differ most
    relative  : the difference over the largest number under this key; nan where words or the number of values differ
    count     : values under this key that differ
    """

    file: str
    key: str
    was: Any
    now: Any
    relative: float
    count: int


def read_result(directory: Path) -> dict[str, Any]:
    """The result.json of a directory.

    Raises
    ------
    InputError : it cannot be read, or is none.
    """
    try:
        found = json.loads((directory / RESULT).read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise InputError("RESULT", "", str(directory / RESULT), "a result.json that a command wrote") from error
    if not isinstance(found, dict):
        raise InputError("RESULT", "", str(directory / RESULT), "a result.json that a command wrote")
    return found


def compared(was: Path, now: Path, tolerance: float) -> tuple[list[Difference], int]:
    """Differences of two directories of results, and how many values were compared.

    tolerance : largest difference of numbers that are the same, over the largest number under their key
    """
    differences, count = [], 0
    for file in _files(was, now):
        before, after = _values(was / file), _values(now / file)
        for key in dict.fromkeys([*before, *after]):
            old, new = before.get(key, []), after.get(key, [])
            count += max(len(old), len(new))
            if (found := _difference(file, key, old, new, tolerance)) is not None:
                differences.append(found)
    return differences, count


def _files(was: Path, now: Path) -> list[str]:
    tables = {path.name for folder in (was, now) for path in folder.glob("*.csv")}
    return [RESULT, *sorted(tables)]


def _values(path: Path) -> Mapping[str, list[Any]]:
    """Values of a file by key or column; none of a file that is not there."""
    if path.name == RESULT:
        found: dict[str, list[Any]] = {}
        for key, value in _leaves({k: v for k, v in read_result(path.parent).items() if k not in _OF_THE_RUN}):
            found.setdefault(key, []).append(value)
        return found
    if not path.exists():
        return {}
    import pandas as pd

    try:
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        raise InputError(str(path), "", "no table that can be read", "a CSV file as the command wrote it") from error
    return {str(name): table[name].tolist() for name in table}


def _leaves(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """Numbers and words with the names that lead to them; places in lists are no names."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from _leaves(inner, f"{key}.{name}" if key else name)
    elif isinstance(value, list):
        for inner in value:
            yield from _leaves(inner, key)
    else:
        yield key, value


def _difference(file: str, key: str, old: list[Any], new: list[Any], tolerance: float) -> Difference | None:
    if len(old) != len(new):
        return Difference(file, key, f"{len(old)} values", f"{len(new)} values", math.nan, abs(len(old) - len(new)))
    largest = max([abs(v) for v in (*old, *new) if _is_number(v) and math.isfinite(v)], default=0.0)
    allowed = max(tolerance * largest, _ZERO)
    off = [(a, b) for a, b in zip(old, new, strict=True) if not _same(a, b, allowed)]
    if not off:
        return None
    a, b = max(off, key=lambda pair: _gap(*pair))
    return Difference(file, key, a, b, _gap(a, b) / largest if _gap(a, b) < math.inf else math.nan, len(off))


def _same(a: Any, b: Any, allowed: float) -> bool:
    if _is_number(a) and _is_number(b):
        return bool(a == b or abs(a - b) <= allowed or (math.isnan(a) and math.isnan(b)))
    return bool(a == b)


def _gap(a: Any, b: Any) -> float:
    """Difference of two numbers, infinite where one is none."""
    if not (_is_number(a) and _is_number(b) and math.isfinite(a) and math.isfinite(b)):
        return math.inf
    return float(abs(a - b))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)

"""Which set of wrenches is meant: the rows of a CSV file, or the corners of ranges like `fx=-100:100,mz=-5:5`."""

import csv
import os
from collections.abc import Iterable
from itertools import product
from pathlib import Path
from typing import TypeAlias

import numpy as np

from cdpr_struct.errors import InputError, known_names
from cdpr_struct.interface.arguments import LARGEST

WrenchesLike: TypeAlias = str | os.PathLike[str] | Iterable[Iterable[float]]
"""Path of a CSV file, ranges as text, or rows of six numbers [N, N m]."""
COLUMNS = ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")
_PARTS = tuple(name.partition("_")[0] for name in COLUMNS)
_MOST = 4096  # wrenches: each is balanced at every pose
_FORM = "give a CSV file, or ranges of fx, fy, fz [N], mx, my, mz [N m] like fx=-100:100,mz=-5:5"
Wrenches: TypeAlias = tuple[tuple[float, ...], ...]


def read_wrenches(given: WrenchesLike) -> Wrenches:
    """Wrenches on the platform beside its load, about its origin, world axes [N, N m].

    Raises
    ------
    InputError : neither ranges nor a CSV file of `COLUMNS`, or numbers out of range.
    """
    if isinstance(given, str) and "=" in given:
        return _corners(given)
    if isinstance(given, str | os.PathLike):
        return _of_file(os.fspath(given))
    try:
        rows = np.array([list(row) for row in given], dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError("wrenches", "", given, "rows of six numbers in N and N m") from error
    if rows.ndim != 2 or rows.shape[1] != 6 or not len(rows) or not (np.abs(rows) <= LARGEST).all():
        raise InputError("wrenches", "", rows.tolist(), "rows of six numbers in N and N m")
    return _checked(rows)


def _corners(text: str) -> Wrenches:
    ends: dict[str, tuple[float, float]] = {}
    for part in text.split(","):
        name, _, values = part.partition("=")
        low, _, high = values.partition(":")
        try:
            pair = float(low), float(high or low)
        except ValueError as error:
            raise InputError("wrenches", "", part, _FORM) from error
        name = name.strip()
        if name not in _PARTS or name in ends or not -LARGEST <= pair[0] <= pair[1] <= LARGEST:
            raise InputError("wrenches", "", part, f"{_FORM}, each once and ascending")
        ends[name] = pair
    return _checked(np.array(list(product(*(sorted(set(ends.get(name, (0.0, 0.0)))) for name in _PARTS)))))


def _of_file(path: str) -> Wrenches:
    try:
        rows = list(csv.DictReader(Path(path).read_text("utf-8-sig").splitlines()))
    except (OSError, ValueError) as error:
        raise InputError("wrenches", "", path, f"a file that can be read, or {_FORM[5:]}") from error
    if not rows:
        raise InputError(path, "", "no rows", f"a row for each wrench, columns {', '.join(COLUMNS)}")
    for name in rows[0]:
        if name not in COLUMNS:
            known = known_names(str(name), COLUMNS)
            raise InputError(path, str(name), "a column", f"no such column; {known}; those left out are zero")
    found = []
    for number, row in enumerate(rows, start=2):
        for name, text in row.items():
            if not _is_number(text):
                raise InputError(path, f"line {number}, {name}", text or "nothing", "a finite number")
        found.append([float(row.get(name) or 0.0) for name in COLUMNS])
    return _checked(np.array(found))


def _is_number(text: str | None) -> bool:
    try:
        return abs(float(text or "")) <= LARGEST
    except ValueError:
        return False


def _checked(rows: np.ndarray) -> Wrenches:
    if len(rows) > _MOST:
        raise InputError("wrenches", "", f"{len(rows)} wrenches", f"at most {_MOST}")
    return tuple(tuple(row) for row in rows.tolist())

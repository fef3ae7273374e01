"""Datasets of a universal file, one by one: what a vendor's other datasets hold does not matter."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyuff

from cdpr_struct.errors import InputError

UNITS = 164


@dataclass(frozen=True, slots=True, eq=False)
class Units:
    """What lengths and forces are divided by to become m and N (dataset 164)."""

    length: float = 1.0
    force: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class UniversalSet:
    """A dataset.

    number : in the file, from 1;  kind : of the dataset;  values : in pyuff's form
    units  : of the file where it stands
    """

    number: int
    kind: int
    values: dict[str, Any]
    units: Units


def sets_of(path: Path, kinds: Collection[int]) -> Iterator[UniversalSet]:
    """Datasets of some kinds, with the units (dataset 164) that hold for each.

    Raises
    ------
    InputError : no universal file, or a dataset that pyuff cannot read: its number and kind.
    """
    file = _file(path)
    units = Units()
    for number, kind in enumerate(map(int, file.get_set_types()), start=1):
        if kind in (UNITS, *kinds):
            try:
                values = file.read_sets(number - 1)
            except Exception as error:  # pyuff raises whatever its parsing runs into
                raise _damaged(path, number, kind) from error
            if kind == UNITS:
                units = _units(path, number, values)
            if kind in kinds:
                yield UniversalSet(number, kind, dict(values), units)


def kinds_of(path: Path) -> list[int]:
    """Kinds of all datasets of a file, in their order.

    Raises
    ------
    InputError : no universal file.
    """
    return [int(kind) for kind in _file(path).get_set_types()]


def _file(path: Path) -> Any:
    try:
        file = pyuff.UFF(str(path))
        found = file.get_n_sets()
    except Exception as error:
        raise _no_universal_file(path) from error
    if not found:
        raise _no_universal_file(path)
    return file


def _no_universal_file(path: Path) -> InputError:
    return InputError(str(path), "", path.name, "a universal file with datasets 58 that can be read")


def _damaged(path: Path, number: int, kind: int) -> InputError:
    given = f"dataset {number} of the file, of type {kind}, that cannot be read"
    return InputError(str(path), f"dataset {number}", given, f"a whole dataset {kind}, or the file without it")


def _units(path: Path, number: int, values: dict[str, Any]) -> Units:
    length, force = float(values["length"]), float(values["force"])
    if not (0.0 < length < float("inf") and 0.0 < force < float("inf")):
        given = f"factors {length:g} and {force:g}"
        raise InputError(str(path), f"dataset {number} (164, units)", given, "factors of length and force above zero")
    return Units(length, force)

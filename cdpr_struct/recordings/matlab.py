"""Recordings as MATLAB files up to version 7: variables, and structures of them."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat, whosmat

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Channel, Piece, Recording
from cdpr_struct.recordings.form import CALLED
from cdpr_struct.recordings.library import reading
from cdpr_struct.recordings.matlab_names import column, columns

_FORM = CALLED["mat"]


@dataclass(frozen=True, slots=True, eq=False)
class MatFile(Recording):
    """A MATLAB file; only the variables that are asked for are loaded."""

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        with reading(self.path, self.form):
            for variable in {name.partition(".")[0].partition("(")[0]: None for name in names}:
                for path, values in _arrays(variable, _load(self.path, variable)):
                    for name, place in columns(path, values.shape):
                        if name in names:
                            yield Piece(name, np.asarray(column(values, place), dtype=float))


def _load(path: Path, variable: str) -> Any:
    return loadmat(path, variable_names=[variable], simplify_cells=True).get(variable)


def _arrays(path: str, value: object) -> Iterator[tuple[str, np.ndarray]]:
    """Arrays of real numbers in a variable, under names such as log.pose.x."""
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _arrays(f"{path}.{name}", inner)
    elif isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
        yield path, value


def open_mat(path: Path) -> MatFile:
    """The channels of a MATLAB file.

    Raises
    ------
    InputError : the file is damaged, or holds no array of numbers.
    """
    with reading(path, _FORM):
        variables = [name for name, _, _ in whosmat(path)]
        arrays = [pair for name in variables for pair in _arrays(name, _load(path, name))]
    channels = [Channel(name, path.rpartition(".")[0]) for path, a in arrays for name, _ in columns(path, a.shape)]
    if not channels:
        expected = "arrays or structures of arrays; save a timetable or timeseries as such: t = x.Time; v = x.Data"
        raise InputError(str(path), "", f"no array of numbers ({', '.join(variables) or 'no variable'})", expected)
    return MatFile(path, _FORM, tuple(channels))

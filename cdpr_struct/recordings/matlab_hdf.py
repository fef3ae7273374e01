"""Recordings as MATLAB files of version 7.3, which are HDF5 files."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Channel, Piece, Recording
from cdpr_struct.recordings.form import CALLED
from cdpr_struct.recordings.library import library, reading
from cdpr_struct.recordings.matlab_names import column, columns

_FORM = CALLED["mat73"]
_ROWS = 100_000  # samples read at once
_REFERENCES = "#"  # begins the names of what cells and objects refer to


@dataclass(frozen=True, slots=True, eq=False)
class MatHdf(Recording):
    """A MATLAB file of version 7.3, read in pieces."""

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        with reading(self.path, self.form), _open(self.path) as file:
            for path, data in _arrays(file):
                for name, place in columns(path, data.shape[::-1]):
                    if name in names:
                        for part in _parts(data):
                            yield Piece(name, np.asarray(column(part.T, place), dtype=float))


def _parts(data: Any) -> Iterator[np.ndarray]:
    """An array in parts along its longer side, as HDF5 has it: transposed. Each is longer than it is wide."""
    axis = int(np.argmax(data.shape))
    step = max(_ROWS, 2 * min(data.shape))
    starts = list(range(0, data.shape[axis], step))
    if len(starts) > 1 and data.shape[axis] - starts[-1] <= min(data.shape):
        starts.pop()
    for first, end in zip(starts, [*starts[1:], data.shape[axis]], strict=True):
        yield data[first:end] if axis == 0 else data[:, first:end]


def _arrays(group: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Arrays of real numbers in a file, under names such as log.pose.x."""
    h5py = library("h5py", _FORM, Path(group.file.filename))
    for name, inner in group.items():
        own = f"{path}.{name}" if path else name
        if name.startswith(_REFERENCES):
            continue
        if isinstance(inner, h5py.Group):
            yield from _arrays(inner, own)
        elif isinstance(inner, h5py.Dataset) and _is_number(inner):
            yield own, inner


def _is_number(data: Any) -> bool:
    """Whether it is a vector or matrix, and none of MATLAB's texts, which are numbers in the file."""
    return (
        data.dtype.kind in "biuf"
        and 1 <= data.ndim <= 2
        and b"char" not in np.bytes_(data.attrs.get("MATLAB_class", b""))
    )


def _open(path: Path) -> Any:
    return library("h5py", _FORM, path).File(path, "r")


def open_mat_hdf(path: Path) -> MatHdf:
    """The channels of a MATLAB file of version 7.3.

    Raises
    ------
    InputError : h5py is not installed, the file is damaged, or holds no array of numbers.
    """
    with reading(path, _FORM), _open(path) as file:
        found = [
            Channel(name, own.rpartition(".")[0])
            for own, data in _arrays(file)
            for name, _ in columns(own, data.shape[::-1])
        ]
    if not found:
        expected = "arrays or structures of arrays; save a timetable or timeseries as such: t = x.Time; v = x.Data"
        raise InputError(str(path), "", "no array of numbers", expected)
    return MatHdf(path, _FORM, tuple(found))

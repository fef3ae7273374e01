"""Recordings as TDMS files (LabVIEW, DIAdem)."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Channel, Clock, Piece, Recording
from cdpr_struct.recordings.form import CALLED
from cdpr_struct.recordings.library import library, reading

_FORM = CALLED["tdms"]
_ROWS = 100_000  # samples read at once
_NANOSECOND = 1e-9
_STEP, _START, _OFFSET = "wf_increment", "wf_start_time", "wf_start_offset"


@dataclass(frozen=True, slots=True, eq=False)
class Tdms(Recording):
    """A TDMS file; a channel with a waveform's step has times of its own, those with a start on a common clock."""

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        with reading(self.path, self.form), _open(self.path) as file:
            channels = [c for c in _all(file) if _name(c) in names]
            starts = [start for c in channels if (start := _start(c)) is not None]
            first = min(starts, default=None)
            for channel in channels:
                start = _start(channel)
                begin = 0.0 if start is None or first is None else (start - first) * _NANOSECOND
                yield from _pieces(channel, begin)


def _pieces(channel: Any, begin: float) -> Iterator[Piece]:
    step, offset = channel.properties.get(_STEP), float(channel.properties.get(_OFFSET, 0.0))
    for first in range(0, len(channel), _ROWS):
        values = _plain(channel[first : first + _ROWS])
        time = None if not _timed(channel) else begin + offset + float(step) * (first + np.arange(len(values)))
        yield Piece(_name(channel), values, time)


def _plain(values: np.ndarray) -> np.ndarray:
    """Numbers; instants as seconds since 1970."""
    if values.dtype.kind == "M":
        return np.asarray(values.astype("datetime64[ns]").astype(np.int64).astype(float) * _NANOSECOND)
    return np.asarray(values, dtype=float)


def _timed(channel: Any) -> bool:
    step = channel.properties.get(_STEP)
    return isinstance(step, int | float) and step > 0.0


def _start(channel: Any) -> int | None:
    """Start of a waveform [ns since 1970]; None without one."""
    start = channel.properties.get(_START)
    if not _timed(channel) or not isinstance(start, np.datetime64) or np.isnat(start):
        return None
    return int(start.astype("datetime64[ns]").astype(np.int64))


def _name(channel: Any) -> str:
    return f"{channel.group_name}/{channel.name}"


def _all(file: Any) -> Iterator[Any]:
    """Channels that hold numbers or instants."""
    for group in file.groups():
        for channel in group.channels():
            if len(channel) and channel.dtype.kind in "biufM":
                yield channel


def _open(path: Path) -> Any:
    return library("nptdms", _FORM, path).TdmsFile.open(path)


def open_tdms(path: Path) -> Tdms:
    """The channels of a TDMS file.

    Raises
    ------
    InputError : npTDMS is not installed, the file is damaged, or has no channel of numbers.
    """
    with reading(path, _FORM), _open(path) as file:
        channels = tuple(_channel(one) for one in _all(file))
    if not channels:
        raise InputError(
            str(path), "", f"{_FORM} without a channel of numbers", "a file in which something was recorded"
        )
    return Tdms(path, _FORM, channels)


def _channel(channel: Any) -> Channel:
    unit = "s" if channel.dtype.kind == "M" else str(channel.properties.get("unit_string", ""))
    clock: Clock = "file" if _timed(channel) else ""
    return Channel(_name(channel), channel.group_name, unit, clock)

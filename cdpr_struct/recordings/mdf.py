"""Recordings as MDF files (ASAM, version 3 and 4)."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Channel, Piece, Recording
from cdpr_struct.recordings.form import CALLED
from cdpr_struct.recordings.library import library, reading
from cdpr_struct.recordings.mdf_links import check_links

_FORM = CALLED["mdf"]
_ROWS = 100_000  # samples read at once


class _Place(NamedTuple):
    """Where a channel is: numbers of its group and in it, and the samples of the group."""

    group: int
    channel: int
    samples: int


@dataclass(frozen=True, slots=True, eq=False)
class Mdf(Recording):
    """An MDF file.

    places : of each channel, in the order of `channels`
    """

    places: tuple[_Place, ...]

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        with reading(self.path, self.form), _open(self.path) as file:
            for channel, place in zip(self.channels, self.places, strict=True):
                if channel.name in names:
                    yield from _pieces(file, channel.name, place)


def _pieces(file: Any, name: str, place: _Place) -> Iterator[Piece]:
    """Samples of a channel in parts; those that the file marks as invalid are left out.

    Raises
    ------
    EOFError : the file holds fewer samples than it says.
    """
    for first in range(0, place.samples, _ROWS):
        rows = {"record_offset": first, "record_count": min(_ROWS, place.samples - first)}
        part = file.get(group=place.group, index=place.channel, **rows)
        values = np.asarray(part.samples)
        if not len(values) and not len(file.get_master(place.group, **rows)):
            raise EOFError(f"{place.samples} samples of {name} are said, and there are {first} at the most")
        if values.dtype.kind in "biuf" and values.ndim == 1:
            yield Piece(name, values.astype(float), np.asarray(part.timestamps, dtype=float))


def _open(path: Path) -> Any:
    reader = library("asammdf", _FORM, path)
    check_links(path, _FORM)
    return reader.MDF(path)


def open_mdf(path: Path) -> Mdf:
    """The channels of an MDF file.

    Raises
    ------
    InputError : asammdf is not installed, the file is damaged, or has no channel of numbers.
    """
    found: list[tuple[Channel, _Place]] = []
    with reading(path, _FORM), _open(path) as file:
        several = [name for name, places in file.channels_db.items() if len(places) > 1]
        for number, group in enumerate(file.groups):
            samples = int(group.channel_group.cycles_nr)
            for index, one in enumerate(group.channels):
                if samples and index != file.masters_db.get(number) and _is_number(file, number, index):
                    own = f"group {number}/{one.name}" if one.name in several else one.name
                    unit = str(file.get_channel_unit(group=number, index=index) or "")
                    found.append((Channel(own, str(number), unit, "file"), _Place(number, index, samples)))
    if not found:
        raise InputError(
            str(path), "", f"{_FORM} without a channel of numbers", "a file in which something was recorded"
        )
    return Mdf(path, _FORM, tuple(channel for channel, _ in found), tuple(place for _, place in found))


def _is_number(file: Any, group: int, index: int) -> bool:
    samples = np.asarray(file.get(group=group, index=index, record_offset=0, record_count=1).samples)
    return samples.dtype.kind in "biuf" and samples.ndim == 1

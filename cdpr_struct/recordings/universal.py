"""Recordings as universal files: datasets 58 that hold a signal in time."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.universal_file import TIME_RESPONSE
from cdpr_struct.measurement.universal_sets import UniversalSet, sets_of
from cdpr_struct.recordings.channel import Channel, Piece, Recording
from cdpr_struct.recordings.form import CALLED

_FORM = CALLED["uff"]
_SIGNAL = 58


@dataclass(frozen=True, slots=True, eq=False)
class UniversalSignals(Recording):
    """A universal file with signals in time, each on times of its own."""

    def pieces(self, names: Collection[str]) -> Iterator[Piece]:
        for name, one in _signals(self.path):
            if name in names:
                yield Piece(name, np.real(np.asarray(one.values["data"])).astype(float), np.asarray(one.values["x"]))


def open_universal(path: Path) -> UniversalSignals:
    """The signals of a universal file.

    Raises
    ------
    InputError : a dataset that cannot be read, or no signal in time.
    """
    channels = tuple(
        Channel(name, "", str(one.values.get("ordinate_axis_units_lab", "")).replace("NONE", "").strip(), "file")
        for name, one in _signals(path)
    )
    if not channels:
        expected = "a dataset 58 with function type 1, a signal in time; campaigns read FRFs and modes as they are"
        raise InputError(str(path), "", "no signal in time", expected)
    return UniversalSignals(path, _FORM, channels)


def _signals(path: Path) -> Iterator[tuple[str, UniversalSet]]:
    """Signals in time, called by their first line, or else by node and direction; equal names are numbered."""
    known: set[str] = set()
    for one in sets_of(path, (_SIGNAL,)):
        if one.values.get("func_type") != TIME_RESPONSE or "data" not in one.values:
            continue
        name = str(one.values.get("id1", "")).strip()
        if name in ("", "NONE"):
            name = f"node {one.values.get('rsp_node')}, direction {one.values.get('rsp_dir')}"
        name = f"{name} (dataset {one.number})" if name in known else name
        known.add(name)
        yield name, one

"""The quantities of a campaign along a recording: position, rotation, lengths and tensions in m, rad and N."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.channel import Recording
from cdpr_struct.recordings.mapping import MappingFile, RotationTable, ValuesTable
from cdpr_struct.recordings.signal import Signal, read_signals
from cdpr_struct.recordings.unit import Kind, called, factor

_NORM = 0.01  # by which the norm of a quaternion may differ from one
_LONG_AGO = 1e6  # s: a clock that counts from further back begins at the recording's first whole second


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """Rotations, platform to world, at times (n,) [s] that rise; name of the channel that they begin with."""

    name: str
    time: np.ndarray
    rotation: Rotation

    def at(self, time: np.ndarray) -> Rotation:
        """Along the shortest turn between neighbours, at times (k,) within the recording."""
        if len(self.time) == 1:
            return self.rotation[np.zeros(len(time), dtype=int)]
        return Slerp(self.time, self.rotation)(np.clip(time, self.time[0], self.time[-1]))


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """Signals in SI units on a common clock.

    position : three, or none;  lengths, tensions : one a cable, None where it has no sensor; () if not mapped
    zero     : what was subtracted from the times of the file [s]
    notes    : sentences on what a reader must know
    """

    position: tuple[Signal, ...]
    rotation: Turning | None
    lengths: tuple[Signal | None, ...]
    tensions: tuple[Signal | None, ...]
    zero: float
    notes: tuple[str, ...]

    def signals(self) -> Iterator[Signal | Turning]:
        """All that there are, the position first."""
        yield from self.position
        yield from (self.rotation,) if self.rotation is not None else ()
        yield from (signal for signal in (*self.lengths, *self.tensions) if signal is not None)


def measure(recording: Recording, mapping: MappingFile, source: str) -> Measured:
    """The quantities that a mapping names.

    Raises
    ------
    InputError : a channel, unit, time or sample that cannot be used.
    """
    tables = [table for table in (mapping.position, mapping.rotation, mapping.lengths, mapping.tensions) if table]
    names = [name for table in tables for name in table.channels if name]
    leave_out = mapping.sampling.faulty == "leave_out"
    found = read_signals(recording, names, mapping.time, source, leave_out)
    begin = min(float(signal.time[0]) for signal in found.values())
    zero = float(np.floor(begin)) if abs(begin) > _LONG_AGO else min(begin, 0.0)
    found = {name: replace(signal, time=signal.time - zero) for name, signal in found.items()}
    units, notes = _Units(recording, source), [*_left_out(found), *_clocks(recording, names)]
    return Measured(
        _values(mapping.position, "position", "length", found, units),
        None if mapping.rotation is None else _turning(mapping.rotation, found, units, str(recording.path)),
        _cables(mapping.lengths, "lengths", "length", found, units),
        _cables(mapping.tensions, "tensions", "force", found, units),
        zero,
        (*notes, *units.notes),
    )


class _Units:
    """Factors of channels to SI units: as the mapping says, or else the file."""

    def __init__(self, recording: Recording, source: str) -> None:
        self.said = {channel.name: channel.unit for channel in recording.channels}
        self.source = source
        self.notes: list[str] = []

    def factor(self, unit: str, name: str, kind: Kind, table: str) -> float:
        told = self.said[name]
        if unit and told and called(unit) != called(told):
            self.notes.append(f"The file says that {name} is in {told}; it was read in {unit}, as the mapping says.")
        return factor(unit or told, kind, self.source, f"{table}.unit")


def _values(
    table: ValuesTable | None, name: str, kind: Kind, found: dict[str, Signal], units: _Units
) -> tuple[Signal, ...]:
    return tuple(signal for signal in _cables(table, name, kind, found, units) if signal is not None)


def _cables(
    table: ValuesTable | None, name: str, kind: Kind, found: dict[str, Signal], units: _Units
) -> tuple[Signal | None, ...]:
    if table is None:
        return ()
    factors, offsets = (_each(given, len(table.channels)) for given in (table.factor, table.offset))
    signals: list[Signal | None] = []
    for channel, times, plus in zip(table.channels, factors, offsets, strict=True):
        if not channel:
            signals.append(None)
            continue
        raw = found[channel]
        values = times * units.factor(table.unit, channel, kind, name) * raw.values + plus
        signals.append(Signal(channel, raw.time - table.delay_s, values, raw.left_out))
    return tuple(signals)


def _each(given: float | Sequence[float], count: int) -> Sequence[float]:
    return given if isinstance(given, Sequence) else [given] * count


def _turning(table: RotationTable, found: dict[str, Signal], units: _Units, file: str) -> Turning:
    signals = [found[name] for name in table.channels]
    for signal in signals[1:]:
        if not np.array_equal(signal.time, signals[0].time):
            expected = "channels of a rotation that are sampled at the same times; those of one group or topic are"
            raise InputError(file, signal.name, f"other times than {signals[0].name}", expected)
    values = np.stack([signal.values for signal in signals], axis=1)
    if table.form == "quaternion":
        rotation = _of_quaternions(table, values, file)
    else:
        values = values * [units.factor(table.unit, name, "angle", "rotation") for name in table.channels]
        vector = table.form == "rotation_vector"
        rotation = Rotation.from_rotvec(values) if vector else Rotation.from_euler(table.order, values)
    return Turning(table.channels[0], signals[0].time - table.delay_s, rotation.inv() if table.inverse else rotation)


def _of_quaternions(table: RotationTable, values: np.ndarray, file: str) -> Rotation:
    norm = np.linalg.norm(values, axis=1)
    bad = np.flatnonzero(np.abs(norm - 1.0) > _NORM)
    if len(bad):
        expected = "unit quaternions; are these the right channels?"
        given = f"norm {norm[bad[0]]:.4g} in sample {bad[0] + 1}"
        raise InputError(file, f"{table.channels[0]} to {table.channels[-1]}", given, expected)
    return Rotation.from_quat(values[:, [table.order.index(part) for part in "xyzw"]])


def _left_out(found: dict[str, Signal]) -> Iterator[str]:
    faulty = {name: signal.left_out for name, signal in found.items() if signal.left_out}
    if faulty:
        worst = max(faulty, key=lambda name: faulty[name])
        yield (
            f"{sum(faulty.values())} faulty samples of {len(faulty)} channels were left out, most of {worst} "
            f"({faulty[worst]})."
        )


def _clocks(recording: Recording, names: Sequence[str]) -> Iterator[str]:
    """A sentence where some channels have times of their headers and others those of the recorder."""
    clocks = {channel.name: channel.clock for channel in recording.channels if channel.name in names}
    late = [name for name, clock in clocks.items() if clock == "received"]
    if late and "stamp" in clocks.values():
        yield (
            f"{late[0]} has no stamp, so that its times are those of the recorder; other channels have stamps. "
            'clock = "received" under [time] takes one clock for all.'
        )

"""Samples of mapped channels on their own times: complete, rising, and in one file's clock."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cdpr_struct.errors import NOTHING, InputError, known_names
from cdpr_struct.recordings.channel import Channel, Recording
from cdpr_struct.recordings.mapping import TimeTable
from cdpr_struct.recordings.unit import factor

_LARGEST = 1e12  # of a reading; 1e18 ns since 1970 are within a time channel's
_LARGEST_TIME = 1e20
_SHOWN = 60  # channels that are listed where one is not known


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """Samples (n,) of a channel as the file has them, at times (n,) [s] that rise.

    left_out : faulty samples that are not among them
    """

    name: str
    time: np.ndarray
    values: np.ndarray
    left_out: int = 0


def read_signals(
    recording: Recording, names: Sequence[str], time: TimeTable, source: str, leave_out: bool
) -> dict[str, Signal]:
    """Signals of the named channels.

    source    : the mapping file, for complaints
    leave_out : samples that are no numbers, or whose time does not rise, are left out and counted

    Raises
    ------
    InputError : a channel that is not there or empty, no times, times that do not rise, or samples that are no numbers.
    """
    known = {channel.name: channel for channel in recording.channels}
    _require(recording.path, known, names, source)
    clocks = _clocks(recording, known, names, time, source)
    values, own = _collected(recording, [*names, *(c for c in clocks.values() if c)])
    scale = factor(time.unit or _unit(known, clocks), "time", source, "time.unit") if any(clocks.values()) else 1.0
    found = {}
    for name in names:
        if not len(values[name]):
            raise InputError(str(recording.path), name, "no samples", "a channel in which something was recorded")
        times = _times(recording.path, name, values, own, clocks[name], scale, time.rate_hz)
        found[name] = _sound(recording.path, name, times, values[name], leave_out)
    return found


def _require(path: Path, known: Mapping[str, Channel], names: Iterable[str], source: str) -> None:
    for name in names:
        if name not in known:
            all_names = list(known)
            shown = all_names[:_SHOWN] + ([f"{len(all_names) - _SHOWN} more"] if len(all_names) > _SHOWN else [])
            alike = next((one for one in all_names if one.lower() == name.lower()), "")
            meant = known_names(name, all_names, shown)
            if alike:
                meant = f"{alike} is perhaps meant; known are {', '.join(shown)}"
            expected = f"a channel of {path.name}; {meant}"
            raise InputError(source, "channels", name, expected)


def _clocks(
    recording: Recording, known: Mapping[str, Channel], names: Sequence[str], time: TimeTable, source: str
) -> dict[str, str]:
    """Of each channel the one that holds its times; "" where the file says them itself, or a rate does."""
    given = [time.channel] if isinstance(time.channel, str) else list(time.channel or ())
    _require(recording.path, known, given, source)
    by_group = {known[name].group: name for name in given}
    found = {}
    for name in names:
        channel = known[name]
        if (channel.clock and not given) or time.rate_hz is not None:
            found[name] = ""
        elif given:
            found[name] = by_group.get(channel.group, given[0])
        else:
            near = [c.name for c in recording.channels if c.name.lower().rpartition("/")[2].startswith(("t", "zeit"))]
            expected = f"the channel of the time of {name}, which the file itself does not say"
            expected += f"; {near[0]} is perhaps meant" if near else ", or rate_hz"
            raise InputError(source, "time.channel", NOTHING, expected)
    return found


def _unit(known: Mapping[str, Channel], clocks: Mapping[str, str]) -> str:
    return next((known[name].unit for name in clocks.values() if name and known[name].unit), "")


def _collected(recording: Recording, names: Sequence[str]) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """All values of channels, and their times where the file says them."""
    values: dict[str, list[np.ndarray]] = {name: [] for name in names}
    times: dict[str, list[np.ndarray]] = {name: [] for name in names}
    for piece in recording.pieces(set(names)):
        values[piece.channel].append(piece.values)
        if piece.time is not None:
            times[piece.channel].append(piece.time)
    empty = np.zeros(0)
    whole = {name: np.concatenate(parts) if parts else empty for name, parts in values.items()}
    return whole, {name: np.concatenate(parts) for name, parts in times.items() if parts}


def _times(
    path: Path, name: str, values: Mapping[str, np.ndarray], own: Mapping[str, np.ndarray], clock: str, scale: float,
    rate: float | None,
) -> np.ndarray:  # fmt: skip
    """(n,) times of a channel [s]."""
    count = len(values[name])
    if rate is not None:
        return np.arange(count) / rate
    if not clock:
        return own[name]
    if len(values[clock]) != count:
        given = f"{count} samples, and {len(values[clock])} of the time {clock}"
        raise InputError(str(path), name, given, "as many times as samples; [time] channel may be a list, one a group")
    return scale * values[clock]


def _sound(path: Path, name: str, time: np.ndarray, values: np.ndarray, leave_out: bool) -> Signal:
    """The signal without faulty samples, or a complaint about the first one."""
    number = (np.abs(values) <= _LARGEST) & (np.abs(time) <= _LARGEST_TIME)
    latest = np.maximum.accumulate(np.where(number, time, -np.inf))
    rising = np.append(True, time[1:] > latest[:-1])
    good = number & rising
    if good.all():
        return Signal(name, time, values)
    if not leave_out:
        raise _faulty(path, name, time, number, rising)
    if not good.any():
        raise InputError(str(path), name, "no number among its samples", "a channel in which something was recorded")
    return Signal(name, time[good], values[good], int((~good).sum()))


def _faulty(path: Path, name: str, time: np.ndarray, number: np.ndarray, rising: np.ndarray) -> InputError:
    how = 'or faulty = "leave_out" under [sampling]'
    if not number.all():
        first = int(np.flatnonzero(~number)[0])
        given = f"{int((~number).sum())} of {len(number)} samples that are no numbers, the first is sample {first + 1}"
        return InputError(str(path), name, given, f"finite numbers, {how}")
    first = int(np.flatnonzero(~rising)[0])
    given = f"{int((~rising).sum())} times that do not rise: sample {first + 1} at {time[first]:.9g} s"
    return InputError(str(path), name, f"{given} after {time[first - 1]:.9g} s", f"times that rise, {how}")

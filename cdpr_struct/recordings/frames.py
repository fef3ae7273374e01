"""States of a campaign from a recording: one a frame of a motion, or one a stretch in which the robot stands still."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.mapping import SamplingTable
from cdpr_struct.recordings.measured import Measured, Turning
from cdpr_struct.recordings.signal import Signal

_GAP = 5.0  # median steps of a channel: a longer step is a gap, unless the mapping says otherwise
MOST = 20_000  # states of a campaign


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """States (k,) at rising times [s].

    position : (k, 3) [m];  rotation : k;  lengths : (k, m) [m];  tensions : (k, m) [N], nan where not read
    sigma    : of readings whose scatter was measured, by their keys in campaign.toml
    said     : how they came about, in a sentence
    left_out : frames that lie in gaps
    """

    time: np.ndarray
    position: np.ndarray | None
    rotation: Rotation | None
    lengths: np.ndarray | None
    tensions: np.ndarray | None
    said: str
    sigma: Mapping[str, float] = field(default_factory=dict)
    left_out: int = 0


def common_span(measured: Measured, sampling: SamplingTable, file: str) -> tuple[float, float]:
    """Begin and end [s] of what all signals cover, within the span that is asked for.

    Raises
    ------
    InputError : there is no such time.
    """
    signals = list(measured.signals())
    last = max(signals, key=lambda signal: float(signal.time[0]))
    first = min(signals, key=lambda signal: float(signal.time[-1]))
    begin, end = float(last.time[0]), float(first.time[-1])
    if begin > end:
        given = f"{first.name} ends at {end:.6g} s, {last.name} begins at {begin:.6g} s"
        raise InputError(file, "", given, "channels that were recorded at the same time, on the same clock")
    if sampling.span is None:
        return begin, end
    low, high = max(begin, sampling.span[0]), min(end, sampling.span[1])
    if low > high:
        zero = f" (0 is {measured.zero:.12g} s of the file)" if measured.zero else ""
        expected = f"a span within the recording, whose channels all cover {begin:.6g} to {end:.6g} s{zero}"
        raise InputError(file, "sampling.span", sampling.span, expected)
    return low, high


def moving_frames(measured: Measured, sampling: SamplingTable, file: str) -> Frames:
    """Frames of a motion: at the samples of the first channel, or evenly if a rate is given.

    Raises
    ------
    InputError : no common time, no frame, or a frame in a gap of a channel.
    """
    time, how = _times(measured, sampling, file)
    gaps = {signal.name: in_gaps(signal, time, sampling.largest_gap_s) for signal in measured.signals()}
    if sampling.faulty == "refuse":
        _refuse_gaps(measured, time, gaps, sampling, file)
    lost = np.any(list(gaps.values()), axis=0)
    if lost.all():
        raise InputError(
            file, "sampling", "no frame outside gaps", "a longer span, a rate_hz, or a larger largest_gap_s"
        )
    time = time[~lost]
    said = (
        f"{how}, from {time[0]:.6g} to {time[-1]:.6g} s; what is not sampled at these times is interpolated "
        "linearly between neighbours, rotations along the shortest turn."
    )
    return _at(measured, time, said, int(lost.sum()))


def _times(measured: Measured, sampling: SamplingTable, file: str) -> tuple[np.ndarray, str]:
    """Times (k,) of the frames, gaps left alone, and how they were chosen."""
    begin, end = common_span(measured, sampling, file)
    reference = next(measured.signals())
    if sampling.rate_hz is None:
        time = reference.time[(reference.time >= begin) & (reference.time <= end)]
        how = f"Frames at the samples of {reference.name}"
    else:
        _few((end - begin) * sampling.rate_hz, file)
        time = begin + np.arange(int((end - begin) * sampling.rate_hz * (1.0 + 1e-12)) + 1) / sampling.rate_hz
        how = f"Frames at {sampling.rate_hz:g} Hz"
    time = time[:: sampling.every]
    _few(len(time), file)
    return time, f"{how}, one in {sampling.every}" if sampling.every > 1 else how


def _few(count: float, file: str) -> None:
    if count > MOST:
        expected = f"at most {MOST}: give a span, every, or a rate_hz under [sampling]"
        raise InputError(file, "sampling", f"{count:.0f} frames", expected)


def in_gaps(signal: Signal | Turning, time: np.ndarray, largest: float | None) -> np.ndarray:
    """(k,) bool, whether times lie between two samples that are too far from each other."""
    if len(signal.time) < 2:
        return np.asarray(time != signal.time[0])
    steps = np.diff(signal.time)
    after = np.searchsorted(signal.time, time)
    within = (after > 0) & (after < len(signal.time))
    between = within & (signal.time[np.minimum(after, len(signal.time) - 1)] != time)
    limit = gap_limit(signal, largest)
    return np.asarray(between & (steps[np.clip(after - 1, 0, len(steps) - 1)] > limit))


def gap_limit(signal: Signal | Turning, largest: float | None) -> float:
    """The longest step of a channel that is no gap [s]."""
    return _GAP * float(np.median(np.diff(signal.time))) if largest is None else largest


def _refuse_gaps(
    measured: Measured, time: np.ndarray, gaps: Mapping[str, np.ndarray], sampling: SamplingTable, file: str
) -> None:
    for signal in measured.signals():
        lost = np.flatnonzero(gaps[signal.name])
        if len(lost):
            after = int(np.searchsorted(signal.time, time[lost[0]]))
            step, at = signal.time[after] - signal.time[after - 1], signal.time[after - 1]
            limit = gap_limit(signal, sampling.largest_gap_s)
            given = f"a gap of {step:.4g} s after {at:.6g} s, in which {len(lost)} frames lie"
            expected = (
                f"steps of at most {limit:.4g} s; or, under [sampling], another span, a larger largest_gap_s, or "
                'faulty = "leave_out"'
            )
            raise InputError(file, signal.name, given, expected)


def _at(measured: Measured, time: np.ndarray, said: str, left_out: int) -> Frames:
    rotation = None if measured.rotation is None else measured.rotation.at(time)
    position, lengths, tensions = (
        np.stack([_interpolated(signal, time) for signal in signals], axis=1) if signals else None
        for signals in (measured.position, measured.lengths, measured.tensions)
    )
    return Frames(time, position, rotation, lengths, tensions, said, left_out=left_out)


def _interpolated(signal: Signal | None, time: np.ndarray) -> np.ndarray:
    return np.full(len(time), np.nan) if signal is None else np.interp(time, signal.time, signal.values)

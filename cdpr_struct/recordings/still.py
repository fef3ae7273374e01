"""Stretches of a recording in which the robot stands still: their means, and what the scatter says of the sensors."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial.transform import Rotation

from cdpr_struct.errors import InputError
from cdpr_struct.recordings.frames import MOST, Frames, common_span, in_gaps
from cdpr_struct.recordings.mapping import SamplingTable
from cdpr_struct.recordings.measured import Measured, Turning
from cdpr_struct.recordings.signal import Signal

_FEWEST = 5  # samples of a window from which a speed is told
_MOST_SAMPLES = 20_000_000
_BLOCKS = 4  # of a stretch, from whose means the scatter of its mean is told: neighbours need not be independent


def still_frames(measured: Measured, sampling: SamplingTable, file: str) -> Frames:
    """One state a still stretch: means of the samples in it, as they were recorded.

    Raises
    ------
    InputError : no common time, too short, or nothing stands still.
    """
    begin, end = common_span(measured, sampling, file)
    stretches = _stretches(measured, sampling, begin, end, file)
    sigma: dict[str, float] = {}
    position, sigma["position_m"] = _means(measured.position, stretches)
    lengths, sigma["length_m"] = _means(measured.lengths, stretches)
    tensions, sigma["tension_N"] = _means(measured.tensions, stretches)
    rotation, sigma["rotation_deg"] = _mean_turns(measured.rotation, stretches)
    said = (
        f"Means over {len(stretches)} stretches of at least {sampling.least_s:g} s between {begin:.6g} and {end:.6g} s "
        f"in which nothing moves faster than {sampling.still_speed:g} m/s or rad/s; sigmas from the scatter of the "
        "means of parts of the stretches."
    )
    return Frames(
        np.array([0.5 * (first + last) for first, last in stretches]), position, rotation, lengths, tensions, said,
        {name: value for name, value in sigma.items() if value > 0.0},
    )  # fmt: skip


def _stretches(
    measured: Measured, sampling: SamplingTable, begin: float, end: float, file: str
) -> list[tuple[float, float]]:
    """Begin and end [s] of each stretch."""
    moving = [s for s in (*measured.position, measured.rotation, *measured.lengths) if s is not None]
    step = 1.0 / (sampling.rate_hz or _rate(moving[0], file))
    if (end - begin) / step > _MOST_SAMPLES:
        raise InputError(
            file, "sampling", f"{(end - begin) / step:.3g} samples", "a span or a rate_hz under [sampling]"
        )
    time = begin + step * np.arange(int((end - begin) / step + 1e-9) + 1)
    window = max(_FEWEST, 2 * round(0.5 * sampling.least_s / step) + 1)
    if len(time) < window:
        expected = f"at least {window * step:.3g} s that all channels cover; least_s is {sampling.least_s:g}"
        raise InputError(file, "", f"{end - begin:.4g} s", expected)
    speed = np.zeros(len(time))
    lost = np.zeros(len(time), dtype=bool)
    for signal in moving:
        speed = np.maximum(speed, _speed(signal, time, window, step))
        lost |= in_gaps(signal, time, sampling.largest_gap_s)
    found = list(_runs(time, (speed <= sampling.still_speed) & ~lost))
    long = [pair for pair in found if pair[1] - pair[0] >= sampling.least_s]
    if not long:
        raise _nothing_still(sampling, found, float(speed.min()), file)
    return long[:MOST]


def _nothing_still(
    sampling: SamplingTable, found: Sequence[tuple[float, float]], slowest: float, file: str
) -> InputError:
    """What to say where no stretch is slow for long enough."""
    longest = max((last - first for first, last in found), default=0.0)
    how = f"the slowest moment has {slowest:.3g} m/s or rad/s"
    if found:
        how = f"the longest stretch below still_speed lasts {longest:.3g} s"
    expected = (
        f"stretches of least_s = {sampling.least_s:g} s below still_speed = {sampling.still_speed:g}; change these "
        'under [sampling], or take mode = "motion"'
    )
    return InputError(file, "sampling", f"nothing still: {how}", expected)


def _rate(signal: Signal | Turning, file: str) -> float:
    if len(signal.time) < 2:
        raise InputError(file, signal.name, "one sample", "a channel with samples in time")
    return 1.0 / float(np.median(np.diff(signal.time)))


def _speed(signal: Signal | Turning, time: np.ndarray, window: int, step: float) -> np.ndarray:
    """(k,) slope of a line through the window around each moment: noise and vibration are no motion."""
    if isinstance(signal, Turning):
        turns = signal.at(time)
        vectors = np.concatenate([np.zeros((1, 3)), np.cumsum((turns[1:] * turns[:-1].inv()).as_rotvec(), axis=0)])
        return np.asarray(np.linalg.norm(savgol_filter(vectors, window, 1, deriv=1, delta=step, axis=0), axis=1))
    return np.abs(savgol_filter(np.interp(time, signal.time, signal.values), window, 1, deriv=1, delta=step))


def _runs(time: np.ndarray, still: np.ndarray) -> Iterator[tuple[float, float]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(int)))
    for first, after in zip(edges[::2], edges[1::2], strict=True):
        yield float(time[first]), float(time[after - 1])


def _means(
    signals: Sequence[Signal | None], stretches: Sequence[tuple[float, float]]
) -> tuple[np.ndarray | None, float]:
    """(k, c) means of channels over stretches, and one sigma of such a mean; nan where there is no sample."""
    if not signals:
        return None, 0.0
    means = np.full((len(stretches), len(signals)), np.nan)
    variances: list[float] = []
    steps: list[float] = []
    for column, signal in enumerate(signals):
        for row, pair in enumerate(stretches if signal is not None else ()):
            assert signal is not None
            own = signal.values[_within(signal, pair)]
            if len(own):
                means[row, column] = own.mean()
                variances += _variance(own[:, None])
        steps += [] if signal is None else [_resolution(signal.values)]
    return means, _sigma(variances, steps)


def _mean_turns(turning: Turning | None, stretches: Sequence[tuple[float, float]]) -> tuple[Rotation | None, float]:
    """Mean rotations over stretches, and one sigma of such a mean about an axis [deg]."""
    if turning is None:
        return None, 0.0
    means, variances = [], []
    for pair in stretches:
        places = _within(turning, pair)
        own = turning.rotation[places] if len(places) else turning.at(np.array([0.5 * sum(pair)]))
        means.append(own.mean())
        variances += _variance(np.degrees((means[-1].inv() * own).as_rotvec()))
    return Rotation.concatenate(means), _sigma(variances, [])


def _within(signal: Signal | Turning, pair: tuple[float, float]) -> np.ndarray:
    return np.arange(np.searchsorted(signal.time, pair[0]), np.searchsorted(signal.time, pair[1], side="right"))


def _variance(samples: np.ndarray) -> list[float]:
    """Variance of the mean of samples (n, c), from the means of blocks; none where there are too few."""
    blocks = min(_BLOCKS, len(samples) // 2)
    if blocks < 2:
        return []
    if not np.ptp(samples, axis=0).any():
        return [0.0]
    means = np.stack([part.mean(axis=0) for part in np.array_split(samples, blocks)])
    return [float(np.mean(means.var(axis=0, ddof=1)) / blocks)]


def _resolution(values: np.ndarray) -> float:
    """The smallest step between readings of a channel: a reading may be off by half of it."""
    steps = np.diff(np.unique(values))
    return float(steps.min()) if len(steps) else 0.0


def _sigma(variances: Sequence[float], steps: Sequence[float]) -> float:
    """One sigma: the scatter of the means, or that of rounding where it is larger.

    0 if it cannot be told: readings that stay the same in most stretches say nothing about the sensor.
    """
    if 2 * sum(variance > 0.0 for variance in variances) < max(len(variances), 1):
        return 0.0
    return max(float(np.sqrt(np.mean(variances))), float(np.median(steps)) / np.sqrt(12.0) if steps else 0.0)

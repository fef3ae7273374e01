"""What each channel of a recording holds: samples, rate, range; told in one pass, whatever the size of the file."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cdpr_struct.recordings.channel import Channel, Piece, Recording


@dataclass(frozen=True, slots=True)
class ChannelSummary:
    """A channel in numbers.

    samples : how many;  faulty : those of them that are no numbers
    start, end : times of the first and last one [s], nan if another channel has to say them;  rate : mean [Hz]
    low, high : range of the values, in the channel's unit
    """

    channel: Channel
    samples: int
    faulty: int
    start: float
    end: float
    low: float
    high: float

    @property
    def rate(self) -> float:
        """Mean rate [Hz]; nan without times."""
        return (self.samples - 1) / (self.end - self.start) if self.end > self.start else float("nan")

    def answer(self) -> Mapping[str, Any]:
        """Keys of a result."""
        return {
            "name": self.channel.name, "unit": self.channel.unit, "clock": self.channel.clock, "samples": self.samples,
            "faulty": self.faulty, "start_s": self.start, "end_s": self.end, "rate_hz": self.rate, "low": self.low,
            "high": self.high,
        }  # fmt: skip


class _Counted:
    """Numbers of a channel as its pieces come."""

    def __init__(self) -> None:
        self.samples = self.faulty = 0
        self.start = self.end = np.nan
        self.low, self.high = np.inf, -np.inf

    def add(self, piece: Piece) -> None:
        good = piece.values[np.isfinite(piece.values)]
        self.samples += len(piece.values)
        self.faulty += len(piece.values) - len(good)
        self.low = min(self.low, float(good.min(initial=np.inf)))
        self.high = max(self.high, float(good.max(initial=-np.inf)))
        if piece.time is not None and len(piece.time):
            self.start = float(np.fmin(self.start, piece.time.min()))
            self.end = float(np.fmax(self.end, piece.time.max()))


def summaries(recording: Recording) -> tuple[ChannelSummary, ...]:
    """All channels in the order of the recording.

    Raises
    ------
    InputError : the file is damaged.
    """
    counted = {channel.name: _Counted() for channel in recording.channels}
    for piece in recording.pieces(set(counted)):
        counted[piece.channel].add(piece)
    return tuple(
        ChannelSummary(channel, c.samples, c.faulty, c.start, c.end, *_range(c))
        for channel, c in zip(recording.channels, counted.values(), strict=True)
    )


def _range(counted: _Counted) -> tuple[float, float]:
    return (counted.low, counted.high) if counted.low <= counted.high else (np.nan, np.nan)

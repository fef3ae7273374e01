"""Peaks of the robot that are given to no mode for certain."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.residuals.recorded import Recorded

_MORE_LIKELY_THAN_NOT = 0.5


@dataclass(frozen=True, slots=True)
class UncertainPeak:
    """A peak: case, frequency [Hz], probability that it is no mode at all, and that it is its likeliest mode."""

    case: str
    hertz: float
    none: float
    likeliest: float


def uncertain_peaks(data: Recorded, found: Judged) -> list[UncertainPeak]:
    """Peaks none of whose modes has more than half of the probability."""
    last = None if found.lists is None else found.lists.association.assignment
    if last is None or data.vibrations is None or data.vibrations.peaks is None:
        return []
    peaks, pair = data.vibrations.peaks, last.matching.pair
    rows = []
    for k, j in zip(*np.nonzero(peaks.present), strict=True):
        if pair[k, j].max(initial=0.0) <= _MORE_LIKELY_THAN_NOT:
            case = data.campaign.states.names[int(data.vibrations.states[k])]
            none = float(np.clip(1.0 - pair[k, j].sum(), 0.0, 1.0))
            rows.append(UncertainPeak(case, float(np.exp(peaks.ln_frequency[k, j])), none, float(pair[k, j].max())))
    return rows


def peak_count(data: Recorded) -> int:
    """Number of peaks of the robot."""
    return 0 if data.vibrations is None or data.vibrations.peaks is None else int(data.vibrations.peaks.present.sum())

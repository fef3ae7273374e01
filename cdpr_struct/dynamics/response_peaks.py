"""Peaks of frequency responses between the lines: frequency, height and half-power width.

A peak is a local maximum of |H| at a mode that stands out by 5 %: the curve falls that far on both sides before it
rises above the peak. At an undamped mode |H| is infinite. Maxima and the minima between them are first found on the
lines and then refined, so that none of this depends on where the lines lie. The half-power width is that between the
frequencies on both sides at which |H| = peak / sqrt 2.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.signal import find_peaks

from cdpr_struct.dynamics.bracketed_search import bracketed_crossings, bracketed_minima
from cdpr_struct.dynamics.frequency_response import ResponseFunction
from cdpr_struct.dynamics.resonances import Resonances

_PROMINENCE_DECADES = 0.02
_CANDIDATE_DECADES = 0.01  # refinement adds less than 1 % to what a maximum on the lines stands out by
_SMALLEST = 1e-140  # |H| whose square can be computed
_AROUND = np.array([-1, 0, 1])


@dataclass(frozen=True, slots=True, eq=False)
class ResponsePeaks:
    """k peaks of one response, ascending.

    hertz            : (k,) [Hz]
    magnitude        : (k,) in the response's unit; infinite where nothing damps the mode
    half_power_hertz : (k, 2) below and above the peak, |H| = magnitude / sqrt 2 [Hz]; nan where a neighbour's flank or
                       the end of the band hides it, and where the peak is infinite
    """

    hertz: np.ndarray
    magnitude: np.ndarray
    half_power_hertz: np.ndarray

    @property
    def half_power_width(self) -> np.ndarray:
        """(k,) [Hz]."""
        return np.asarray(self.half_power_hertz[:, 1] - self.half_power_hertz[:, 0])

    @property
    def damping_ratio(self) -> np.ndarray:
        """(k,) that a single mode of this width would have: width / (2 frequency) [-]."""
        return np.asarray(self.half_power_width / (2.0 * self.hertz))

    @property
    def lines(self) -> np.ndarray:
        """Frequencies that draw the peaks: finite summits and their half-power points [Hz]."""
        bounded = self.hertz[np.isfinite(self.magnitude)]
        return np.concatenate([bounded, self.half_power_hertz[np.isfinite(self.half_power_hertz)]])


NO_PEAKS = ResponsePeaks(np.zeros(0), np.zeros(0), np.zeros((0, 2)))


def response_peaks(
    function: ResponseFunction,
    hertz: np.ndarray,
    response: np.ndarray,
    columns: np.ndarray,
    resonances: Resonances,
    poles: list[np.ndarray],
) -> list[ResponsePeaks]:
    """Peaks of some of the responses.

    Parameters
    ----------
    hertz, response : (f,), (f, n) the function on lines that resolve its resonances (`Resonances.lines`)
    columns : (c,) numbers of the responses that are searched
    poles : of each of these, the frequencies (p,) ascending, inside the band, at which it is infinite [Hz]
    """
    if not len(columns):
        return []
    curves = [_curve(i, hertz, np.abs(response[:, i]), own) for i, own in zip(columns, poles, strict=True)]
    _refine(function, curves)
    tops = [_resonant(curve, resonances) for curve in curves]
    crossings = _half_power(function, curves, tops)
    found = []
    for curve, top, crossed, own in zip(curves, tops, crossings, poles, strict=True):
        unbounded = ResponsePeaks(own, np.full(len(own), np.inf), np.full((len(own), 2), np.nan))
        found.append(_merged(ResponsePeaks(curve.hertz[top], curve.size[top], crossed), unbounded))
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Curve:
    """|H| on ascending lines, infinite at poles, with its k candidates and the minima that part them.

    column      : number of the response
    hertz, size : (f,); refinement moves the lines at `tops` and `dips`
    tops : (k,) numbers of the lines that are maxima;  dips : (k + 1,) lowest lines before, between and behind them
    """

    column: int
    hertz: np.ndarray
    size: np.ndarray
    tops: np.ndarray
    dips: np.ndarray


def _curve(column: int, hertz: np.ndarray, size: np.ndarray, poles: np.ndarray) -> _Curve:
    place = np.concatenate([hertz, poles])
    order = np.argsort(place, kind="stable")
    size = np.concatenate([size, np.full(len(poles), np.inf)])[order]
    log = _decades(size)
    tops, _ = find_peaks(log, prominence=_CANDIDATE_DECADES)
    ends = [0, *tops.tolist(), len(log) - 1]
    dips = [low + int(log[low : high + 1].argmin()) for low, high in pairwise(ends)]
    return _Curve(column, place[order], size, tops, np.array(dips))


def _decades(size: np.ndarray) -> np.ndarray:
    return np.asarray(np.log10(np.clip(size, _SMALLEST, 1.0 / _SMALLEST)))


def _refine(function: ResponseFunction, curves: list[_Curve]) -> None:
    """Move the lines at tops and dips to the extremes that they stand for.

    |H|^-2 about a resonance, and |H|^2 about an antiresonance, are parabolas as far as one mode (or one zero) rules.
    """
    searched = [
        (curve, int(line), power)
        for curve in curves
        for lines, power in ((curve.tops, -2.0), (curve.dips, 2.0))
        for line in lines
        if 0 < line < len(curve.size) - 1 and np.isfinite(curve.size[line + _AROUND]).all()
    ]
    if not searched:
        return
    columns = np.array([curve.column for curve, _, _ in searched])
    powers = np.array([power for _, _, power in searched])
    place = np.array([curve.hertz[line + _AROUND] for curve, line, _ in searched])
    size = np.array([curve.size[line + _AROUND] for curve, line, _ in searched])

    def values(hertz: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return np.asarray(_sizes(function, hertz, columns[rows]) ** powers[rows])

    found, lowest = bracketed_minima(values, place, np.maximum(size, _SMALLEST) ** powers[:, None])
    for (curve, line, power), hertz, value in zip(searched, found, lowest, strict=True):
        curve.hertz[line], curve.size[line] = hertz, value ** (1.0 / power)


def _sizes(function: ResponseFunction, hertz: np.ndarray, column: np.ndarray) -> np.ndarray:
    """(q,) |H| of one column each."""
    lines, back = np.unique(hertz, return_inverse=True)
    return np.maximum(np.abs(function.at(lines))[back, column], _SMALLEST)


def _resonant(curve: _Curve, resonances: Resonances) -> np.ndarray:
    """Numbers of the lines that are peaks of finite height: they stand out, and a mode is near."""
    sequence = np.empty(2 * len(curve.tops) + 1)
    sequence[::2], sequence[1::2] = _decades(curve.size[curve.dips]), _decades(curve.size[curve.tops])
    kept, _ = find_peaks(sequence, prominence=_PROMINENCE_DECADES)
    tops = curve.tops[kept // 2]
    return tops[np.isfinite(curve.size[tops]) & resonances.near(curve.hertz[tops])]


def _half_power(function: ResponseFunction, curves: list[_Curve], tops: list[np.ndarray]) -> list[np.ndarray]:
    """Per curve (k, 2) frequencies at which a peak's flanks pass its half power, nan where they do not."""
    crossings = [np.full((len(top), 2), np.nan) for top in tops]
    flanks = [(number, flank) for number, curve in enumerate(curves) for flank in _flanks(curve, tops[number])]
    if not flanks:
        return crossings
    columns = np.array([curves[number].column for number, _ in flanks])
    ends = [np.array([flank.above, flank.below]) for _, flank in flanks]
    place = np.array([curves[number].hertz[own] for (number, _), own in zip(flanks, ends, strict=True)])
    size = np.array([curves[number].size[own] for (number, _), own in zip(flanks, ends, strict=True)])
    level = np.array([flank.level for _, flank in flanks]) ** -2.0

    def values(hertz: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return np.asarray(_sizes(function, hertz, columns[rows]) ** -2.0 - level[rows])

    found = bracketed_crossings(values, place, np.maximum(size, _SMALLEST) ** -2.0 - level[:, None])
    for (number, flank), hertz in zip(flanks, found, strict=True):
        crossings[number][flank.peak, flank.side] = hertz
    return crossings


class _Flank(NamedTuple):
    """One side (0 below, 1 above) of a peak: the last line above its half-power level, and the first one below it."""

    peak: int
    side: int
    above: int
    below: int
    level: float


def _flanks(curve: _Curve, tops: np.ndarray) -> list[_Flank]:
    """The flanks that pass half power before the next peak, pole or end of the band."""
    walls = np.union1d(tops, np.flatnonzero(np.isinf(curve.size)))
    limits = np.concatenate([[0], walls, [len(curve.size) - 1]])
    found = []
    for peak, (top, wall) in enumerate(zip(tops.tolist(), np.searchsorted(walls, tops), strict=True)):
        level = float(curve.size[top] / np.sqrt(2.0))
        ways = (np.arange(top, limits[wall] - 1, -1), np.arange(top, limits[wall + 2] + 1))
        for side, way in enumerate(ways):
            below = np.flatnonzero(curve.size[way] < level)
            if len(below):
                found.append(_Flank(peak, side, int(way[below[0] - 1]), int(way[below[0]]), level))
    return found


def _merged(one: ResponsePeaks, other: ResponsePeaks) -> ResponsePeaks:
    hertz = np.concatenate([one.hertz, other.hertz])
    order = np.argsort(hertz)
    magnitude = np.concatenate([one.magnitude, other.magnitude])
    half_power = np.concatenate([one.half_power_hertz, other.half_power_hertz])
    return ResponsePeaks(hertz[order], magnitude[order], half_power[order])

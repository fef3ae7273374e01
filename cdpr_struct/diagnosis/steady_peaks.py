"""Peaks that no mode of the model explains and that are at about the same frequency wherever the robot is.

A mode of the robot moves from pose to pose; one inside the platform, or of the frame, hardly feels the cables. Stray
peaks of one frequency are so likely under one unknown number, where a world pays for each of them.
"""

import numpy as np
from scipy.special import betaln, logsumexp

from cdpr_struct.diagnosis.causes.internal_mode import Steady
from cdpr_struct.diagnosis.mode_pairing import Modes, Pairing
from cdpr_struct.diagnosis.stray_peaks import ONE
from cdpr_struct.measurement.campaign import RobotFrequencies

_WINDOW = 0.03  # of ln f about the middle
_SCATTER = np.array([[0.003], [0.01], [0.02]])  # of ln f: how far cables move such a mode, equally likely
_NARROWEST = np.log(2.0)  # of the band in which its frequency is equally likely, in ln f
_OFF = 0.3  # of ln f: how far a mode of a wrong model may be off
_PLATFORM = 0.3  # of the kinetic energy: modes that one would expect among the peaks
_ALONE = 0.5  # probability of a peak to be stray


def steady_peaks(peaks: RobotFrequencies, pairing: Pairing) -> list[Steady]:
    """Groups of peaks of one frequency, one a state, one of them stray at least; likeliest first."""
    log = np.log(peaks.hertz)
    groups = {}
    for pivot in np.flatnonzero(pairing.stray > _ALONE):
        rows = _near(peaks.state, log, float(log[pivot]))
        rows = _near(peaks.state, log, float(log[rows].mean()))
        if len(rows) > 1 and pairing.stray[rows].sum() > ONE:
            groups[tuple(rows)] = _steady(peaks, rows)
    return sorted(groups.values(), key=lambda steady: -len(steady.rows) * 100.0 - steady.log_density)


def _near(state: np.ndarray, log: np.ndarray, middle: float) -> np.ndarray:
    """The nearest peak of each state that has one within the window."""
    away = np.abs(log - middle)
    own = [np.flatnonzero(state == s) for s in np.unique(state)]
    best = np.array([rows[away[rows].argmin()] for rows in own])
    return best[away[best] < _WINDOW]


def _steady(peaks: RobotFrequencies, rows: np.ndarray) -> Steady:
    log, noise = np.log(peaks.hertz), (peaks.sigma / peaks.hertz)[rows]
    density, middle, sigma = _of_one_number(log[rows], noise)
    n, states = len(rows), len(np.unique(peaks.state))
    seen = float(betaln(n + 1, states - n + 1))  # in any share of the states
    hertz = float(np.exp(middle))
    return Steady(rows, hertz, sigma * hertz, density + seen - np.log(max(float(np.ptp(log)), _NARROWEST)))


def _of_one_number(log: np.ndarray, noise: np.ndarray) -> tuple[float, float, float]:
    """ln density of values (n,) about one number of density 1, the number, and one sigma of a further value."""
    weight = 1.0 / (_SCATTER**2 + noise**2)
    whole = weight.sum(axis=1)
    middle = (weight * log).sum(axis=1) / whole
    left = (weight * (log - middle[:, None]) ** 2).sum(axis=1)
    logs = 0.5 * (np.log(weight).sum(axis=1) - left - np.log(whole) - (len(log) - 1) * np.log(2.0 * np.pi))
    share = np.exp(logs - logsumexp(logs))
    mean = float(share @ middle)
    variance = float(share @ (_SCATTER[:, 0] ** 2 + 1.0 / whole + (middle - mean) ** 2))
    return float(logsumexp(logs) - np.log(len(logs))), mean, float(np.sqrt(variance))


def moves_alone(peaks: RobotFrequencies, steady: Steady, pairing: Pairing, modes: Modes) -> float:
    """Nats by which one frequency is likelier than modes of the model, free there, that are off by the same factor.

    Infinite where no mode of the platform is free at one of these states.
    """
    taken = pairing.chosen[np.setdiff1d(np.flatnonzero(pairing.stray < _ALONE), steady.rows)]
    free = np.setdiff1d(np.flatnonzero(modes.energy > _PLATFORM), taken)
    own = [np.log(modes.hertz[free[modes.state[free] == s]]) for s in peaks.state[steady.rows]]
    if not all(map(len, own)):
        return np.inf
    log, noise = np.log(peaks.hertz[steady.rows]), (peaks.sigma / peaks.hertz)[steady.rows]
    best, gaps = -np.inf, [value - logs for value, logs in zip(log, own, strict=True)]
    for factor in np.concatenate(gaps):
        off = np.array([gap[np.abs(gap - factor).argmin()] for gap in gaps])
        best = max(best, _of_one_number(off, noise)[0] - 0.5 * float(off.mean() / _OFF) ** 2)
    return float(_of_one_number(log, noise)[0] - best)

"""Noise that is correlated from one reading of a sensor to the next: a first-order autoregressive process.

Readings of a day that share warmth, light or the hand of the note-taker are off alike for a while. Taken as
independent they are as many witnesses as readings, and a cause is found that is none.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cdpr_struct.residuals.linearised import Local, Outside, Point, Term
from cdpr_struct.residuals.recorded import Recorded

CORRELATION = 0.7  # of one reading with the next
_PROBABILITY = 0.05
_SLOW = 1.0  # variance of a Karhunen-Loeve function, in that of a reading: those with less look like independent noise
_FEWEST = 6  # states: fewer hardly tell it from offsets


@dataclass(frozen=True, slots=True, order=True)
class Correlated:
    """Noise of every sensor correlated from one reading to the next, with the stated sigma.

    Sensors are the coordinates of the tracker, each cell, each encoder, and of frequencies of single cables each
    number of mode, read in the order of the file. Peaks of the robot are left out.
    """

    correlation: float = CORRELATION

    @property
    def probability(self) -> float:
        """Of noise that is correlated."""
        return _PROBABILITY

    @property
    def independent(self) -> float:
        """Sigma of what is left beside the slow functions of a long series, in that of a reading.

        An autoregressive process has the variance (1 - r^2) / (1 - 2 r cos w + r^2) at w a reading, above one up to
        cos w = r; the mean of what lies beyond.
        """
        r = self.correlation
        last = np.arccos(r)
        slow = 2.0 / np.pi * np.arctan((1.0 + r) / (1.0 - r) * np.tan(0.5 * last))
        return float(np.sqrt((1.0 - slow) / (1.0 - last / np.pi)))

    def term(self, data: Recorded) -> Term:
        """What it does to the rows, to first order about the robot as entered."""
        return _term(data, self.correlation)


def may_be_correlated(data: Recorded) -> list[Correlated]:
    """That noise, if the campaign has enough states that are no frames of a motion."""
    moving = data.campaign.frames is not None
    return [] if moving or data.states < _FEWEST else [Correlated()]


@lru_cache(maxsize=8)
def _term(data: Recorded, correlation: float) -> Term:
    local = Local.about(data, Point.entered(data))
    parts = [_of_readings(local, correlation)]
    if data.vibrations is not None and len(data.vibrations.sigma):
        parts.append(_of_cable_frequencies(local, correlation))
    return Term.outside(Outside.joined(parts))


def _of_readings(local: Local, correlation: float) -> Outside:
    """Columns of the slow part of each sensor of states at rest; states that share a length share its noise."""
    data, own = local.data, []
    for sensor in range(data.sigma.shape[1]):
        lengths = sensor >= 6 + data.cables
        read = [states[data.read[states, sensor]] for states in (data.blocks if lengths else _each(data.states))]
        read = [states for states in read if len(states)]
        waves = slow_waves(len(read), correlation)
        share = np.zeros((data.states, data.sigma.shape[1], waves.shape[1]))
        for states, wave in zip(read, waves, strict=True):
            share[states, sensor] = data.sigma[states, sensor, None] * wave
        own.append(share)
    return local.of_reading(slice(None)).shared(np.concatenate(own, axis=-1), local.states_of_rows)


def _each(states: int) -> tuple[np.ndarray, ...]:
    return tuple(np.arange(states)[:, None])


def _of_cable_frequencies(local: Local, correlation: float) -> Outside:
    """Columns of the slow part of each number of mode, over cables and states in the order of the file."""
    measured, own = local.data.vibrations, []
    assert measured is not None
    for number in np.unique(measured.rows.mode):
        rows = np.flatnonzero(measured.rows.mode == number)
        waves = slow_waves(len(rows), correlation)
        columns = np.zeros((len(measured.sigma), waves.shape[1]))
        columns[rows] = measured.sigma[rows, None] * waves
        own.append(columns)
    cables = np.concatenate(own, axis=-1)
    still = local.acting_on(np.zeros((*local.r.static.shape, cables.shape[1])))
    return Outside(still.static, cables, still.swivels)


@lru_cache(maxsize=64)
def slow_waves(count: int, correlation: float) -> np.ndarray:
    """(n, f) largest Karhunen-Loeve functions of n readings of unit variance, each correlated with the one before."""
    order = np.arange(count)
    variance, functions = np.linalg.eigh(correlation ** np.abs(order[:, None] - order))
    slow = variance > _SLOW
    return np.asarray(functions[:, slow] * np.sqrt(variance[slow]))

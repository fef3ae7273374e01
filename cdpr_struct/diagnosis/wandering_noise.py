"""Noise that wanders: a sensor's error today is much like its error an hour ago.

Readings in a row then share part of their noise, which looks like a cause that comes and goes. The noise of a sensor
is taken as a first-order process over its readings in the order in which they were filed: no larger than its
certificate says, only remembered.
"""

import numpy as np

from cdpr_struct.measurement.campaign import CableFrequencies, States

MEMORIES = (0.4, 0.7, 0.9)  # correlation of a sensor's noise in one reading with that in the next
FEWEST_READINGS = 6  # of a sensor: in fewer, noise that wanders is no other than one that is off in all
CLEAR = 8.0  # nats that wandering noise must bring, and bring more than any law


def runs(states: States, cables: CableFrequencies, start: int) -> list[np.ndarray]:
    """Indices of the readings of each sensor, in order, among all noise of a null.

    Pose coordinates and tensions run from state to state, lengths from lock to lock, frequencies of a mode from cable
    to cable; `start` is the number of the first frequency.
    """
    s, m = len(states.names), states.tension.shape[1]
    end = (6 + m) * s + m * (int(states.lock.max()) + 1)
    found = [np.arange(j, 6 * s, 6) for j in range(6)]
    found += [np.arange(6 * s + i, (6 + m) * s, m) for i in range(m)]
    found += [np.arange((6 + m) * s + i, end, m) for i in range(m)]
    return found + [start + np.flatnonzero(cables.mode == mode) for mode in np.unique(cables.mode)]


def remembered(columns: np.ndarray, sensors: list[np.ndarray], memory: float) -> np.ndarray:
    """Columns (n, k) of independent noise, with that of each sensor as a first-order process."""
    if memory == 0.0:
        return columns
    mixed = columns.copy()
    for run in sensors:
        if run.size:
            apart = np.abs(np.arange(run.size)[:, None] - np.arange(run.size))
            mixed[:, run] = columns[:, run] @ np.linalg.cholesky(memory**apart)
    return mixed


def likeliest_memory(columns: np.ndarray, r: np.ndarray, sensors: list[np.ndarray]) -> tuple[float, float]:
    """The memory that explains residuals (n,) best, and its log evidence against none."""
    levels = [_level(remembered(columns, sensors, memory), r) for memory in (0.0, *MEMORIES)]
    best = int(np.argmin(levels[1:]))
    return MEMORIES[best], levels[0] - levels[1 + best] - float(np.log(len(MEMORIES)))


def _level(columns: np.ndarray, r: np.ndarray) -> float:
    lower = np.linalg.cholesky(columns @ columns.T)
    z = np.linalg.solve(lower, r)
    return float(0.5 * z @ z + np.log(np.diagonal(lower)).sum())

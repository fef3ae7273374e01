"""Which states of a campaign are frames of a motion, and how fast do lengths and platform change there?

Frames follow each other within seconds; states at rest are minutes apart. Rates and accelerations come from a spline
through each run of frames. Speed matters where sensors read late against each other, acceleration where the platform's
weight is not all that its cables carry.
"""

from collections.abc import Iterator

import numpy as np
from scipy.interpolate import CubicSpline

from cdpr_struct.measurement.campaign import States

APART = 2.0  # s between frames at most
FEWEST = 8  # frames of a run: fewer give no rates
STILL = 1e-3  # m/s of the fastest cable, below which a frame is at rest


def length_rates(states: States) -> np.ndarray:
    """(S, m, 2) derivatives of the encoders' lengths [m/s, m/s^2]; zero where no frames, or not read."""
    return _derivatives(states.time, states.length, (1, 2))


def accelerations(states: States) -> np.ndarray:
    """(S,) of the platform's origin [m/s^2]; zero in states that are no frames of a motion."""
    return np.asarray(np.linalg.norm(_derivatives(states.time, states.position, (2,)), axis=(1, 2)))


def moving(rates: np.ndarray) -> np.ndarray:
    """(S,) bool, whether the platform moves, by rates (S, m, 2)."""
    return np.asarray(np.abs(rates[..., 0]).max(axis=1, initial=0.0) > STILL)


def _derivatives(time: np.ndarray, values: np.ndarray, orders: tuple[int, ...]) -> np.ndarray:
    """(S, k, q) derivatives of q orders by time of values (S, k) along runs of frames, else zero."""
    found = np.zeros((*values.shape, len(orders)))
    for run in runs(time):
        for column in range(values.shape[1]):
            own = run[np.isfinite(values[run, column])]
            if len(own) >= FEWEST:
                spline = CubicSpline(time[own], values[own, column])
                found[own, column] = np.stack([spline(time[own], order) for order in orders], axis=-1)
    return found


def runs(time: np.ndarray) -> Iterator[np.ndarray]:
    """States (k,) that follow each other as frames, in order of time; at times that differ."""
    order = np.argsort(time, kind="stable")[: int(np.isfinite(time).sum())]
    steps = np.diff(time[order])
    order = order[np.append(True, steps > 0.0)] if len(order) else order
    if len(order) < FEWEST:
        return
    for run in np.split(order, np.flatnonzero(np.diff(time[order]) > APART) + 1):
        if len(run) >= FEWEST:
            yield run

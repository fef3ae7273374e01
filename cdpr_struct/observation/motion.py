"""Which states of a campaign are frames of a motion, and how fast do lengths and platform change there?

Frames follow each other within seconds; states at rest are minutes apart. Rates and accelerations come from a spline
through each run of frames. Speed matters where sensors read late against each other, acceleration where the platform's
weight is not all that its cables carry. Tensions and accelerations come from smoothing splines, whose smoothness the
data choose themselves by cross-validation: an interpolating one would amplify noise too much there.
"""

from collections.abc import Iterator

import numpy as np
from scipy.interpolate import CubicSpline, make_smoothing_spline
from scipy.spatial.transform import Rotation

from cdpr_struct.measurement.campaign import States

APART = 2.0  # s between frames at most
FEWEST = 8  # frames of a run: fewer give no rates
FEWEST_SMOOTHED = 24  # frames of a run: of fewer, every other one says too little of an acceleration
_ENDS = 3  # frames at each end of a run, where a natural spline does not bend
STILL = 1e-3  # m/s of the fastest cable, below which a frame is at rest


def length_rates(states: States) -> np.ndarray:
    """(S, m, 2) derivatives of the encoders' lengths [m/s, m/s^2]; zero where no frames, or not read."""
    return _derivatives(states.time, states.length, (1, 2))


def tension_rates(states: States) -> np.ndarray:
    """(S, m, 2) derivatives of the load cells' readings [N/s, N/s^2]; zero where no frames, or not read."""
    return _derivatives(states.time, states.tension, (1, 2), smooth=True)


def accelerations(states: States) -> np.ndarray:
    """(S,) of the platform's origin [m/s^2]; zero in states that are no frames of a motion."""
    return np.asarray(np.linalg.norm(_derivatives(states.time, states.position, (2,)), axis=(1, 2)))


def inertial(states: States, where_pulled: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations (S, 6) of the platform where tensions were read, and what is not known of them (S,) [m/s^2].

    Of its origin [m/s^2], then angular [rad/s^2], world axes: the second derivative of the turn from the mean
    orientation, so tilts are small. What is not known is the difference between frames with even and with odd numbers;
    at the ends of a run, where a spline has none, and where no tensions were read, it is all of the acceleration.

    where_pulled : whether only of runs whose tensions were read; else of all whose poses were
    """
    found, unknown = np.zeros((len(states.time), 6)), accelerations(states)
    for run in runs(states.time):
        own = run[np.isfinite(states.position[run]).all(axis=1)]
        if where_pulled:
            own = own[np.isfinite(states.tension[own]).all(axis=1)]
        if len(own) < len(run) or len(own) < FEWEST_SMOOTHED or not np.isfinite(states.angles[own]).all():
            continue
        turn = Rotation.from_euler("xyz", states.angles[own])
        values = np.concatenate([states.position[own], (turn * turn.mean().inv()).as_rotvec()], axis=1)
        inside, time = slice(_ENDS, -_ENDS), states.time[own]
        found[own[inside]] = _second(time, values, time)[inside]
        halves = [_second(time[k::2], values[k::2, :3], time)[inside] for k in (0, 1)]
        unknown[own[inside]] = np.sqrt(((0.5 * (halves[0] - halves[1])) ** 2).sum(axis=1).mean())
    return found, unknown


def _second(time: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """(S, k) second derivatives at times of smoothing splines through values (n, k)."""
    return np.stack([make_smoothing_spline(time, column)(at, 2) for column in values.T], axis=1)


def moving(rates: np.ndarray) -> np.ndarray:
    """(S,) bool, whether the platform moves, by rates (S, m, 2)."""
    return np.asarray(np.abs(rates[..., 0]).max(axis=1, initial=0.0) > STILL)


def _derivatives(time: np.ndarray, values: np.ndarray, orders: tuple[int, ...], smooth: bool = False) -> np.ndarray:
    """(S, k, q) derivatives of q orders by time of values (S, k) along runs of frames, else zero."""
    through = make_smoothing_spline if smooth else CubicSpline
    found = np.zeros((*values.shape, len(orders)))
    for run in runs(time):
        for column in range(values.shape[1]):
            own = run[np.isfinite(values[run, column])]
            if len(own) >= FEWEST:
                spline = through(time[own], values[own, column])
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

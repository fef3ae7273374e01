"""Frames of a motion as few states: those that stand for the others, as many as all frames together are worth.

Neighbouring frames share their errors: of n frames whose residuals have lag correlations rho_k, the mean is as sure as
that of n / (1 + 2 sum rho_k) independent ones (Geyer, Practical Markov chain Monte Carlo, 1992: the sum ends with the
first negative pair). So many frames are kept, evenly spaced, and one sigma of each counts in full. Rates come from all
frames. Frames at rest say the same as the one before them, and are counted with it.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.measurement.campaign import Campaign, States
from cdpr_struct.measurement.frames import Frames
from cdpr_struct.observation.motion import inertial, length_rates, runs, tension_rates
from cdpr_struct.observation.rest import static_residuals
from cdpr_struct.residuals.recorded import Recorded, recorded

FEWEST_KEPT = 24  # frames of a campaign, below which none is left out
MOST_KEPT = 60  # states that frames become at most: more are slow, and sure of the fourth digit of an effect
_MOVED = 3.0  # standard deviations of chi2 beyond its mean: a frame that differs less from the one before is at rest


def condensed(campaign: Campaign) -> Campaign:
    """The campaign with few of its frames as states; itself where no motion has more frames than it is worth."""
    if campaign.frames is not None:
        return campaign
    moves = [run for run in runs(campaign.states.time) if _plain(campaign, run)]
    if sum(map(len, moves)) <= FEWEST_KEPT:
        return campaign
    chosen, count, worth = _chosen(campaign, moves)
    if len(chosen) == len(campaign.states.names):
        return campaign
    states = campaign.states
    moved, unknown = inertial(states)
    rates = length_rates(states)[chosen], tension_rates(states)[chosen]
    frames = Frames(*rates, moved[chosen], unknown[chosen], count, worth)
    return replace(_with(campaign, chosen), frames=frames)


def _plain(campaign: Campaign, run: np.ndarray) -> bool:
    """Whether frames are states at measured poses, in which no frequency was measured."""
    states = campaign.states
    vibrating = np.concatenate([campaign.cable_frequencies.state, campaign.robot_frequencies.state])
    posed = np.isfinite(states.position[run]).all() and np.isfinite(states.angles[run]).all()
    return bool(posed and states.static[run].all() and not np.isin(run, vibrating).any())


def _chosen(campaign: Campaign, moves: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, float]:
    """Kept states in the campaign's order, frames that each stands for, and the worth of all."""
    data = recorded(campaign)
    different = [_different(data, run) for run in moves]
    span = [correlation_span(_residuals(data, run)) for run in moves]
    worth = sum(len(run) / own for run, own in zip(moves, span, strict=True))
    moving = sum(own.sum() for own in different)
    step = max(1.0, moving / np.clip(worth, FEWEST_KEPT, MOST_KEPT))
    stands = np.arange(len(campaign.states.names))
    for run, own in zip(moves, different, strict=True):
        turn = np.floor((np.cumsum(own) - 1.0) / step)
        first = np.flatnonzero(np.diff(turn, prepend=-1.0))
        stands[run] = run[first[np.searchsorted(first, np.arange(len(run)), side="right") - 1]]
    kept, count = np.unique(stands, return_counts=True)
    return kept, count, float(worth)


def _different(data: Recorded, run: np.ndarray) -> np.ndarray:
    """(k,) bool, whether each frame of a run differs from the last such one by more than its readings may err."""
    readings, sigma = data.readings, data.sigma[run]
    turn = Rotation.from_matrix(readings.rotation[run])
    values = np.concatenate([readings.position[run], (turn * turn[0].inv()).as_rotvec(), readings.length[run]], axis=1)
    own = np.concatenate([sigma[:, :6], sigma[:, 6 + data.cables :]], axis=1)
    found, last = np.zeros(len(run), dtype=bool), 0
    found[0], n = True, values.shape[1]
    for k in range(1, len(run)):
        if 0.5 * (((values[k] - values[last]) / own[k]) ** 2).sum() > n + _MOVED * np.sqrt(2.0 * n):
            found[k], last = True, k
    return found


def _residuals(data: Recorded, run: np.ndarray) -> np.ndarray:
    """(k, c) residuals of a run less what its place, tilt and motion explain of them in proportion; only rows read."""
    known, m = data.known.at(run), data.cables
    readings = replace(data.readings, **{n: getattr(data.readings, n)[run] for n in _READINGS})
    rows = static_residuals(data.arrays, readings, known, data.radius)
    some = np.repeat([data.read[run, 6 : 6 + m].all(), False], [6, m])
    some[6:] = data.read[run, 6 + m :].all(axis=0)
    place = np.column_stack([np.ones(len(run)), readings.position, Rotation.from_matrix(readings.rotation).as_rotvec()])
    kept = []
    for column in np.flatnonzero(some).tolist():
        moving = known.rate.reshape((len(run), -1)) if column < 6 else known.rate[:, column - 6]
        features = np.column_stack([place, moving])
        kept.append(rows[:, column] - features @ np.linalg.lstsq(features, rows[:, column], rcond=None)[0])
    return np.array(kept).reshape((-1, len(run))).T


_READINGS = ("position", "rotation", "tension", "length")


def correlation_span(residuals: np.ndarray) -> float:
    """1 + 2 sum rho_k of series (n, c) [any units], correlations averaged over the series: frames that count as one."""
    n = len(residuals)
    own = residuals - residuals.mean(axis=0, keepdims=True)
    own = own[:, np.linalg.norm(own, axis=0) > 0.0]
    if not own.size:
        return 1.0
    transform = np.fft.rfft(own / np.linalg.norm(own, axis=0), 2 * n, axis=0)
    rho = np.fft.irfft((np.abs(transform) ** 2).mean(axis=1), 2 * n)[:n]
    pairs = rho[: n - n % 2].reshape((-1, 2)).sum(axis=1)
    end = int(np.argmax(pairs <= 0.0)) if (pairs <= 0.0).any() else len(pairs)
    return float(max(1.0, 2.0 * pairs[:end].sum() - 1.0))


def _with(campaign: Campaign, kept: np.ndarray) -> Campaign:
    """The campaign with these states alone."""
    states = campaign.states
    columns = {name: getattr(states, name)[kept] for name in States.__slots__ if name != "names"}
    chosen = States(names=tuple(states.names[k] for k in kept.tolist()), **columns)
    place = np.full(len(states.names), -1)
    place[kept] = np.arange(len(kept))
    cables = replace(campaign.cable_frequencies, state=place[campaign.cable_frequencies.state])
    robot = replace(campaign.robot_frequencies, state=place[campaign.robot_frequencies.state])
    return replace(campaign, states=chosen, cable_frequencies=cables, robot_frequencies=robot)

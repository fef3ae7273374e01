"""Which mode of the model is which measured peak? Peaks carry no labels, and some modes were not picked.

All peaks of all states are paired together: the model's frequencies are off by tolerances and noise of the readings
that they share, so each pair taken for granted sharpens the expectation of the others (a Kalman update over modes).
The best few pairings are followed; where they disagree, the frequency is in doubt by as much as they differ.
"""

from dataclasses import dataclass

import numpy as np

_BEAM = 48
STRAY = -6.0  # ln density of a peak that belongs to no mode
STRAY_DOUBT = 0.3  # of ln f
STRAY_NATS = -STRAY - float(np.log(STRAY_DOUBT * np.sqrt(2.0 * np.pi)))
"""What a stray costs a world in log evidence, beyond the density of a residual with this doubt."""
_SHAPE = 6.0  # ln density lost by a shape that is orthogonal to the mode's
_SEEN = (0.05, 0.75)  # probability that a mode without and with platform motion is picked
_PLATFORM = (0.1, 0.4)  # of the kinetic energy in the platform: between these the probability rises


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """Modes of the model at the states where peaks were measured, ascending within a state.

    state (k,), hertz (k,), shape (k, 6) of the platform, energy (k,) share of the kinetic energy in the platform
    """

    state: np.ndarray
    hertz: np.ndarray
    shape: np.ndarray
    energy: np.ndarray

    def some(self, index: np.ndarray) -> "Modes":
        """Modes of the given indices."""
        return Modes(self.state[index], self.hertz[index], self.shape[index], self.energy[index])

    def of_platform(self) -> "Modes":
        """Those in which the platform moves most surely."""
        return self.some(np.flatnonzero(self.energy > _PLATFORM[1]))


@dataclass(frozen=True, slots=True, eq=False)
class Pairing:
    """chosen (r,) mode of each peak;  doubt (r,) one sigma of ln f from pairings that compete.

    stray (r,) : probability of each peak to belong to no mode
    """

    chosen: np.ndarray
    doubt: np.ndarray
    stray: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class _Paths:
    """Pairings (p,) of the peaks so far, best first: log weight (p,), chosen (p, i) modes (-1: a stray), and for each
    the modes' expected ln f (p, k) with covariance (p, k, k)."""

    weight: np.ndarray
    chosen: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray


def paired(
    state: np.ndarray,
    hertz: np.ndarray,
    noise: np.ndarray,
    modes: Modes,
    covariance: np.ndarray,
    unlike: np.ndarray,
) -> Pairing:
    """Pair peaks with modes.

    Parameters
    ----------
    state (r,), hertz (r,), noise (r,) : of the peaks; noise is one sigma of ln f
    covariance : (k, k) of the modes' ln f
    unlike : (r, k) 1 - modal assurance of measured and model shapes, nan where no shape was measured
    """
    order = np.lexsort((hertz, state))
    paths = _Paths(np.zeros(1), np.zeros((1, 0), dtype=int), np.log(modes.hertz)[None], covariance[None])
    odds, shapes = _log_odds(modes.energy), _SHAPE * np.nan_to_num(unlike)
    for i in order:
        logs = _weights(paths, modes.state == state[i], np.log(hertz[i]), noise[i], odds - shapes[i])
        paths = _grown(paths, logs, np.log(hertz[i]), noise[i])
    chosen, doubt, stray = np.zeros(len(order), dtype=int), np.zeros(len(order)), np.zeros(len(order))
    chosen[order], doubt[order], stray[order] = _agreed(paths, state[order], hertz[order], modes)
    return Pairing(chosen, doubt, stray)


def _log_odds(energy: np.ndarray) -> np.ndarray:
    """ln of the odds that a mode is among the peaks."""
    low, high = _PLATFORM
    chance = np.interp(energy, (low, high), _SEEN)
    return np.log(chance / (1.0 - chance))


def _weights(paths: _Paths, own: np.ndarray, log: float, noise: float, odds: np.ndarray) -> np.ndarray:
    """(p, k + 1) log weights with the next peak given to each later mode of its state, or, last, to none."""
    last = np.where(own[paths.chosen] & (paths.chosen >= 0), paths.chosen, -1).max(axis=1, initial=-1)
    free = own & (np.arange(len(own)) > last[:, None])
    variance = np.diagonal(paths.covariance, axis1=1, axis2=2) + noise**2
    logs = odds - 0.5 * ((log - paths.mean) ** 2 / variance + np.log(2.0 * np.pi * variance))
    given = np.where(free, logs, -np.inf)
    return paths.weight[:, None] + np.concatenate([given, np.full((len(given), 1), STRAY)], axis=1)


def _grown(paths: _Paths, logs: np.ndarray, log: float, noise: float) -> _Paths:
    """The best of the longer paths, those with a mode for the peak sharpened by it."""
    best = np.argsort(-logs, axis=None, kind="stable")[:_BEAM]
    best = best[np.isfinite(logs.ravel()[best])]
    before, j = np.unravel_index(best, logs.shape)
    paired, stray = np.flatnonzero(j < logs.shape[1] - 1), j == logs.shape[1] - 1
    chosen = np.concatenate([paths.chosen[before], np.where(stray, -1, j)[:, None]], axis=1)
    mean, covariance = paths.mean[before], paths.covariance[before]
    column = covariance[paired, :, j[paired]]
    gain = column / (column[np.arange(len(paired)), j[paired]] + noise**2)[:, None]
    mean[paired] += gain * (log - mean[paired, j[paired]])[:, None]
    covariance[paired] -= gain[:, :, None] * column[:, None, :]
    return _Paths(logs.ravel()[best], chosen, mean, covariance)


def _agreed(
    paths: _Paths, state: np.ndarray, hertz: np.ndarray, modes: Modes
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The best path, how far the others are from it, and how probably each peak is a stray."""
    table, logs = paths.chosen, paths.weight
    weight = np.exp(logs - logs.max())
    weight /= weight.sum()
    near = np.array([_nearest(s, f, modes) for s, f in zip(state, hertz, strict=True)])
    best = np.where(table[0] >= 0, table[0], near)
    log = np.log(modes.hertz)
    apart = np.where(table >= 0, np.abs(log[table] - log[best]), STRAY_DOUBT)
    return best, np.sqrt((weight[:, None] * apart**2).sum(axis=0)), weight @ (table < 0)


def _nearest(state: int, hertz: float, modes: Modes) -> int:
    own = np.flatnonzero(modes.state == state)
    return int(own[np.abs(np.log(modes.hertz[own] / hertz)).argmin()])

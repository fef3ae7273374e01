"""Which mode of the model is which measured peak? Peaks carry no labels, and some modes were not picked.

All peaks of all states are paired together: the model's frequencies are off by tolerances and noise of the readings
that they share, so each pair taken for granted sharpens the expectation of the others (a Kalman update over modes).
The best few pairings are followed; where they disagree, the frequency is in doubt by as much as they differ.
"""

from dataclasses import dataclass, replace

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


@dataclass(frozen=True, slots=True, eq=False)
class Pairing:
    """chosen (r,) mode of each peak;  doubt (r,) one sigma of ln f from pairings that compete.

    stray (r,) : probability of each peak to belong to no mode
    """

    chosen: np.ndarray
    doubt: np.ndarray
    stray: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class _Path:
    """Pairing of the peaks so far (-1: a stray), its log weight, and the modes' expected ln f with covariance."""

    weight: float
    chosen: tuple[int, ...]
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
    paths = [_Path(0.0, (), np.log(modes.hertz), covariance)]
    odds, shapes = _log_odds(modes.energy), _SHAPE * np.nan_to_num(unlike)
    for i in order:
        log, seen = np.log(hertz[i]), odds - shapes[i]
        grown = [new for path in paths for new in _grown(path, state[i], log, noise[i], modes, seen)]
        grown.sort(key=lambda new: -new[0])
        paths = [_taken(path, j, weight, np.log(hertz[i]), noise[i]) for weight, j, path in grown[:_BEAM]]
    chosen, doubt, stray = np.zeros(len(order), dtype=int), np.zeros(len(order)), np.zeros(len(order))
    chosen[order], doubt[order], stray[order] = _agreed(paths, state[order], hertz[order], modes)
    return Pairing(chosen, doubt, stray)


def _log_odds(energy: np.ndarray) -> np.ndarray:
    """ln of the odds that a mode is among the peaks."""
    low, high = _PLATFORM
    chance = np.interp(energy, (low, high), _SEEN)
    return np.log(chance / (1.0 - chance))


def _grown(
    path: _Path, state: int, log: float, noise: float, modes: Modes, odds: np.ndarray
) -> list[tuple[float, int, _Path]]:
    """Weights of a path with the next peak given to each later mode of its state, or to none."""
    used = [j for j in path.chosen if j >= 0 and modes.state[j] == state]
    free = np.flatnonzero((modes.state == state) & (np.arange(len(odds)) > max(used, default=-1)))
    variance = path.covariance[free, free] + noise**2
    gap = log - path.mean[free]
    logs = path.weight + odds[free] - 0.5 * (gap**2 / variance + np.log(2.0 * np.pi * variance))
    found = [(float(weight), int(j), path) for weight, j in zip(logs, free, strict=True)]
    return [*found, (path.weight + STRAY, -1, path)]


def _taken(path: _Path, j: int, weight: float, log: float, noise: float) -> _Path:
    if j < 0:
        return replace(path, weight=weight, chosen=(*path.chosen, j))
    column = path.covariance[:, j]
    gain = column / (column[j] + noise**2)
    mean = path.mean + gain * (log - path.mean[j])
    return _Path(weight, (*path.chosen, j), mean, path.covariance - np.outer(gain, column))


def _agreed(
    paths: list[_Path], state: np.ndarray, hertz: np.ndarray, modes: Modes
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The best path, how far the others are from it, and how probably each peak is a stray."""
    table = np.array([path.chosen for path in paths])
    logs = np.array([path.weight for path in paths])
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

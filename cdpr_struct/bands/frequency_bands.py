"""Bands of frequencies, to first order: of modes alone in closed form, of modes that may meet from their small
eigenproblem at many draws."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri

from cdpr_struct.bands.mode_rates import ModeRates
from cdpr_struct.robot.tolerances import Spread

DRAWS = 4096  # of each group of modes that may meet
_SEED = 20


@dataclass(frozen=True, slots=True, eq=False)
class FrequencyBands:
    """Bands of k frequencies, counted from the lowest.

    low, high : (k,) [Hz];  sigma : (k,) of ln f
    meeting : groups of modes, from 1, that may change places
    """

    low: np.ndarray
    high: np.ndarray
    sigma: np.ndarray
    meeting: list[list[int]]


def frequency_bands(rates: ModeRates, spread: Spread, level: float) -> FrequencyBands:
    """Central bands that hold with a probability `level`, each frequency by itself.

    spread : which robots are probable, about the one that has the rates
    """
    sigma = np.hypot(spread.sigma(rates.own), spread.scatter)
    reach = ndtri(0.5 + 0.5 * level) * sigma
    low, high = rates.hertz * np.exp(-reach), rates.hertz * np.exp(reach)
    members = [np.flatnonzero(rates.groups == g) for g in range(rates.groups.max(initial=-1) + 1)]
    meeting = [group for group in members if len(group) > 1]
    if meeting:
        changes = drawn_changes(spread)
    for group in meeting:
        logarithm = spread.scattered(_drawn_frequencies(rates, group, changes), _SEED + 1)
        sigma[group] = logarithm.std(axis=0)
        ends = np.exp(np.quantile(logarithm, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0))
        low[group], high[group] = ends
    return FrequencyBands(low, high, sigma, [(group + 1).tolist() for group in meeting])


def chance_above(rates: ModeRates, spread: Spread, mode: int, hertz: float) -> float:
    """Probability that a frequency, from 0 counted from the lowest, lies above a limit [Hz]."""
    group = np.flatnonzero(rates.groups == rates.groups[mode])
    if len(group) == 1:
        own = rates.own[:, [mode]]
        sigma = float(np.hypot(spread.sigma(own)[0], spread.scatter))
        gap = float(np.log(rates.hertz[mode] / hertz))
        return float(ndtr(gap / sigma)) if sigma > 0.0 else float(gap > 0.0)
    drawn = spread.scattered(_drawn_frequencies(rates, group, drawn_changes(spread)), _SEED + 1)
    own_place = int(np.searchsorted(group, mode))
    return float((drawn[:, own_place] > np.log(hertz)).mean())


def drawn_changes(spread: Spread) -> np.ndarray:
    """(n, p) changes of the robot's numbers, drawn in pairs of opposite sign, always the same."""
    drawn = np.random.default_rng(_SEED).standard_normal((DRAWS // 2, spread.root.shape[1]))
    return spread.drawn(np.concatenate([drawn, -drawn]))


def _drawn_frequencies(rates: ModeRates, group: np.ndarray, changes: np.ndarray) -> np.ndarray:
    """(n, g) ln f of the modes of a group, ascending, after changes (n, p)."""
    place = np.full(len(rates.hertz), -1)
    place[group] = np.arange(len(group))
    matrix = np.zeros((len(changes), len(group), len(group)))
    diagonal = np.arange(len(group))
    matrix[:, diagonal, diagonal] = np.log(rates.hertz[group]) + changes @ rates.own[:, group]
    own = np.flatnonzero(np.isin(rates.pairs[:, 0], group))
    first, second = place[rates.pairs[own]].T
    matrix[:, first, second] = matrix[:, second, first] = changes @ rates.mixing[:, own]
    return np.asarray(np.linalg.eigvalsh(matrix))

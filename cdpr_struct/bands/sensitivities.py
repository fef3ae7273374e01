"""What moves each prediction: rates by single numbers, by all cables alike, and shares of the variance."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.tolerances import VARIED, Spread, Varied, places

_SAME = 1e-6  # relative distance below which modes share the rates of their mean


@dataclass(frozen=True, slots=True)
class Mover:
    """A number of a robot, or the same number of all cables changed alike.

    varied : which;  cable : from 1, None if it is the platform's or all cables';  axis : 0, 1, 2 or None
    index : its places among the changes of a robot
    """

    varied: Varied
    cable: int | None
    axis: int | None
    index: tuple[int, ...]


def movers(cables: int) -> list[Mover]:
    """Every number that can move a robot at rest, after it those of all cables alike."""
    return list(_movers(cables))


def _movers(cables: int) -> Iterator[Mover]:
    for varied, place in zip(VARIED, places(cables), strict=True):
        own = range(place.start, place.stop)
        if varied.of_cells:
            continue
        if varied.shape == ():
            yield Mover(varied, None, None, tuple(own))
        elif varied.shape == (3,):
            yield from (Mover(varied, None, axis, (index,)) for axis, index in enumerate(own))
        elif len(varied.shape) == 1:
            yield from (Mover(varied, cable, None, (index,)) for cable, index in enumerate(own, start=1))
            yield Mover(varied, None, None, tuple(own))
        else:
            yield from (Mover(varied, k // 3 + 1, k % 3, (index,)) for k, index in enumerate(own))


def rates_of(rates: np.ndarray, mover: Mover) -> np.ndarray:
    """Rates (...) by a mover, of predicted numbers with rates (p, ...) by single numbers."""
    return np.asarray(rates[list(mover.index)].sum(axis=0))


def of_equal_modes(hertz: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Rates (p, k) of frequencies (k,) [Hz], ascending; of modes at the same frequency those of their mean."""
    group = np.concatenate([[0], np.cumsum(np.diff(hertz) > _SAME * hertz[1:])])
    together = (group[:, None] == group).astype(float)
    return np.asarray(rates @ (together / together.sum(axis=0)))


def variance_shares(rates: np.ndarray, spread: Spread, cables: int) -> dict[str, np.ndarray]:
    """Share (k,) of the variance of each of k predictions that comes of each kind of number, by field.

    rates : (p, k);  spread : which robots are probable
    """
    parts = {
        varied.field: ((rates[place].T @ spread.root[place]) ** 2).sum(axis=1)
        for varied, place in zip(spread.varied, places(cables, spread.varied), strict=True)
    }
    whole = np.maximum(np.sum(list(parts.values()), axis=0), np.finfo(float).tiny)
    return {name: part / whole for name, part in parts.items()}

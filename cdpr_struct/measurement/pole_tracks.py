"""Which poles of a stabilisation diagram are one mode: tracks of poles that stay as the model order grows."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from cdpr_struct.measurement.subspace_poles import Poles

FREQUENCY, DAMPING, SHAPE = 0.01, 0.5, 0.1  # most by which a stable pole's differ: relative, relative, 1 - assurance
_PAUSE = 10  # orders in a row that a track may miss
_FAR = 1e3  # cost of what may not be joined


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Poles of one mode: at each of k orders (numbers into `Poles.order`) one pole (numbers into `Poles.pole`)."""

    order: np.ndarray
    pole: np.ndarray

    def __len__(self) -> int:
        return len(self.order)


def tracks(poles: Poles) -> list[Track]:
    """Tracks through all orders; at each order a pole is in one track, and a track has one pole."""
    open_: list[list[tuple[int, int]]] = []
    closed: list[list[tuple[int, int]]] = []
    for o in range(len(poles.order)):
        own = np.flatnonzero(np.isfinite(poles.pole[o]))
        closed += [t for t in open_ if o - t[-1][0] > _PAUSE + 1]
        open_ = [t for t in open_ if o - t[-1][0] <= _PAUSE + 1]
        joined = _joined(poles, open_, o, own)
        for t, k in joined:
            open_[t].append((o, k))
        taken = {k for _, k in joined}
        open_ += [[(o, int(k))] for k in own if int(k) not in taken]
    found = [np.array(t).T for t in closed + open_]
    return [Track(order, pole) for order, pole in found]


def _joined(poles: Poles, ends: list[list[tuple[int, int]]], o: int, own: np.ndarray) -> list[tuple[int, int]]:
    """Pairs of a track and a pole of order o that continues it."""
    if not ends or not own.size:
        return []
    last = np.array([t[-1] for t in ends])
    before, shape = poles.pole[last[:, 0], last[:, 1]], poles.shape[last[:, 0], last[:, 1]]
    cost = distance(before, shape, poles.pole[o, own], poles.shape[o, own])
    rows, columns = linear_sum_assignment(np.where(np.isfinite(cost), cost, _FAR))
    return [(int(t), int(own[k])) for t, k in zip(rows, columns, strict=True) if np.isfinite(cost[t, k])]


def distance(one: np.ndarray, shape: np.ndarray, other: np.ndarray, like: np.ndarray) -> np.ndarray:
    """(a, b) how far poles (a,) with shapes (a, c) are from others (b,), (b, c), in units of what is stable.

    Infinite where a frequency, a damping ratio or a shape differs by more than that.
    """
    size, ratio = np.abs(one)[:, None], (-one.real / np.abs(one))[:, None]
    turned = np.abs(np.abs(other) / size - 1.0) / FREQUENCY
    damped = np.abs(-other.real / np.abs(other) / ratio - 1.0) / DAMPING
    unlike = (1.0 - np.abs(shape.conj() @ like.T) ** 2) / SHAPE
    return np.where(np.maximum(np.maximum(turned, damped), unlike) <= 1.0, turned + damped + unlike, np.inf)

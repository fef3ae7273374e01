"""How far poles of a record scatter: a jackknife over its blocks, and its two halves."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from scipy.optimize import linear_sum_assignment

from cdpr_struct.measurement.pole_tracks import Track
from cdpr_struct.measurement.subspace_poles import Hankel, Poles, poles

_SAME = 0.03  # of a pole: how far it may move from the whole record to a part of it
_ENOUGH = 0.5  # of the weight of a track's orders


@dataclass(frozen=True, slots=True, eq=False)
class Scatter:
    """Of k tracks: means over their orders, sigmas and checks.

    hertz, hertz_sigma, damping, damping_sigma : (k,) [Hz], [-]
    found  : (k,) share of the blocks without which the poles are still there
    halves : (k,) frequency of the second half of the record less that of the first, over its sigma; nan where absent
    """

    hertz: np.ndarray
    hertz_sigma: np.ndarray
    damping: np.ndarray
    damping_sigma: np.ndarray
    found: np.ndarray
    halves: np.ndarray

    def take(self, index: np.ndarray) -> "Scatter":
        """Some of the tracks."""
        return Scatter(*(getattr(self, part.name)[index] for part in fields(self)))


def scatter(whole: Hankel, found: Poles, chosen: Sequence[Track], step: float, duration: float, every: int) -> Scatter:
    """Scatter of tracks of poles found in the whole record, each of which has poles at multiples of the order `every`.

    step : between samples [s];  duration : of the record [s]

    Sigmas are those of a jackknife that leaves out one block at a time (Efron and Tibshirani, 1993, 11.5). The mean
    over the orders of a track weighs each by its own such variance. A mode rings beyond the end of a block, so that
    blocks are alike: what this hides is added for a memory that decays with the mode's energy. Where the halves of the
    record differ by more than their sigma, sigma grows to what they differ.
    """
    most, count = int(found.order[-1]), len(whole.blocks)
    own = _values(found, chosen, every)
    parts = [_moved(own, poles(whole.without(k), whole.rows, most, step, every)) for k in range(count)]
    left = np.stack(parts)  # (blocks, 2, k, orders)
    weight = _weights(left)
    hertz, ratio = _mean(np.stack([np.abs(own) / (2.0 * np.pi), -own.real / np.abs(own)]), weight)
    moved = _mean(left, weight)
    there = np.isfinite(moved[:, 0])
    sigma = _jackknife(moved) * _memory(hertz, ratio, duration / count)
    first, second = (_mean(_moved(own, poles(h, whole.rows, most, step, every)), weight)[0] for h in whole.halves())
    apart = (second - first) / np.maximum(2.0 * sigma[0], 1e-300)
    grown = sigma * np.fmax(np.abs(apart), 1.0)
    return Scatter(hertz, grown[0], ratio, grown[1], there.mean(axis=0), apart)


def _values(found: Poles, chosen: Sequence[Track], every: int) -> np.ndarray:
    """(k, o) poles of tracks at multiples of the order `every`, nan where a track has none."""
    own = np.full((len(chosen), len(found.order)), complex(np.nan, np.nan))
    for i, track in enumerate(chosen):
        own[i, track.order] = found.pole[track.order, track.pole]
    return own[:, found.order % every == 0]


def _moved(own: np.ndarray, other: Poles) -> np.ndarray:
    """(2, k, o) how far frequencies [Hz] and damping ratios of poles (k, o) are in another set; nan where not there."""
    moved = np.full((2, *own.shape), np.nan)
    for o in range(own.shape[1]):
        which = np.flatnonzero(np.isfinite(own[:, o]))
        there = other.pole[o][np.isfinite(other.pole[o])]
        far = np.abs(own[which, o][:, None] - there[None]) / np.abs(own[which, o])[:, None]
        rows, columns = linear_sum_assignment(np.minimum(far, _SAME))  # a pole without a partner takes no other's
        near = far[rows, columns] < _SAME
        one, two, here = own[which[rows[near]], o], there[columns[near]], which[rows[near]]
        moved[0, here, o] = (np.abs(two) - np.abs(one)) / (2.0 * np.pi)
        moved[1, here, o] = -two.real / np.abs(two) + one.real / np.abs(one)
    return moved


def _jackknife(moved: np.ndarray) -> np.ndarray:
    """Standard deviations from values (blocks, ...) each without one block; nan where it is not there."""
    there = np.isfinite(moved)
    count = np.maximum(there.sum(axis=0), 1)
    middle = np.where(there, moved, 0.0).sum(axis=0) / count
    square = np.where(there, (moved - middle) ** 2, 0.0).sum(axis=0) / count
    return np.asarray(np.sqrt((len(moved) - 1.0) * square))


def _weights(left: np.ndarray) -> np.ndarray:
    """(k, o) of the orders of each track, sum 1: inverse variances of the frequency."""
    share = np.isfinite(left[:, 0]).mean(axis=0)
    variance = _jackknife(left[:, 0]) ** 2
    least = np.maximum(np.nanmedian(variance[share > 0.0]) if (share > 0.0).any() else 1.0, 1e-300) * 1e-6
    weight = np.where(share > 0.0, share / np.maximum(variance, least), 0.0)
    return np.asarray(weight / np.maximum(weight.sum(axis=1, keepdims=True), 1e-300))


def _mean(values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(..., k) means of values (..., k, o) over the orders where they are; nan where most of the weight is missing."""
    there = np.isfinite(values)
    total = np.where(there, weight, 0.0).sum(axis=-1)
    mean = np.where(there, values * weight, 0.0).sum(axis=-1) / np.maximum(total, 1e-300)
    return np.asarray(np.where(total >= _ENOUGH, mean, np.nan))


def _memory(hertz: np.ndarray, ratio: np.ndarray, block: float) -> np.ndarray:
    """(k,) factor on the sigma from blocks of that duration [s], whose means are correlated by a memory exp(-t / tau).

    The variance of a block's mean is 2 tau / block (1 - tau / block (1 - exp(-block / tau))) times that of a value, and
    that of a long record's mean lacks the second factor.
    """
    short = 1.0 / np.maximum(4.0 * np.pi * ratio * hertz * block, 1e-12)
    share = 1.0 - short * (1.0 - np.exp(-1.0 / short))
    return np.asarray(1.0 / np.sqrt(np.maximum(share, 1e-3)))

"""What value does a refined mesh tend to, how fast, and how sure is that?

The values are taken as limit + c h^p with h = 1 / elements; three meshes fix limit, c and p. Nothing is
assumed about p: a known order is something to compare `Extrapolation.order` with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

NOISE = 64.0 * float(np.finfo(float).eps)
ORDER_RANGE = (0.05, 12.0)


@dataclass(frozen=True, eq=False)
class Extrapolation:
    """Limit of a sequence of meshes; every array has the shape of one value.

    limit          : extrapolated value
    order          : observed order p; nan where the last three values show none
    error_estimate : how far `limit` may be off, at least the round-off of the values
    reason         : "" where an order was found, else "noise floor", "not monotone" or "order out of range"
    """

    limit: np.ndarray
    order: np.ndarray
    error_estimate: np.ndarray
    reason: np.ndarray


def extrapolate(elements: Sequence[int], values: ArrayLike, noise: ArrayLike = NOISE) -> Extrapolation:
    """Fit limit and order to the three finest meshes.

    Parameters
    ----------
    elements : numbers of elements, increasing, at least three; need not double.
    values : (len(elements), ...) any quantity that converges.
    noise : relative size of differences that count as round-off, scalar or shape of one value.

    Returns
    -------
    Extrapolation. The error estimate is the change of the limit against the next coarser three meshes, or,
    with three meshes only, against the limit for order two. Without an order the limit is the finest value
    and the estimate the spread of the last three.

    Raises
    ------
    ValueError : fewer than three meshes, not increasing, or values of another length.
    """
    sizes, data = np.asarray(elements, dtype=float), np.asarray(values, dtype=float)
    if len(sizes) < 3 or (np.diff(sizes) <= 0.0).any():
        raise ValueError(f"elements must hold at least three increasing counts, got {list(elements)!r}")
    if len(data) != len(sizes):
        raise ValueError(f"values must have one entry per mesh ({len(sizes)}), got {len(data)}")
    limit, order, reason = _three_point(1.0 / sizes[-3:], data[-3:], np.asarray(noise, dtype=float))
    if len(sizes) > 3:
        other = _three_point(1.0 / sizes[-4:-1], data[-4:-1], np.asarray(noise, dtype=float))[0]
    else:
        other = _given_order(1.0 / sizes[-2:], data[-2:], np.array(2.0))
    roundoff = np.maximum(noise, NOISE) * np.abs(data[-1])
    error = np.where(reason == "", np.abs(limit - other), np.ptp(data[-3:], axis=0))
    return Extrapolation(limit, order, np.maximum(error, roundoff), reason)


def _given_order(steps: np.ndarray, values: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Limit from two meshes (coarse, fine) when the order is known."""
    ratio = (steps[0] / steps[1]) ** order
    return np.asarray(values[1] + (values[1] - values[0]) / (ratio - 1.0))


def _three_point(steps: np.ndarray, values: np.ndarray, noise: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Limit, order and reason from three meshes, coarse to fine."""
    coarse, fine = values[1] - values[0], values[2] - values[1]
    small = np.minimum(np.abs(coarse), np.abs(fine)) <= noise * np.abs(values[2])
    ratio = np.divide(coarse, fine, out=np.full_like(fine, np.nan), where=fine != 0.0)
    low, high = (_difference_ratio(steps, np.asarray(order)) for order in ORDER_RANGE)
    outside = ~((ratio > low) & (ratio < high))
    reason = np.where(
        small,
        "noise floor",
        np.where(~(ratio > 0.0), "not monotone", np.where(outside, "order out of range", "")),
    )
    usable = reason == ""
    order = _order(steps, np.where(usable, ratio, 0.5 * (low + high)))
    limit = np.where(usable, _given_order(steps[1:], values[1:], order), values[2])
    return limit, np.where(usable, order, np.nan), reason


def _difference_ratio(steps: np.ndarray, order: np.ndarray) -> np.ndarray:
    """(h1^p - h2^p) / (h2^p - h3^p), increasing in p."""
    first, last = (steps[0] / steps[1]) ** order, (steps[2] / steps[1]) ** order
    return np.asarray((first - 1.0) / (1.0 - last))


def _order(steps: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Bisect the order p that gives the measured ratio of differences."""
    low, high = (np.full_like(ratio, bound) for bound in ORDER_RANGE)
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = _difference_ratio(steps, middle) > ratio
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.asarray(0.5 * (low + high))

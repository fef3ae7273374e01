"""Checked, read-only float arrays: what every value object of this package is made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def fixed_array(name: str, value: ArrayLike, shape: tuple[int | None, ...]) -> np.ndarray:
    """Copy `value` to a read-only float64 array; a None in `shape` leaves that axis free.

    Raises
    ------
    ValueError : another shape, or an entry that is not finite; both with the name and the value.
    """
    array = np.array(value, dtype=float)
    fits = array.ndim == len(shape) and all(want in (None, have) for want, have in zip(shape, array.shape, strict=True))
    if not fits:
        raise ValueError(f"{name} must have shape {shape}, got {array.shape}")
    if not np.isfinite(array).all():
        first = tuple(int(index) for index in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name} must be finite, got {array[first]!r} at {first}")
    array.setflags(write=False)
    return array


def element_count(value: int, minimum: int = 2) -> int:
    """Check a number of elements; raises ValueError below `minimum` or for a non-integer."""
    if int(value) != value or value < minimum:
        raise ValueError(f"elements must be an integer of at least {minimum}, got {value!r}")
    return int(value)

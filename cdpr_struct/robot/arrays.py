"""Checks that value objects run at birth."""

from typing import Any

import numpy as np
import numpy.typing as npt


def frozen_array(value: npt.ArrayLike, shape: tuple[int, ...], name: str) -> np.ndarray:
    """Copy `value` to a read-only float64 array of `shape` (-1 stands for any length).

    Raises
    ------
    ValueError : wrong shape, or an entry that is not finite.
    """
    array = np.array(value, dtype=np.float64)
    matches = array.ndim == len(shape) and all(
        want in (-1, have) for want, have in zip(shape, array.shape, strict=True)
    )
    if not matches:
        raise ValueError(f"{name} must have shape {shape}, got {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite, got {array.tolist()}")
    array.setflags(write=False)
    return array


def require_positive(instance: Any, *names: str) -> None:
    """Raise ValueError unless every named attribute is a finite number above zero (nan is refused)."""
    for name in names:
        value = getattr(instance, name)
        if not 0.0 < value < float("inf"):
            raise ValueError(f"{type(instance).__name__}.{name} must be positive and finite, got {value!r}")

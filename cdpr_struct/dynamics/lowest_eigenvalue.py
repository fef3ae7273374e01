"""The lowest eigenvalue of very many small symmetric pencils, each with the proof that none lies below.

Matrices lie as (i, j, ...) arrays whose last axes are the batch.
"""

import numpy as np

from cdpr_struct.statics.small_systems import eliminate, substituted_back

_STEPS = 8
_SAME = 1e-13


def lowest_eigenvalue(
    stiffness: np.ndarray, mass: np.ndarray | None = None, start: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Lowest lambda of K v = lambda M v, and where it is proved.

    Rayleigh quotients of the last coordinate with what follows it at the last quotient: each error is about the cube of
    the one before. At the end K - lambda M without its last coordinate has only positive pivots, so that no other
    eigenvalue lies below; elsewhere nothing is proved.

    Parameters
    ----------
    stiffness : (n, n, ...) K, symmetric; the last coordinate is nearly the lowest mode
    mass : (n, n, ...) M, symmetric and positive; the unit matrix if not given
    start : (...) first guess of lambda, else the quotient of the last coordinate

    Returns
    -------
    lambda (...), proved (...) bool.
    """
    every = np.arange(len(stiffness))
    value = start
    if value is None:
        value = stiffness[-1, -1] / (1.0 if mass is None else mass[-1, -1])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(_STEPS):
            matrix = _shifted(stiffness, mass, value)
            shares = eliminate(matrix, len(every) - 1)
            pivots = matrix[every[:-1], every[:-1]]
            followed = substituted_back(shares, -(matrix[:-1, -1] / pivots)[:, None])[:, 0]
            step = matrix[-1, -1] / _size(np.concatenate([followed, np.ones((1, *value.shape))]), mass)
            value = value + step
            same = np.abs(step) <= _SAME * np.abs(value)
            if same.all():
                break
        proved = same & (pivots > 0.0).all(axis=0)
    return np.asarray(value), np.asarray(proved)


def _shifted(stiffness: np.ndarray, mass: np.ndarray | None, value: np.ndarray) -> np.ndarray:
    if mass is not None:
        return stiffness - value * mass
    matrix = stiffness.copy()
    every = np.arange(len(matrix))
    matrix[every, every] -= value
    return matrix


def _size(shape: np.ndarray, mass: np.ndarray | None) -> np.ndarray:
    """v^T M v (...) of v (n, ...)."""
    if mass is None:
        return np.asarray((shape**2).sum(axis=0))
    return np.asarray((shape * (mass * shape).sum(axis=1)).sum(axis=0))

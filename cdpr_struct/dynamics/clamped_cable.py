"""How many natural frequencies a taut cable with both ends held has below omega, and which they are.

Out of plane Omega = n pi. In plane, antisymmetric Omega = 2 n pi; symmetric, the roots of Irvine's equation, of which
exactly one lies between (2 n - 1) pi and (2 n + 1) pi.
"""

import numpy as np

from cdpr_struct.dynamics.taut_cables import TautCables
from cdpr_struct.errors import ConvergenceError
from cdpr_struct.generated.cable_dsm import clamped_frequency_function

_SAME = 4.0 * float(np.finfo(float).eps)  # relative: two roots in a row that differ by rounding
_MISSED = 1e-9  # relative: roots in a row that differ by more were not found
_ROOT_STEPS = 60


def clamped_count(cables: TautCables, omega: np.ndarray) -> np.ndarray:
    """Number of clamped natural frequencies strictly below omega, per cable.

    Parameters
    ----------
    omega : broadcasts against (..., m) [rad/s]

    Returns
    -------
    (..., m) integers.
    """
    parameter = omega / cables.frequency_scale
    out_of_plane = _below(parameter / np.pi)
    antisymmetric = _below(parameter / (2.0 * np.pi))
    return out_of_plane + antisymmetric + _symmetric_count(parameter, cables.lambda_squared)


def _below(ratio: np.ndarray) -> np.ndarray:
    return np.maximum(np.ceil(ratio).astype(int) - 1, 0)


def _symmetric_count(parameter: np.ndarray, lambda2: np.ndarray) -> np.ndarray:
    interval = np.floor(parameter / (2.0 * np.pi) + 0.5).astype(int)
    sign_before_root = np.where(interval % 2 == 1, 1.0, -1.0)
    passed = clamped_frequency_function(parameter, lambda2) * sign_before_root < 0.0
    return np.where(interval > 0, interval - 1 + passed, 0)


def symmetric_roots(lambda2: np.ndarray, count: int) -> np.ndarray:
    """First `count` symmetric in-plane frequency parameters Omega (..., count): roots of Irvine's equation.

    False position in the interval that holds exactly one root; the value at an end that stays twice is halved
    (Illinois).
    """
    number = np.arange(1, count + 1)
    lambda2 = np.asarray(lambda2)[..., None]
    low = np.broadcast_to((2 * number - 1) * np.pi, (*lambda2.shape[:-1], count)).copy()
    high = low + 2.0 * np.pi
    below, above = clamped_frequency_function(low, lambda2), clamped_frequency_function(high, lambda2)
    start, at_start = (
        low,
        np.abs(below) <= _SAME * low,
    )  # with hardly any sag both ends are zeros; the root is the first
    root, first, last_left = low, True, np.zeros(low.shape, dtype=bool)
    for _ in range(_ROOT_STEPS):
        rise = above - below
        crossing = (low * above - high * below) / np.where(rise == 0.0, 1.0, rise)
        before, root = root, np.where(rise == 0.0, root, np.clip(crossing, low, high))
        value = clamped_frequency_function(root, lambda2)
        left = value * above < 0.0
        stuck = (left == last_left) & (not first)
        below = np.where(left, value, np.where(stuck, 0.5 * below, below))
        above = np.where(left, np.where(stuck, 0.5 * above, above), value)
        low, high = np.where(left, root, low), np.where(left, high, root)
        if (np.abs(root - before) <= _SAME * root).all():
            break
        first, last_left = False, left
    else:
        moved = float(np.where(at_start, 0.0, np.abs(root - before) / root).max())
        if moved > _MISSED:
            hint = "Give a sag parameter of an ordinary cable."
            raise ConvergenceError("roots of Irvine's equation", moved, _ROOT_STEPS, hint)
    return np.where(at_start, start, root)

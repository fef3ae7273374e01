"""How unsure is the model of modal constants, beyond the first order of tolerances and readings?

The logarithm of 1 + x bends by x^2 / 2, and a mode that turns by an angle loses the square of it. Of a normal number of
variance s^2 the square has the root mean square sqrt 3 s^2.
"""

from functools import lru_cache

import numpy as np

from cdpr_struct.residuals.linearised import Local, tolerance_term

_STEP = 0.05  # of a sigma, of differences that are straight
_SQUARE = 3.0  # fourth moment of a standard normal number
_KEPT = 4  # robots as entered whose doubts are kept


@lru_cache(maxsize=_KEPT)
def doubt_of_sizes(local: Local) -> np.ndarray:
    """(a,) one sigma of ln of modal constants: modes that may be in their sums, and the second order of tolerances."""
    if local.vibrating is None or local.vibrating.sizes is None:
        return np.zeros(len(local.r.sizes))
    term = tolerance_term(local.data)
    moved = term.applied(local.arrays, _STEP * np.eye(len(term.sigma))[:, None, :])
    turned = local.vibrating.turns(moved, local.point.readings(local.data), len(term.sigma)) / _STEP
    bent = 0.5 * (np.square(local.own_columns.sizes).sum(axis=1) + np.square(posed_sizes(local)).sum(axis=1))
    lost = np.square(turned).sum(axis=0)
    return np.asarray(np.sqrt(local.vibrating.sizes.doubt**2 + _SQUARE * (bent**2 + lost**2)))


def posed_sizes(local: Local) -> np.ndarray:
    """(a, 6 + 2 m) change of ln of modal constants by one sigma of each reading of their state, read or not."""
    if local.vibrating is None:
        return np.zeros((len(local.r.sizes), local.data.sigma.shape[1]))
    known = np.where(local.data.read, 1.0, local.data.unread / local.data.sigma)
    return np.asarray(local.by_noise.sizes * known[local.vibrating.measured.sizes.state])

"""What is the lowest natural frequency of hanging cables whose ends are both held?

The equation of motion is (D u')' + mu omega^2 u = 0 with D = EA t t^T + G (1 - t t^T), t the tangent, T the tension and
G = T / (1 + T / EA). Since G < EA, D - G is nowhere negative: no frequency in the plane lies below the lowest out of
it, which is that of the string (G u')' + mu omega^2 u = 0.
"""

import numpy as np

from cdpr_struct.dynamics.condensed_cables import HangingCables
from cdpr_struct.dynamics.string_functions import string_functions
from cdpr_struct.statics.small_systems import eliminate, substituted_back

_STEPS = 6
_SAME = 1e-14


def lowest_clamped(cables: HangingCables, order: int) -> np.ndarray:
    """Lowest squared frequencies (m, n) [rad^2/s^2], by polynomials up to degree `order`.

    Rayleigh quotients of the string's first function with what follows it at the last quotient: from above, each error
    about the cube of the one before.
    """
    functions = string_functions(order)
    across = cables.out_of_plane(functions.nodes)
    blocks = (functions.pairs @ across.reshape(len(across), -1)).reshape((-1, *cables.length.shape))
    turned = np.r_[1 : functions.count - 1, 0]
    whole = blocks[functions.pair[np.ix_(turned, turned)]]
    every = np.arange(len(turned))
    squared = whole[-1, -1]
    for _ in range(_STEPS):
        matrix = whole.copy()
        matrix[every, every] -= squared
        shares = eliminate(matrix, len(turned) - 1)
        pivots = matrix[every[:-1], every[:-1]]
        followed = substituted_back(shares, -(matrix[:-1, -1] / pivots)[:, None])
        step = matrix[-1, -1] / (1.0 + (followed**2).sum(axis=(0, 1)))
        squared = squared + step
        if (np.abs(step) <= _SAME * squared).all():
            break
    return np.asarray(squared / cables.per_squared)

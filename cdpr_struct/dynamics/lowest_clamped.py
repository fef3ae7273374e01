"""What is the lowest natural frequency of hanging cables whose ends are both held?

The equation of motion is (D u')' + mu omega^2 u = 0 with D = EA t t^T + G (1 - t t^T), t the tangent, T the tension and
G = T / (1 + T / EA). Since G < EA, D - G is nowhere negative: no frequency in the plane lies below the lowest out of
it, which is that of the string (G u')' + mu omega^2 u = 0.
"""

import numpy as np

from cdpr_struct.dynamics.condensed_cables import HangingCables
from cdpr_struct.dynamics.lowest_eigenvalue import lowest_eigenvalue
from cdpr_struct.dynamics.string_functions import string_functions


def lowest_clamped(cables: HangingCables, order: int) -> np.ndarray:
    """Lowest squared frequencies (m, n) [rad^2/s^2], by polynomials up to degree `order`.

    From above; nan where it is not proved that no other lies below, as may be where the string's first function is far
    from the mode.
    """
    functions = string_functions(order)
    across = cables.out_of_plane(functions.nodes)
    blocks = (functions.pairs @ across.reshape(len(across), -1)).reshape((-1, *cables.length.shape))
    turned = np.r_[1 : functions.count - 1, 0]
    whole = blocks[functions.pair[np.ix_(turned, turned)]]
    squared, proved = lowest_eigenvalue(whole)
    return np.where(proved, squared / cables.per_squared, np.nan)

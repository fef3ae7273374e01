"""Below which frequency has no eliminated motion of a cable its own?

For any r < D_aa / G, D >= diag(r G, b) along and across the chord with b = D_nn - D_an^2 / (D_aa - r G). Squared
frequencies are then no less than r G (b, G) times those of a uniform string in the functions eliminated along it
(across it, out of the plane). Where the frame end gives way, that string's end is on the spring that
`FrameSprings.along_axes` leaves of the frame's, in units of 2 r G / L (2 b / L, 2 G / L).
"""

import numpy as np

from cdpr_struct.dynamics.frame_springs import softened
from cdpr_struct.dynamics.string_functions import StringFunctions

_SHARES = (1.0, 0.7, 0.5)  # of the ratio of the string's functions: the r that are tried
_GIVING = (2.0, 1.4, *_SHARES)  # where the frame end gives way along the cable


def lowest_eliminated(
    densities: tuple[np.ndarray, ...], functions: StringFunctions, leads: int, springs: np.ndarray | None
) -> np.ndarray:
    """(m, n) omega^2 in units of 4 / (mu L^2), so much at least.

    densities : D_aa, D_an, D_nn and D_yy (q, m, n) [N]
    springs   : (3, m, n) at the frame ends along a, n and y, times L / 2 [N]; None where they are fixed
    """
    aa, an, nn, soft = densities
    first, across = functions.string[0], functions.string[leads]
    most, least = 0.5 * (aa / soft).min(axis=0), soft.min(axis=0)

    def lowest(stiffness: np.ndarray, kept: int, axis: int) -> np.ndarray:
        if springs is None:
            return np.asarray(functions.string[kept] * stiffness)
        safe = np.maximum(stiffness, np.finfo(float).tiny)
        return np.where(stiffness > 0.0, safe * softened(springs[axis] / safe, functions.bubbles + 1, kept), 0.0)

    bounds = []
    for ratio in (np.minimum(share * across / first, most) for share in (_SHARES if springs is None else _GIVING)):
        own = (nn - an**2 / (aa - ratio * soft)).min(axis=0)
        bounds.append(np.minimum(lowest(own, leads, 1), lowest(ratio * least, 0, 0)))
    return np.asarray(np.minimum(np.max(bounds, axis=0), lowest(least, leads, 2)))

"""Where do steps that shrink by the same ratio lead? Aitken's extrapolation, in logarithms of expected squares.

Variational steps converge linearly: with one slow direction, change n + 1 is the ratio times change n, and all further
changes add up to ratio/(1 - ratio) times the last one (Aitken 1926; for EM: McLachlan, Krishnan, section 4.8).
"""

from collections.abc import Sequence

import numpy as np

# Ratios [-] that are worth a leap: below the first, three plain steps leave less than 3 % of the way; the second is a
# leap of 19 steps, beyond which the ratio of two changes is too uncertain.
SLOW = 0.3
SLOWEST = 0.95


def extrapolated(squares: Sequence[np.ndarray], free: np.ndarray) -> np.ndarray | None:
    """Expected squares (G,) after all further steps, from those of the last three steps; None if it is not worth it.

    free : (G,) groups whose squares matter; the others stay as they are.
    """
    if len(squares) < 3:
        return None
    logs = np.log(np.maximum([square[free] for square in squares[-3:]], np.finfo(float).tiny))
    before, change = np.diff(logs, axis=0)
    length = before @ before
    ratio = min(change @ before / length, SLOWEST) if length > 0.0 else 0.0
    if ratio < SLOW:
        return None
    found = squares[-1].copy()
    found[free] *= np.exp(ratio / (1.0 - ratio) * change)
    return found

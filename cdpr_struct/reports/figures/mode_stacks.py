"""Frequencies that a plot cannot show side by side are stacked, so that their number stays visible."""

import numpy as np


def stack_levels(hertz: np.ndarray, width: float) -> np.ndarray:
    """Level (k,) 1, 2, .. of each frequency in its stack; a stack spans at most `width` [Hz]."""
    levels = np.ones(len(hertz), dtype=int)
    start, level = -np.inf, 0
    for i in np.argsort(hertz, kind="stable"):
        if hertz[i] - start > width:
            start, level = hertz[i], 0
        level += 1
        levels[i] = level
    return levels


def densest_window(hertz: np.ndarray, width: float) -> tuple[float, float]:
    """Ends of the interval that holds the most frequencies within `width` [Hz], with a margin around them."""
    ordered = np.sort(hertz)
    inside = np.searchsorted(ordered, ordered + width, side="right") - np.arange(len(ordered))
    first = int(np.argmax(inside))
    low, high = ordered[first], ordered[first + inside[first] - 1]
    margin = max(0.15 * (high - low), 0.1 * width)
    return float(max(low - margin, 0.0)), float(high + margin)

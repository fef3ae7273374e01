"""When does a search of many items at once get no further?"""

import numpy as np

_SHRINKS = 0.9  # by so much what is off has to shrink
_PATIENCE = 6  # rounds in a row without


class Standstill:
    """Counts the rounds in which no item that is still open comes nearer to its end than it ever was."""

    def __init__(self) -> None:
        self._least: np.ndarray | None = None
        self._idle = 0

    def reached(self, off: np.ndarray, going: np.ndarray) -> bool:
        """Whether to give up, as items (...) are `off` by so much and some are still `going`."""
        if self._least is None:
            self._least = np.array(off)
            return False
        nearer = off <= _SHRINKS * self._least
        self._idle = 0 if (nearer & going).any() else self._idle + 1
        self._least = np.where(nearer, off, self._least)
        return self._idle >= _PATIENCE

"""Repeating a step until it stays, with the memory that also settles what plain repetition would drive apart."""

from __future__ import annotations

from collections import deque

import numpy as np

MEMORY = 12  # earlier steps that are kept, of the at most 16 ways in which masts give way


class Settling:
    """Anderson's acceleration of x = g(x): the mix of earlier steps whose misses would cancel."""

    def __init__(self) -> None:
        self._tried: deque[np.ndarray] = deque(maxlen=MEMORY)
        self._misses: deque[np.ndarray] = deque(maxlen=MEMORY)

    def next(self, tried: np.ndarray, answer: np.ndarray) -> np.ndarray:
        """What to try after g(tried) was `answer`; arrays of one shape throughout."""
        self._tried.append(tried.ravel())
        self._misses.append((answer - tried).ravel())
        if len(self._misses) == 1:
            return answer
        steps, changes = (np.diff(np.array(kept), axis=0).T for kept in (self._tried, self._misses))
        mix = np.linalg.lstsq(changes, self._misses[-1], rcond=1e-10)[0]
        return np.asarray(answer - ((steps + changes) @ mix).reshape(answer.shape))

"""Fixed points of many small vectors at once, extrapolated from the last two steps (Anderson, 1965)."""

import numpy as np

_DEPTH = 2
_SMALLEST = 1e-10  # of singular values: steps that say the same


class FixedPoint:
    """A search for x = g(x), items (...) of vectors (..., n), that remembers the last steps of each.

    With residuals r = g(x) - x, the next point is g(x) less the combination of the last changes of g whose changes of r
    come nearest to r: one vector of two unknowns is found as a secant finds a root.
    """

    def __init__(self) -> None:
        self._points: list[tuple[np.ndarray, np.ndarray]] = []

    def next(self, x: np.ndarray, image: np.ndarray) -> np.ndarray:
        """The next point (..., n) after x and g(x)."""
        self._points = [*self._points[-_DEPTH:], (image, image - x)]
        if len(self._points) == 1:
            return image
        images, residuals = (np.stack(part, axis=-1) for part in zip(*self._points, strict=True))
        moved, changed = np.diff(images, axis=-1), np.diff(residuals, axis=-1)
        share = np.linalg.pinv(changed, rcond=_SMALLEST) @ residuals[..., -1:]
        return np.asarray(image - (moved @ share)[..., 0])

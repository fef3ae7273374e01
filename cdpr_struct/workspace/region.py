"""How large is the part of a grid in which something holds, and where does it end? Refined where it ends.

A cell of the grid counts with the share of its corners that hold (the trapezoidal rule). Halving the grid computes
poses only in cells whose corners disagree; what lies in a cell whose corners agree is taken to agree with them, so a
hole or an island smaller than a cell of the first grid is not seen.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from cdpr_struct.workspace.grid import AXES, Grid

_ROUNDS = 1.0 / np.sqrt(12.0)  # standard deviation of where a boundary lies between two poses, of their distance


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """Poses of a grid that hold.

    grid : of one to three axes;  holds : (n,) bool;  coarser : the region before the grid was halved, or None
    """

    grid: Grid
    holds: np.ndarray
    coarser: "Region | None" = None

    @property
    def volume(self) -> float:
        """[m^3], or m^2 or m where the grid has fewer axes."""
        return float((self._share * self._cells).sum())

    @property
    def inner(self) -> float:
        """Volume of the cells all of whose corners hold."""
        return float(self._cells[self._share == 1.0].sum())

    @property
    def outer(self) -> float:
        """Volume of the cells any corner of which holds."""
        return float(self._cells[self._share > 0.0].sum())

    @property
    def mixed(self) -> np.ndarray:
        """Bool over the cells: their corners disagree."""
        return np.asarray((self._share > 0.0) & (self._share < 1.0))

    @property
    def error(self) -> float:
        """Estimated error of the volume; without a halving half of all cells that the boundary crosses.

        What the last halving changed, summed over the parts of the boundary that face along +x, -x, +y, ..: on a part
        that lies along the grid a count is wrong by at most as much as that. The scatter of a boundary that lies
        anywhere between poses is added.
        """
        crossed = self._cells[self.mixed]
        if self.coarser is None:
            return 0.5 * float(crossed.sum())
        return self._changed(self.coarser) + _ROUNDS * float(np.sqrt((crossed**2).sum()))

    def _changed(self, before: "Region") -> float:
        """What a halving changed: the sizes of the net changes on each part of the boundary, added."""
        now, free = self._share * self._cells, self.grid.free
        for i in free:
            now = np.take(now, range(0, now.shape[i], 2), i) + np.take(now, range(1, now.shape[i], 2), i)
        change = now - before._share * before._cells
        slopes = np.stack([before._mean_over_corners(i) for i in free])
        axis = np.abs(slopes).argmax(axis=0)
        ahead = np.take_along_axis(slopes, axis[None], axis=0)[0] > 0.0
        return float(np.abs(np.bincount((2 * axis + ahead).ravel(), weights=change.ravel())).sum())

    @property
    def levels(self) -> list["Region"]:
        """From the first grid to this one."""
        return [*([] if self.coarser is None else self.coarser.levels), self]

    @property
    def touches_edge(self) -> bool:
        """Whether something holds on the edge of the grid, so that the region may go on beyond."""
        box = self.holds.reshape(self.grid.shape)
        return any(bool(np.take(box, end, axis=i).any()) for i in self.grid.free for end in (0, -1))

    def next_grid(self) -> tuple[Grid, np.ndarray, np.ndarray]:
        """The halved grid; what is known of its poses (n,) bool; which of them are to be computed (n,) bool."""
        free, shape = self.grid.free, self.grid.shape
        halved = replace(self.grid, **{AXES[i]: _halved(self.grid.axes[i]) for i in free})
        known, asked = np.zeros(halved.shape, dtype=bool), np.zeros(halved.shape, dtype=bool)
        whole, mixed = self._share == 1.0, self.mixed
        for step in product(*(range(3) if i in free else (0,) for i in range(3))):
            part = tuple(
                slice(s, s + 2 * (n - 1), 2) if n > 1 else slice(0, 1) for s, n in zip(step, shape, strict=True)
            )
            known[part] |= whole
            asked[part] |= mixed
        old = tuple(slice(None, None, 2) if i in free else slice(None) for i in range(3))
        known[old], asked[old] = self.holds.reshape(shape), False
        return halved, known.ravel(), asked.ravel()

    @property
    def _share(self) -> np.ndarray:
        """Over the cells: share of their corners that hold."""
        return self._mean_over_corners(None)

    def _mean_over_corners(self, across: int | None) -> np.ndarray:
        """Over the cells: mean of their corners; along the axis `across`, the difference of the two sides instead."""
        value = self.holds.reshape(self.grid.shape).astype(float)
        for i in self.grid.free:
            ahead, back = np.take(value, range(1, value.shape[i]), i), np.take(value, range(value.shape[i] - 1), i)
            value = ahead - back if i == across else 0.5 * (ahead + back)
        return value

    @property
    def _cells(self) -> np.ndarray:
        """Volume of each cell."""
        sides = [np.diff(axis) if len(axis) > 1 else np.ones(1) for axis in self.grid.axes]
        return np.einsum("i,j,k->ijk", *sides)


def _halved(axis: np.ndarray) -> np.ndarray:
    fine = np.empty(2 * len(axis) - 1)
    fine[::2], fine[1::2] = axis, 0.5 * (axis[1:] + axis[:-1])
    return fine

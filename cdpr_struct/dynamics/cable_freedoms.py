"""In which freedoms does a cable of coupled axes move, and what stiffness and mass have they?

A frame end that gives way moves along the directions of its springs; such a motion has the frame end's function in
several axes at once.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.frame_springs import FrameSprings
from cdpr_struct.dynamics.string_functions import StringFunctions

_DENSITY = ((0, 1, None), (1, 2, None), (None, None, 3))  # of two axes, in the order of `HangingCables.densities`
_ON_SPRING = -1  # the axis of a freedom that is none of a, n and y alone


@dataclass(frozen=True, slots=True, eq=False)
class CableFreedoms:
    """Freedoms of a group of axes: axis (0 a, 1 n, 2 y) and function of each.

    The eliminated ones come first, among them the frame springs' last; then the leads, then the moving end.

    springs : of the frame in this group
    eliminated, leads : how many
    mass : (d, d) but for that which frame and moving end share
    """

    axes: tuple[int, ...]
    axis: np.ndarray
    function: np.ndarray
    springs: tuple[int, ...]
    eliminated: int
    leads: int
    mass: np.ndarray

    @classmethod
    def of(cls, axes: tuple[int, ...], springs: tuple[int, ...], functions: StringFunctions, p: int) -> "CableFreedoms":
        """With the first p functions of each axis but a as leads."""
        across = [axis for axis in axes if axis]
        own = [(axis, f) for axis in axes for f in range(p if axis else 0, functions.bubbles)]
        held = [(_ON_SPRING, functions.frame)] * len(springs)
        kept = [(axis, f) for axis in across for f in range(p)] + [(axis, functions.ramp) for axis in axes]
        axis, function = np.array(own + held + kept).T
        same = axis[:, None] == axis[None, :]
        mass = np.where(same, functions.mass[function[:, None], function[None, :]], 0.0)
        mass[len(own) : len(own + held), len(own) : len(own + held)] = np.eye(len(held))
        return cls(axes, axis, function, springs, len(own + held), len(across) * p, mass)

    @property
    def held(self) -> list[tuple[int, int]]:
        """Position and number of the frame springs' freedoms."""
        return list(zip(range(self.eliminated - len(self.springs), self.eliminated), self.springs, strict=True))

    def shared_mass(self, frame: FrameSprings | None, functions: StringFunctions) -> np.ndarray:
        """(c, r, m, n) or (c, r, 1, 1) of eliminated and kept freedoms."""
        constant = self.mass[: self.eliminated, self.eliminated :, None, None]
        if frame is None or not self.springs:
            return constant
        whole = np.array(np.broadcast_to(constant, (*constant.shape[:2], *frame.stiffness.shape[1:])))
        of_ramps = functions.mass[functions.frame, functions.ramp]
        for row, spring in self.held:
            whole[row, self.leads :] = of_ramps * frame.directions[list(self.axes), spring]
        return whole

    def stiffness(self, blocks: list[np.ndarray], functions: StringFunctions, cables: HangingCables) -> np.ndarray:
        """(d, d, m, n), upper triangle, of the four densities' integrals `blocks` with pairs of slopes."""
        d = len(self.axis)
        matrix = np.empty((d, d, *blocks[0].shape[1:]))
        for i in np.flatnonzero(self.axis != _ON_SPRING):
            for axis in set(self.axis[i:].tolist()) - {_ON_SPRING}:
                columns = i + np.flatnonzero(self.axis[i:] == axis)
                density = _DENSITY[self.axis[i]][axis]
                pairs = functions.pair[self.function[i], self.function[columns]]
                matrix[i, columns] = 0.0 if density is None else blocks[density][pairs]
        if cables.frame is not None:
            for row, spring in self.held:
                self._add_spring(matrix, (row, spring), blocks, functions, cables.frame)
                matrix[row, row] += 0.5 * functions.frame_value**2 * cables.length * cables.frame.stiffness[spring]
        return matrix

    def _add_spring(
        self,
        matrix: np.ndarray,
        freedom: tuple[int, int],
        blocks: list[np.ndarray],
        functions: StringFunctions,
        frame: FrameSprings,
    ) -> None:
        """What the cable's own stiffness adds to row and column of a spring's freedom."""
        row, spring = freedom
        pairs, moved = functions.pair[functions.frame, self.function], frame.directions[:, spring]
        for other in np.flatnonzero(self.axis != _ON_SPRING):
            i, j = (other, row) if other < row else (row, other)
            matrix[i, j] = self._pull(blocks, moved, pairs[other], self.axis[other])
        for column, with_spring in self.held:
            pulls = (frame.directions[a, with_spring] * self._pull(blocks, moved, pairs[row], a) for a in self.axes)
            matrix[row, column] = sum(pulls)

    def _pull(self, blocks: list[np.ndarray], moved: np.ndarray, pair: int, axis: int) -> np.ndarray:
        """(m, n) along an axis, of a pair of functions of which one moves in the direction (3, m, n)."""
        known = [(own, density) for own in self.axes if (density := _DENSITY[own][axis]) is not None]
        return np.asarray(sum(moved[own] * blocks[density][pair] for own, density in known))

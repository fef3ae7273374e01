"""Springs that hold the frame ends of very many cables, in the cables' own axes.

What a frame end gives way, along the cable and across the wheel of its pulley, is `frame_give.py`. A spring
k_j in the direction w_j stores k_j x_j^2 / 2. With the compliances B = sum_j w_j w_j^T / k_j that is never less than
springs along the axes alone, whose compliances are the sums of the magnitudes in the rows of B, spring by spring: such
a diagonal matrix less B is diagonally dominant, hence positive.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from cdpr_struct.dynamics.frame_give import frame_give
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.string_functions import string_functions
from cdpr_struct.statics.cable_state import cable_stiffness

_SPRINGS = np.concatenate([[0.0], np.geomspace(1e-2, 1e7, 400)])  # of a uniform string of unit stiffness
_ROUNDING = 1e-9

Groups = tuple[tuple[tuple[int, ...], tuple[int, ...]], ...]
"""Axes (0 a, 1 n, 2 y) of a cable's motion that are coupled with each other, and the frame springs among them."""
PLANES: Groups = (((0, 1), ()), ((2,), ()))  # of fixed frame ends


@dataclass(frozen=True, slots=True, eq=False)
class FrameSprings:
    """q springs at each of (m, n) frame ends; in other directions the ends are fixed.

    directions : (3, q, m, n) orthonormal, along the cables' a, n and y
    stiffness  : (q, m, n) [N/m]
    groups     : which axes they couple: the plane with the first, y with the second, or all where a wheel turns about
                 an axis that is not upright
    """

    directions: np.ndarray
    stiffness: np.ndarray
    groups: Groups

    @classmethod
    def of(cls, point: OperatingPoint, axes: np.ndarray) -> "FrameSprings | None":
        """At poses (n), for axes (3, 3, m, n): a, n and y in the world. None where all frame ends are fixed points."""
        give = frame_give(point)
        if give is None:
            return None
        directions = np.einsum("cxmn,nmxq->cqmn", axes, give.directions, optimize=True)
        stiffness = np.moveaxis(give.stiffness, (2, 1, 0), (0, 1, 2))
        arrays = point.arrays
        upright = not (arrays.pulley_axis[..., :2].any(axis=-1) & (arrays.pulley_radius > 0.0)).any()
        return cls(directions, np.ascontiguousarray(stiffness), _groups(upright, len(stiffness)))

    def take(self, index: np.ndarray) -> "FrameSprings":
        """Some poses."""
        return FrameSprings(self.directions[..., index], self.stiffness[..., index], self.groups)

    @property
    def along_axes(self) -> np.ndarray:
        """(3, m, n) springs along a, n and y that store no more energy [N/m], infinite where the end is fixed."""
        give = np.zeros((3, *self.stiffness.shape[1:]))
        for axes, springs in self.groups:
            for j in springs:
                own = np.abs(self.directions[list(axes), j])
                give[list(axes)] += own * own.sum(axis=0) / self.stiffness[j]
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / give)

    @property
    def give_across(self) -> np.ndarray:
        """(m, n) largest compliance across the chord, in any direction [m/N]."""
        n, y = self.directions[1], self.directions[2]
        mean = 0.5 * ((n**2 + y**2) / self.stiffness).sum(axis=0)
        half = 0.5 * ((n**2 - y**2) / self.stiffness).sum(axis=0)
        return np.asarray(mean + np.hypot(half, (n * y / self.stiffness).sum(axis=0)))


def _groups(upright: bool, count: int) -> Groups:
    if upright:
        return ((0, 1), (0,)), ((2,), tuple(range(1, count)))
    return (((0, 1, 2), tuple(range(count))),)


def beside_springs(point: OperatingPoint) -> np.ndarray | None:
    """(n, m, 3, 3) what the static stiffness of the platform ends has beside that of cables on such springs, world
    [N/m]: what weight does on wheels, beyond its symmetric part. None where all frame ends are fixed.

    A pull at the platform end is one at the frame end, but for the weight between them; with K the free cable's
    stiffness, on springs it is therefore (1 + K B)^-1 K.
    """
    give = frame_give(point)
    if give is None:
        return None
    compliance = (give.directions / give.stiffness[..., None, :]) @ np.swapaxes(give.directions, -1, -2)
    free = cable_stiffness(point.cables)
    return np.asarray(point.end_stiffness - np.linalg.solve(np.eye(3) + free @ compliance, free))


def softened(spring: np.ndarray, order: int, leads: int) -> np.ndarray:
    """(...) lowest squared frequency of a uniform string of unit stiffness and density without its first `leads`
    functions, its frame end on a spring (...); never too high.

    The frequency grows with the spring and is concave in it, so that straight lines between known values lie below.
    """
    return np.interp(spring, _SPRINGS, _on_springs(order, leads))


@cache
def _on_springs(order: int, leads: int) -> np.ndarray:
    functions = string_functions(order, True)
    kept = slice(leads, functions.ramp)
    uniform = functions.uniform[kept, kept]
    matrices = np.repeat(uniform[None], len(_SPRINGS), axis=0)
    matrices[:, -1, -1] += _SPRINGS * functions.frame_value**2
    periods = np.linalg.eigvalsh(np.linalg.inv(matrices))[:, -1]
    return np.asarray((1.0 - _ROUNDING) / periods)

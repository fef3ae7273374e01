"""Modes of the uniform string as polynomials: in which functions is a taut cable's motion nearly diagonal?

On xi in -1..1 the first functions vanish at both ends, the last is the moving end's ramp. Of integrated Legendre
polynomials up to degree N they are those combinations that are orthogonal in mass and stiffness of a uniform string.
Where the frame end gives way there is one more before the ramp: of the polynomials that vanish at the moving end, the
one that is orthogonal in mass to all that vanish at both. It has unit mass, like them.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from cdpr_struct.dynamics.polynomial_basis import polynomial_basis

_SPARE_NODES = 2


@dataclass(frozen=True, slots=True, eq=False)
class StringFunctions:
    """K functions, the ramp last, on q Gauss nodes.

    nodes  : (q,) in -1..1
    pairs  : (K (K + 1) / 2, q) weighted products of slopes, of `pair[i, j]` for functions i and j
    mass   : (K, K) integrals of products; the unit matrix but for the ramp
    string : (N - 1,) squared frequencies of the uniform string of unit stiffness and density, (k pi / 2)^2
    frame_value : of the frame end's function at the frame end; 0 where there is none
    """

    nodes: np.ndarray
    pairs: np.ndarray
    pair: np.ndarray
    mass: np.ndarray
    string: np.ndarray
    frame_value: float

    @property
    def bubbles(self) -> int:
        """N - 1, functions that vanish at both ends."""
        return len(self.string)

    @property
    def frame(self) -> int:
        """Position of the frame end's function, where there is one."""
        return self.bubbles

    @property
    def ramp(self) -> int:
        """Position of the moving end's ramp."""
        return len(self.mass) - 1

    @property
    def uniform(self) -> np.ndarray:
        """(K, K) stiffness of a uniform string of unit stiffness."""
        return np.asarray(self.pairs.sum(axis=1)[self.pair])


@cache
def string_functions(order: int, frame_gives: bool = False) -> StringFunctions:
    """Functions of polynomials up to degree `order`, with the frame end's or without."""
    nodes, weights = legendre.leggauss(order + _SPARE_NODES)
    values, slopes = polynomial_basis(nodes, order)
    mass = (values * weights) @ values.T
    count = order - 1
    periods, turn = np.linalg.eigh(mass[:count, :count])
    whole = np.eye(order + 1)
    whole[:count, :count] = turn[:, ::-1] / np.sqrt(periods[::-1])
    shared = whole[:count, :count].T @ mass[:count, count]
    frame_value = 1.0 / np.sqrt(mass[count, count] - shared @ shared)
    whole[:count, count] = -frame_value * (whole[:count, :count] @ shared)
    whole[count, count] = frame_value
    if not frame_gives:
        whole = np.delete(whole, count, axis=1)
    slopes, mass = whole.T @ slopes, whole.T @ mass @ whole
    size = len(mass)
    first, second = np.triu_indices(size)
    pair = np.zeros((size, size), dtype=int)
    pair[first, second] = pair[second, first] = np.arange(len(first))
    pairs = slopes[first] * slopes[second] * weights
    return StringFunctions(nodes, pairs, pair, mass, 1.0 / periods[::-1], frame_value if frame_gives else 0.0)

"""Modes of the uniform string as polynomials: in which functions is a taut cable's motion nearly diagonal?

On xi in -1..1 the first N - 1 functions vanish at both ends, the last is the moving end's ramp. Of integrated Legendre
polynomials up to degree N they are those combinations that are orthogonal in mass and stiffness of a uniform string.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from cdpr_struct.dynamics.polynomial_basis import polynomial_basis

_SPARE_NODES = 2


@dataclass(frozen=True, slots=True, eq=False)
class StringFunctions:
    """N functions, the ramp last, on q Gauss nodes.

    nodes  : (q,) in -1..1
    pairs  : (N (N + 1) / 2, q) weighted products of slopes, of `pair[i, j]` for functions i and j
    mass   : (N, N) integrals of products; the unit matrix but for the ramp
    string : (N - 1,) squared frequencies of the uniform string of unit stiffness and density, (k pi / 2)^2
    """

    nodes: np.ndarray
    pairs: np.ndarray
    pair: np.ndarray
    mass: np.ndarray
    string: np.ndarray

    @property
    def count(self) -> int:
        """N."""
        return len(self.mass)


@cache
def string_functions(order: int) -> StringFunctions:
    """Functions of polynomials up to degree `order`."""
    nodes, weights = legendre.leggauss(order + _SPARE_NODES)
    values, slopes = (np.delete(part, order - 1, axis=0) for part in polynomial_basis(nodes, order))
    mass = (values * weights) @ values.T
    periods, turn = np.linalg.eigh(mass[:-1, :-1])
    turn = turn[:, ::-1] / np.sqrt(periods[::-1])
    whole = np.eye(order)
    whole[:-1, :-1] = turn
    slopes, mass = whole.T @ slopes, whole.T @ mass @ whole
    first, second = np.triu_indices(order)
    pair = np.zeros((order, order), dtype=int)
    pair[first, second] = pair[second, first] = np.arange(len(first))
    return StringFunctions(nodes, slopes[first] * slopes[second] * weights, pair, mass, 1.0 / periods[::-1])

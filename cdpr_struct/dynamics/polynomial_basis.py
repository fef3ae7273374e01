"""Integrated Legendre polynomials on -1..1: functions that vanish at both ends, and the ramps of the ends."""

from functools import cache

import numpy as np
from numpy.polynomial import legendre


def polynomial_basis(xi: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes (order + 1, ...): order - 1 bubbles, zero at both ends, the ramps of frame and moving end."""
    polynomials = np.moveaxis(legendre.legvander(xi, order), -1, 0)
    k = np.arange(2, order + 1).reshape((-1,) + (1,) * np.ndim(xi))
    bubbles = (polynomials[2:] - polynomials[:-2]) / np.sqrt(2.0 * (2 * k - 1))
    slopes = np.sqrt((2 * k - 1) / 2.0) * polynomials[1:-1]
    half = np.full_like(xi, 0.5)[None]
    return np.concatenate([bubbles, half - 0.5 * xi, half + 0.5 * xi]), np.concatenate([slopes, -half, half])


@cache
def gauss_rule(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights (q,) of Gauss and Legendre's rule on -1..1, found once; read-only."""
    nodes, weights = legendre.leggauss(count)
    nodes.setflags(write=False)
    weights.setflags(write=False)
    return nodes, weights


@cache
def on_gauss_nodes(order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Nodes and weights (q,), values and slopes (order + 1, q) of `polynomial_basis` there; 2 order + 24 nodes."""
    nodes, weights = gauss_rule(2 * order + 24)
    return nodes, weights, *polynomial_basis(nodes, order)


def curvatures(xi: np.ndarray, order: int) -> np.ndarray:
    """Second derivatives (order + 1, q) of the functions of `polynomial_basis`."""
    k = np.arange(2, order + 1)
    series = np.zeros((order + 1, order + 1))
    series[k - 1, k - 2] = np.sqrt((2 * k - 1) / 2.0)
    return legendre.legval(xi, legendre.legder(series))

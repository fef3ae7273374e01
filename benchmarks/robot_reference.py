"""Converged frequencies of a robot: the project's finite elements, extrapolated to infinitely many.

Errors of bars with lumped mass are a series in h^2; meshes that double remove one term each (Romberg). The distance to
what one mesh less gives bounds what is left.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import cdpr_struct.fem_reference as fem

MESHES = (40, 80, 160, 320, 640)


@dataclass(frozen=True, eq=False)
class Converged:
    """hertz : (k,) ascending;  spread : (k,) relative change by the finest mesh."""

    hertz: np.ndarray
    spread: np.ndarray


def converged_frequencies(
    robot: fem.RobotData, position: np.ndarray, count: int, meshes: tuple[int, ...] = MESHES
) -> Converged:
    """First `count` frequencies [Hz] of a robot at rest near a position, platform not turned."""
    rests = (fem.solve_robot(robot, position, np.eye(3), elements) for elements in meshes)
    hertz = [fem.robot_modes(rest, count).frequencies_hz for rest in rests]
    best, coarser = romberg(hertz), romberg(hertz[:-1])
    return Converged(best, np.abs(best / coarser - 1.0))


def romberg(values: list[np.ndarray]) -> np.ndarray:
    """Limit of values on meshes that double, errors in even powers of h."""
    column, power = list(values), 1
    while len(column) > 1:
        power *= 4
        column = [fine + (fine - coarse) / (power - 1) for coarse, fine in pairwise(column)]
    return column[0]

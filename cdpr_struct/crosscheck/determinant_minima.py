"""The thesis's way to find natural frequencies: minima of a determinant on a frequency grid (section 3.4.3).

Offered as the method under test: it sees a cluster or a double frequency as one minimum, and its depth depends on
the grid.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics, damped
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    platform_dynamic_stiffness,
    platform_mass_matrix,
    platform_static_stiffness,
)
from cdpr_struct.statics.guides import free_block


@dataclass(frozen=True, slots=True, eq=False)
class DeterminantScan:
    """log10 |det(omega^2 E - M^-1 K)| over a grid.

    hertz        : (f,) grid
    log_dynamic  : (f,) with the cables' DSM, damped (fig 3.8b)
    log_static   : (f,) with K_static (fig 3.8c)
    minima_hertz : (n,) local minima of log_dynamic
    """

    hertz: np.ndarray
    log_dynamic: np.ndarray
    log_static: np.ndarray
    minima_hertz: np.ndarray

    @property
    def step_hertz(self) -> float:
        """Grid step [Hz]."""
        return float(self.hertz[1] - self.hertz[0])


def scan_determinant(
    point: OperatingPoint, first: float, last: float, step: float, assembly: Assembly = "consistent"
) -> DeterminantScan:
    """Scan from `first` to `last` [Hz] in steps of `step` [Hz], with the damping of the robot's cables."""
    cables = cable_dynamics(point, "dsm")
    hertz = np.arange(first, last + 0.5 * step, step)
    omega = 2.0 * np.pi * hertz
    mass = free_block(platform_mass_matrix(point.entered, point.rotation), point.arrays)
    dynamic = platform_dynamic_stiffness(
        point, cables, damped(cables, point.entered.damping_ratio, omega[:, None]), assembly
    )
    log_dynamic = _log_determinant(omega, mass, free_block(dynamic, point.arrays))
    log_static = _log_determinant(omega, mass, free_block(platform_static_stiffness(point, assembly), point.arrays))
    inner = log_dynamic[1:-1]
    lower = (inner < log_dynamic[:-2]) & (inner <= log_dynamic[2:])
    return DeterminantScan(hertz, log_dynamic, log_static, hertz[1:-1][lower])


def _log_determinant(omega: np.ndarray, mass: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    squared = (omega**2)[:, None, None]
    _, log = np.linalg.slogdet(squared * np.eye(len(mass)) - np.linalg.solve(mass, stiffness))
    return log / np.log(10.0)


def match_minima(minima: np.ndarray, natural: np.ndarray, tolerance: float) -> np.ndarray:
    """The minimum that stands for each natural frequency, nan where none does.

    Each minimum serves one natural frequency, the nearest pairs first, and only within `tolerance` [Hz].
    """
    matched = np.full(len(natural), np.nan)
    if len(minima) == 0:
        return matched
    distance = np.abs(natural[:, None] - minima[None, :])
    free = np.ones(len(minima), dtype=bool)
    for flat in np.argsort(distance, axis=None, kind="stable"):
        i, j = divmod(int(flat), len(minima))
        if distance[i, j] > tolerance:
            break
        if free[j] and np.isnan(matched[i]):
            matched[i], free[j] = minima[j], False
    return matched

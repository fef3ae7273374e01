"""The single cable of the benchmarks, and the curve from which every finite-element code may start."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

GRAVITY = 9.81


@dataclass(frozen=True, eq=False)
class HeldCable:
    """A uniform elastic cable between two held points; what hangs where is each code's own business.

    start, end        : (3,) [m], z up
    unstrained_length : L [m]
    axial_stiffness   : EA [N]
    linear_density    : mu [kg/m], per unstrained length
    """

    start: np.ndarray
    end: np.ndarray
    unstrained_length: float
    axial_stiffness: float
    linear_density: float

    def parabola(self, elements: int) -> tuple[np.ndarray, np.ndarray]:
        """Nodes (n + 1, 3) [m] of the parabola that fits chord and length, and their slopes by unstrained length.

        Every code starts from it: near enough for a few Newton steps, and no code's own solution.
        """
        offset = self.end - self.start
        chord = float(np.linalg.norm(offset))
        across = self.linear_density * GRAVITY * float(np.hypot(*offset[:2])) / chord

        def excess(tension: float) -> float:
            stretched = self.unstrained_length * (1.0 + tension / self.axial_stiffness)
            return stretched - chord * (1.0 + (across * chord / tension) ** 2 / 24.0)

        tension = float(brentq(excess, 1e-3, self.axial_stiffness))
        share = np.linspace(0.0, 1.0, elements + 1)[:, None]
        down = np.array([0.0, 0.0, self.linear_density * GRAVITY * chord**2 / (2.0 * tension)])
        nodes = self.start + share * offset - share * (1.0 - share) * down
        return nodes, (offset - (1.0 - 2.0 * share) * down) / self.unstrained_length


def single_cable() -> HeldCable:
    """An inclined cable of 11 m under about 200 N: 4 mm of Table 2.1, lambda^2 near 1.4."""
    return HeldCable(np.zeros(3), np.array([10.0, 0.0, 4.5]), 10.958, 251327.4123, 0.067)

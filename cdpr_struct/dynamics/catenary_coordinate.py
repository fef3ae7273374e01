"""A coordinate along a hanging cable in which its tension is a smooth function, however sharply it bends.

With V the vertical and T the whole tension, dV = w ds. The hyperbolic angle delta counted from the frame end,

    V = V_B cosh(delta) + T_B sinh(delta),   T = T_B cosh(delta) + V_B sinh(delta),   ds = T d(delta) / w,

runs from 0 to the platform end's Delta; xi maps it to -1..1. A taut cable has Delta near 0 and xi linear in s.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.cable_state import CableStates

_LINEAR = 1e-4  # below this Delta the map is linear in s: T is smooth there anyway


@dataclass(frozen=True, slots=True, eq=False)
class CatenaryCoordinate:
    """xi of m cables; tension and vertical tension at the frame end (m,) [N], w [N/m], length [m], Delta [-]."""

    frame_tension: np.ndarray
    frame_vertical: np.ndarray
    weight: np.ndarray
    length: np.ndarray
    angle: np.ndarray

    @classmethod
    def of(cls, cables: CableStates) -> "CatenaryCoordinate":
        low = cables.force_z - cables.weight * cables.length
        tension = cables.tension_at_frame
        angle = _angle(cables.force_x, low, cables.force_z)
        return cls(tension, low, cables.weight, cables.length, angle)

    def arc(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unstrained arc length from the frame end s (m, q) [m] and ds/dxi at xi (q,)."""
        half = 0.5 * self.angle[:, None]
        delta = half * (1.0 + xi)
        w = np.where(self._straight, 1.0, self.weight)[:, None]
        tension, vertical = self.frame_tension[:, None], self.frame_vertical[:, None]
        curved = (vertical * 2.0 * np.sinh(0.5 * delta) ** 2 + tension * np.sinh(delta)) / w
        rate = half * (tension * np.cosh(delta) + vertical * np.sinh(delta)) / w
        straight = self._straight[:, None]
        middle = 0.5 * self.length[:, None]
        return np.where(straight, middle * (1.0 + xi), curved), np.where(straight, middle, rate)

    def xi(self, stations: np.ndarray) -> np.ndarray:
        """xi (m, s) of fractions (s,) or (m, s) of the unstrained length."""
        rise = self.weight[:, None] * self.length[:, None] * stations
        vertical = self.frame_vertical[:, None] + rise
        horizontal = np.sqrt(np.maximum(self.frame_tension**2 - self.frame_vertical**2, 0.0))[:, None]
        angle = np.where(self._straight, 1.0, self.angle)[:, None]
        delta = _angle(np.broadcast_to(horizontal, rise.shape), self.frame_vertical[:, None], vertical)
        return np.where(self._straight[:, None], 2.0 * stations - 1.0, np.clip(2.0 * delta / angle - 1.0, -1.0, 1.0))

    @property
    def _straight(self) -> np.ndarray:
        return self.angle < _LINEAR


def _angle(horizontal: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """asinh(high / horizontal) - asinh(low / horizontal) >= 0, without loss of digits, also for horizontal -> 0."""
    first, last = np.hypot(horizontal, low), np.hypot(horizontal, high)
    total = first + last
    gap = horizontal**2 / (first + np.abs(low)) + horizontal**2 / (last + np.abs(high))
    missing = np.where((low < 0.0) & (high > 0.0), gap / total, (total - (high - low)) / total)
    q = (high - low) / total
    return np.log1p(2.0 * q / np.maximum(missing, 1e-300))

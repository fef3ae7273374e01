"""Where does a sagging cable run? Points on it, and how far pieces of it lie from their chords."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated import catenary
from cdpr_struct.statics.cable_state import CableStates


@dataclass(frozen=True, slots=True, eq=False)
class CableCurves:
    """Free cables as curves, a flat batch (k).

    start         : (k, 3) where the free cable begins, world [m]
    heading, up   : (k, 3) unit vectors, world
    force_x, force_z, length, axial_stiffness, weight : (k,) as in `CableStates`
    """

    start: np.ndarray
    heading: np.ndarray
    up: np.ndarray
    force_x: np.ndarray
    force_z: np.ndarray
    length: np.ndarray
    axial_stiffness: np.ndarray
    weight: np.ndarray

    @classmethod
    def of(cls, states: CableStates, platform_anchors: np.ndarray) -> "CableCurves":
        """Of all cables (n, m) with platform anchors (n, m, 3) in the world [m], the cables of a pose together."""
        vectors = (platform_anchors - states.offset, states.heading, np.broadcast_to(states.up, states.offset.shape))
        names = ("force_x", "force_z", "length", "axial_stiffness", "weight")
        numbers = (np.broadcast_to(getattr(states, name), states.length.shape).reshape(-1) for name in names)
        return cls(*(v.reshape(-1, 3) for v in vectors), *numbers)

    def take(self, index: np.ndarray) -> "CableCurves":
        """Items of the batch."""
        return CableCurves(*(getattr(self, name)[index] for name in self.__slots__))

    def points(self, share: np.ndarray) -> np.ndarray:
        """(k, 3) [m] at `share` (k,) of the unstrained length from the frame end, eqs. (2.9)-(2.10)."""
        pull = self.force_x, self.force_z, self.length, self.axial_stiffness, self.weight
        along, rise = catenary.profile(share * self.length, *pull)
        return self.start + along[:, None] * self.heading + rise[:, None] * self.up

    def bulge(self, low: np.ndarray, high: np.ndarray, chord: np.ndarray) -> np.ndarray:
        """(k,) [m] that the pieces from share `low` to `high` (k,) lie from their chords (k,) at most.

        A curve of length l over a chord c stays within the ellipse of half axis sqrt(l^2 - c^2) / 2. The tension is
        convex along the cable, so that its mean of both ends gives no length below the stretched one.
        """
        ends = (np.hypot(self.force_x, self.force_z - self.weight * self.length * (1.0 - s)) for s in (low, high))
        stretched = (high - low) * self.length * (1.0 + 0.5 * sum(ends) / self.axial_stiffness)
        rounding = 1e-13 * chord
        return np.asarray(0.5 * np.sqrt(np.maximum((stretched - chord + rounding) * (stretched + chord), 0.0)))

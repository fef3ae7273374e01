"""Hanging cables of very many poses, and how stiff they are along and across their chords.

A hanging cable moves along and across its chord's tension at mid-cable (a, n) and out of the plane (y). With tension T
and F its parts along a and n, the stiffness density of (D u')' + mu omega^2 u = 0 in these axes is

    D = G + E F F^T  in the plane,  G  across it,   G = T / (1 + T / EA),   E = (EA - G) / T^2.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.dynamics.frame_springs import PLANES, FrameSprings, Groups
from cdpr_struct.statics.cable_state import CableStates

_PIECE = 256


@dataclass(frozen=True, slots=True, eq=False)
class HangingCables:
    """Cables of a batch of poses, all (m, n).

    along, middle  : horizontal and mid-cable vertical pull [N]
    length, weight, stiff, density : L [m], w [N/m], EA [N], mu [kg/m]
    frame          : springs at the frame ends, None where these are fixed points
    """

    along: np.ndarray
    middle: np.ndarray
    length: np.ndarray
    weight: np.ndarray
    stiff: np.ndarray
    density: np.ndarray
    frame: FrameSprings | None = None

    @classmethod
    def of(cls, cables: CableStates, density: np.ndarray) -> "HangingCables":
        """From states (n, m) and linear densities, broadcast against them."""
        shape = cables.length.shape

        def first(value: np.ndarray) -> np.ndarray:
            return np.ascontiguousarray(np.broadcast_to(value, shape).T)

        middle = cables.force_z - 0.5 * cables.weight * cables.length
        pulls = first(cables.force_x), first(middle)
        rest = first(cables.length), first(cables.weight), first(cables.axial_stiffness), first(density)
        return cls(*pulls, *rest)

    def take(self, index: np.ndarray) -> "HangingCables":
        """Some poses."""
        arrays = {name: getattr(self, name)[:, index] for name in self.__slots__ if name != "frame"}
        return replace(self, **arrays, frame=None if self.frame is None else self.frame.take(index))

    def axes(self, heading: np.ndarray) -> np.ndarray:
        """(3, 3, m, n) unit vectors a, n and y in the world, for headings (n, m, 3)."""
        cos, sin = self.direction
        x, y = (np.ascontiguousarray(heading[..., i].T) for i in range(2))
        return np.stack([[cos * x, cos * y, sin], [-sin * x, -sin * y, cos], [-y, x, np.zeros_like(cos)]])

    @property
    def groups(self) -> Groups:
        """Which axes are coupled with each other."""
        return PLANES if self.frame is None else self.frame.groups

    @property
    def tension(self) -> np.ndarray:
        """(m, n) at mid-cable [N]."""
        return np.hypot(self.along, self.middle)

    @property
    def sag_ratio(self) -> np.ndarray:
        """(m, n) w L / T [-]."""
        return self.weight * self.length / self.tension

    @property
    def direction(self) -> tuple[np.ndarray, np.ndarray]:
        """Horizontal and vertical part (m, n) of the unit vector a."""
        return self.along / self.tension, self.middle / self.tension

    @property
    def per_squared(self) -> np.ndarray:
        """(m, n) mu L^2 / 4 [kg m]: from omega^2 to the functions' own scale [N]."""
        return 0.25 * self.density * self.length**2

    def densities(self, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """D_aa, D_an, D_nn and D_yy (q, m, n) [N] at nodes (q,)."""
        ahead, across = self._pull(nodes)
        squared = ahead**2 + across**2
        tension = np.sqrt(squared)
        soft = tension / (1.0 + tension / self.stiff)
        excess = (self.stiff - soft) / squared
        return soft + excess * ahead**2, excess * ahead * across, soft + excess * across**2, soft

    def out_of_plane(self, nodes: np.ndarray) -> np.ndarray:
        """D_yy (q, m, n) [N] at nodes (q,)."""
        tension = np.hypot(*self._pull(nodes))
        return np.asarray(tension / (1.0 + tension / self.stiff))

    def _pull(self, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        cos, sin = self.direction
        change = 0.5 * self.weight * self.length * nodes[:, None, None]
        return self.tension + sin * change, cos * change


def pieces(chosen: np.ndarray) -> list[np.ndarray]:
    """Poses in as many parts as the processor's memory asks for."""
    return np.array_split(chosen, -(-chosen.size // _PIECE)) if chosen.size else []

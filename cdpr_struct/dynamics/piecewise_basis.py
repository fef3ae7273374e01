"""Polynomials and coordinate along cables that bend at point masses: one element between two masses.

Every cable has as many elements, which end at the same xi, so that all share their functions: a cable with fewer masses
is cut where nothing hangs. Within an element tangent and tension are smooth, and the error falls exponentially again.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate
from cdpr_struct.dynamics.polynomial_basis import gauss_rule, polynomial_basis
from cdpr_struct.statics.cable_state import CableStates


@dataclass(frozen=True, slots=True)
class PiecewiseBasis:
    """Functions on -1..1 in `elements` equal parts: each part's bubbles up to `order`, a hat at each inner end, and the
    ramps of frame and moving end over the whole cable."""

    order: int
    elements: int

    @property
    def count(self) -> int:
        """Number of functions."""
        return self.elements * (self.order - 1) + (self.elements - 1) + 2

    def values(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and slopes (count, ...) at xi (...)."""
        if self.elements == 1:
            return polynomial_basis(xi, self.order)
        place = 0.5 * (xi + 1.0) * self.elements
        own = np.clip(place.astype(int), 0, self.elements - 1)
        local, slope = polynomial_basis(2.0 * (place - own) - 1.0, self.order)
        slope = slope * self.elements
        parts: list[list[np.ndarray]] = [[], []]
        for e in range(self.elements):
            inside = own == e
            for part, given in zip(parts, (local, slope), strict=True):
                part.append(np.where(inside, given[:-2], 0.0))
        for e in range(self.elements - 1):
            for part, given in zip(parts, (local, slope), strict=True):
                part.append((np.where(own == e, given[-1], 0.0) + np.where(own == e + 1, given[-2], 0.0))[None])
        half = np.full_like(xi, 0.5)[None]
        ramps = np.concatenate([half - 0.5 * xi, half + 0.5 * xi]), np.concatenate([-half, half])
        return tuple(np.concatenate([*part, ramp]) for part, ramp in zip(parts, ramps, strict=True))  # type: ignore

    def on_gauss_nodes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Nodes and weights (q,), values and slopes (count, q) there."""
        nodes, weights = gauss_rule(2 * self.order + 24)
        starts = 2.0 * np.arange(self.elements) / self.elements - 1.0
        every = (starts[:, None] + (nodes + 1.0) / self.elements).reshape(-1)
        return every, np.tile(weights / self.elements, self.elements), *self.values(every)


@dataclass(frozen=True, slots=True, eq=False)
class PiecewiseCoordinate:
    """xi of m cables in n elements that end at unstrained arcs `ends` (m, n + 1) from the frame [m]."""

    ends: np.ndarray
    parts: tuple[CatenaryCoordinate, ...]

    @classmethod
    def of(cls, cables: CableStates) -> "PiecewiseCoordinate":
        """With an end at every point mass."""
        ends = _element_ends(cables)
        parts = []
        for low, high in zip(ends.T[:-1], ends.T[1:], strict=True):
            vertical = cables.force_z - cables.weight * (cables.length - high) - _carried(cables, high)
            rest = (cables.wrapped_length, cables.force_x, vertical, cables.axial_stiffness, cables.weight)
            piece = CableStates(cables.offset, cables.heading, high - low, *rest, cables.status, cables.let_out)
            parts.append(CatenaryCoordinate.of(piece))
        return cls(ends, tuple(parts))

    @property
    def length(self) -> np.ndarray:
        """(m,) [m]."""
        return self.ends[:, -1]

    def arc(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unstrained arc length from the frame end s (m, q) [m] and ds/dxi at xi (q,) or (m, q)."""
        count = len(self.parts)
        place = 0.5 * (xi + 1.0) * count
        own = np.clip(place.astype(int), 0, count - 1)
        local = 2.0 * (place - own) - 1.0
        shape = np.broadcast_shapes(np.shape(xi), (len(self.ends), 1))
        arc, rate = np.zeros(shape), np.zeros(shape)
        for e, part in enumerate(self.parts):
            inside, found = np.broadcast_to(own == e, shape), part.arc(local)
            arc = np.where(inside, self.ends[:, e, None] + found[0], arc)
            rate = np.where(inside, found[1] * count, rate)
        return arc, rate

    def xi(self, stations: np.ndarray) -> np.ndarray:
        """xi (m, s) of fractions (s,) or (m, s) of the unstrained length."""
        count, arc = len(self.parts), stations * self.length[:, None]
        found = np.full(arc.shape, -1.0)
        for e, part in enumerate(self.parts):
            low, high = self.ends[:, e, None], self.ends[:, e + 1, None]
            local = part.xi(np.clip((arc - low) / (high - low), 0.0, 1.0))
            found = np.where(arc >= low, (2.0 * e + 1.0 + local) / count - 1.0, found)
        return found


def _carried(cables: CableStates, arc: np.ndarray) -> np.ndarray:
    """(m,) weight of the masses between unstrained arcs (m,) and the platform end, those at the arcs included [N]."""
    beyond = cables.length[:, None] - cables.lump_place >= arc[:, None] - 1e-12 * cables.length[:, None]
    return np.asarray((cables.lump_weight * beyond).sum(axis=-1))


def _element_ends(cables: CableStates) -> np.ndarray:
    """(m, n + 1) arcs from the frame [m]: both ends, every mass, and middles of the longest pieces that are left."""
    count = cables.lump_place.shape[-1] + 2
    rows = []
    for length, place, weight in zip(cables.length, cables.lump_place, cables.lump_weight, strict=True):
        ends = sorted({0.0, float(length), *(length - place[weight > 0.0]).tolist()})
        while len(ends) < count:
            longest = int(np.argmax(np.diff(ends)))
            ends.insert(longest + 1, 0.5 * (ends[longest] + ends[longest + 1]))
        rows.append(ends)
    return np.array(rows)

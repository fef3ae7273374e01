"""Poses inserted between neighbours that lie too far apart to see which mode is which."""

from bisect import insort
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.workspace.mode_matching import SURE, matched
from cdpr_struct.workspace.shaped_modes import ShapedModes

_PARTS = ((8, 8), (32, 4))  # up to so many steps at once are divided into so many parts, more of them into two
_FINEST = 1 / 32  # of the distance of two neighbours; what happens within it is not resolved

Compute = Callable[[np.ndarray, int], ShapedModes]


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """From pose a, where a mode has a shape (d,), to its neighbour b; count : modes to be computed between them."""

    a: int
    b: int
    shape: np.ndarray
    count: int


@dataclass(frozen=True, slots=True, eq=False)
class Arrival:
    """How a step ended.

    mac    : the least likeness on the way; below `SURE` it did not reach its end
    number, shape : of the mode at the end
    """

    mac: float
    number: int
    shape: np.ndarray


@dataclass(slots=True)
class InsertedPoses:
    """Inserts poses where they are needed, and keeps them for the way back.

    positions : (n, 3) of the poses between which they lie
    compute   : (positions (k, 3), count) -> modes there
    most      : so many may be inserted
    """

    positions: np.ndarray
    compute: Compute
    most: int
    inserted: int = 0
    _known: dict[tuple[int, int], list[tuple[float, int]]] = field(default_factory=dict)
    _modes: list[ShapedModes] = field(default_factory=list)

    def walked(self, steps: Sequence[Step], ends: Callable[[int], ShapedModes]) -> list[Arrival]:
        """Where steps lead, all of them at once; ends : the modes (one pose) at a neighbour."""
        found: list[Arrival | None] = [None] * len(steps)
        walkers = [_Walker(step.shape) for step in steps]
        while True:
            parts = next((parts for most, parts in _PARTS if found.count(None) <= most), 2)
            asked: list[tuple[Step, float]] = []
            for i, (step, walker) in enumerate(zip(steps, walkers, strict=True)):
                if found[i] is None:
                    gap = self._go(step, walker, ends)
                    room = self.inserted + len(asked) + parts - 1 <= self.most
                    if gap is None or gap[1] - gap[0] <= _FINEST or not room:
                        found[i] = walker.arrival
                    else:
                        asked += [(step, gap[0] + k / parts * (gap[1] - gap[0])) for k in range(1, parts)]
            if not asked:
                return [arrival for arrival in found if arrival is not None]
            self._insert(asked)

    def _go(self, step: Step, walker: "_Walker", ends: Callable[[int], ShapedModes]) -> tuple[float, float] | None:
        """Follow the shape as far as it is sure; the gap that is too wide, None at the end."""
        known = self._known.get((min(step.a, step.b), max(step.a, step.b)), [])
        inner = sorted((t if step.a < step.b else 1.0 - t, i) for t, i in known)
        for t, i in [*inner, (1.0, -1)]:
            if t > walker.at and not walker.to(t, ends(step.b) if i < 0 else self._modes[i]):
                return walker.at, t
        return None

    def _insert(self, asked: list[tuple[Step, float]]) -> None:
        for count in sorted({step.count for step, _ in asked}):
            own = [(step, t) for step, t in asked if step.count == count]
            start = self.positions[[step.a for step, _ in own]]
            share = np.array([t for _, t in own])[:, None]
            modes = self.compute(start + share * (self.positions[[step.b for step, _ in own]] - start), count)
            for k, (step, t) in enumerate(own):
                key = min(step.a, step.b), max(step.a, step.b)
                insort(self._known.setdefault(key, []), (t if step.a < step.b else 1.0 - t, len(self._modes)))
                self._modes.append(modes.take(np.array([k])))
            self.inserted += len(own)


@dataclass(slots=True)
class _Walker:
    """A shape on its way: how far it got, and the least likeness so far."""

    shape: np.ndarray
    at: float = 0.0
    least: float = 1.0
    arrival: Arrival = field(default_factory=lambda: Arrival(0.0, 0, np.zeros(0)))

    def to(self, t: float, modes: ShapedModes) -> bool:
        """Go on to t if the shape is found there for sure."""
        match = matched(self.shape, modes)
        mac = min(self.least, float(match.mac[0]))
        self.arrival = Arrival(mac, int(match.number[0]), match.shape[0])
        if mac < SURE:
            return False
        self.shape, self.at, self.least = match.shape[0], t, mac
        return True

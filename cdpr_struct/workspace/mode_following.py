"""Following one mode by its shape from pose to pose of a grid, from a reference pose on.

The next pose is always the one that is reached most surely from any pose already followed. A step is sure if one mode
there has the shape (likeness `SURE`), or if poses inserted between the two lead there in sure steps. Where no step is
sure the most alike mode is taken, and the pose is marked. Last, all neighbours are compared, on whichever ways they
were reached: where their shapes are not half alike, modes veer, and both are marked. Neighbours of which one is not
marked are at least half alike: no other mode of the one is more like that of the other.
"""

from dataclasses import dataclass, field, replace
from heapq import heappop, heappush

import numpy as np
from scipy.spatial import cKDTree

from cdpr_struct.workspace.inserted_poses import Arrival, InsertedPoses, Step
from cdpr_struct.workspace.mode_matching import SURE, Match, matched, unlike_neighbours
from cdpr_struct.workspace.shaped_modes import ShapedModes

_SEEN = 0.9  # of a shape: if all modes that were computed hold less of it, its mode may be a later one
_DIRECT, _INSERTED, _OVER, _GUESS = range(4)  # ways to reach a pose, the best first
_Offer = tuple[int, float, int, int]  # way, likeness times -1, from where, to where: the least is the surest


@dataclass(frozen=True, slots=True, eq=False)
class FollowedMode:
    """One mode at n poses.

    hertz   : (n,) nan where there is none
    number  : (n,) its place, from 0, among the modes of the pose; -1 where there is none
    mac     : (n,) likeness with the shape at the pose before
    before  : (n,) the pose from which it was followed; -1 at the reference and where there is none
    veering : (n,) bool, the shape at a neighbour is not half alike, or the step to the pose was not sure
    behind  : (n,) bool, on the way from the reference a step was not sure, the one to the pose included
    inserted : poses that were inserted between neighbours
    """

    hertz: np.ndarray
    number: np.ndarray
    mac: np.ndarray
    before: np.ndarray
    veering: np.ndarray
    behind: np.ndarray
    inserted: int


@dataclass(slots=True, eq=False)
class Following:
    """A mode on its way over the grid.

    modes      : at the n poses
    neighbours : (n, 6) numbers of the neighbours, one a direction; -1 where there is none
    between    : inserts poses
    most       : modes that are computed where the mode may not be among the first ones
    """

    modes: ShapedModes
    neighbours: np.ndarray
    between: InsertedPoses
    most: int
    found: FollowedMode = field(init=False)
    _shape: np.ndarray = field(init=False)
    _there: np.ndarray = field(init=False)
    _offers: list[_Offer] = field(default_factory=list)
    _best: dict[int, tuple[_Offer, Arrival]] = field(default_factory=dict)
    _unsure: list[tuple[int, int]] = field(default_factory=list)
    _wider: dict[int, ShapedModes] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = len(self.modes.hertz)
        self._there = np.isfinite(self.modes.hertz[:, 0])
        self._shape = np.zeros((n, self.modes.shapes.shape[2]), dtype=np.float32)
        self.found = FollowedMode(
            np.full(n, np.nan), np.full(n, -1), np.full(n, np.nan), np.full(n, -1),
            np.zeros(n, dtype=bool), np.zeros(n, dtype=bool), 0,
        )  # fmt: skip

    def from_pose(self, start: int, number: int) -> FollowedMode:
        """Follow mode `number` (from 0) of the pose `start` over all poses; start -1: there is none."""
        if start >= 0:
            shape = self.modes.shapes[start, number].astype(np.float32)
            self._enter(-1, start, Arrival(1.0, number, shape / np.linalg.norm(shape)))
        while (step := self._next()) is not None:
            self._enter(*step)
        unlike = unlike_neighbours(self._shape, self.found.number >= 0, self.neighbours)
        return replace(self.found, veering=self.found.veering | unlike, inserted=self.between.inserted)

    def _enter(self, a: int, b: int, arrival: Arrival) -> None:
        """The mode is found at b; offer the ways on from there."""
        found = self.found
        found.number[b], found.before[b] = arrival.number, a
        found.hertz[b] = self._at(b).hertz[0, arrival.number]
        self._shape[b] = arrival.shape
        found.mac[b] = 1.0 if a < 0 else float(self._shape[a] @ self._shape[b]) ** 2
        found.veering[b] = arrival.mac < SURE
        found.behind[b] = a >= 0 and (found.behind[a] or found.veering[b])
        beside = self.neighbours[b]
        on = beside[(beside >= 0) & self._open(beside)]
        if on.size:
            match = matched(self._shape[b], self.modes.take(on))
            for i, c in enumerate(on.tolist()):
                if match.mac[i] >= SURE:
                    self._offer(_DIRECT, b, c, _arrival(match, i))
                else:
                    self._unsure.append((b, c))

    def _offer(self, way: int, a: int, b: int, arrival: Arrival) -> None:
        """A step that may be taken; of those to one pose only the surest is kept."""
        offer = (way, -arrival.mac, a, b)
        if b not in self._best or offer < self._best[b][0]:
            self._best[b] = offer, arrival
            heappush(self._offers, offer)

    def _open(self, poses: np.ndarray) -> np.ndarray:
        """Poses that have modes and are not followed yet."""
        return self._there[poses] & (self.found.number[poses] < 0)

    def _next(self) -> tuple[int, int, Arrival] | None:
        """The surest step to a pose that is not followed yet."""
        while True:
            while self._offers and (self._offers[0][0] == _DIRECT or not self._unsure):
                offer = heappop(self._offers)
                _, _, a, b = offer
                if b in self._best and self._best[b][0] == offer:
                    return a, b, self._best.pop(b)[1]
            if self._unsure:
                self._insert()
            elif not self._offers and not self._leap():
                return None

    def _insert(self) -> None:
        """Try unsure steps with poses between; where that does not help, over the neighbour to the next one."""
        steps = [(a, b) for a, b in self._unsure if self.found.number[b] < 0]
        self._unsure.clear()
        direct = self._widened(steps)
        asked = [Step(a, b, self._shape[a], self._at(b).hertz.shape[1]) for a, b in steps]
        for (a, b), near, arrival in zip(steps, direct, self.between.walked(asked, self._at), strict=True):
            if arrival.mac >= SURE:
                self._offer(_INSERTED, a, b, arrival)
            else:
                self._offer(_GUESS, a, b, near)
                self._over(a, b)

    def _widened(self, steps: list[tuple[int, int]]) -> list[Arrival]:
        """Direct arrivals; where the mode is not among those of the pose, more of them are computed first."""
        direct = [matched(self._shape[a], self._at(b)) for a, b in steps]
        few = sorted({b for (_, b), m in zip(steps, direct, strict=True) if m.seen[0] < _SEEN and b not in self._wider})
        if few:
            wide = self.between.compute(self.between.positions[few], self.most)
            self._wider |= {b: wide.take(np.array([i])) for i, b in enumerate(few)}
            direct = [matched(self._shape[a], self._at(b)) for a, b in steps]
        return [_arrival(match) for match in direct]

    def _over(self, a: int, b: int) -> None:
        """Offer the step over b to the next pose beyond it, if it is sure."""
        c = int(self.neighbours[b, int(np.flatnonzero(self.neighbours[a] == b)[0])])
        if c >= 0 and self._open(np.array([c]))[0]:
            match = matched(self._shape[a], self._at(c))
            if match.mac[0] >= SURE:
                self._offer(_OVER, a, c, _arrival(match))

    def _leap(self) -> bool:
        """Offer the shortest step to a pose that no neighbours lead to; False if none is left."""
        left = np.flatnonzero(self._there & (self.found.number < 0))
        known = np.flatnonzero(self.found.number >= 0)
        if not left.size or not known.size:
            return False
        found = cKDTree(self.between.positions[known]).query(self.between.positions[left])
        apart, near = (np.asarray(part) for part in found)
        nearest = int(apart.argmin())
        a, b = int(known[near[nearest]]), int(left[nearest])
        self._offer(_GUESS, a, b, _arrival(matched(self._shape[a], self._at(b))))
        return True

    def _at(self, pose: int) -> ShapedModes:
        """Modes of one pose, as a batch of one."""
        return self._wider.get(pose) or self.modes.take(np.array([pose]))


def _arrival(match: Match, i: int = 0) -> Arrival:
    return Arrival(float(match.mac[i]), int(match.number[i]), match.shape[i])

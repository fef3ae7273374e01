"""How close do sagging cables come to each other, and to bodies? Enclosed between bounds, at any sag.

Pieces of cables lie within their bulge of their chords. Distances of chords, less and plus the bulges, enclose those of
the pieces; pieces that cannot hold the smallest distance of their pose are dropped, the others halved, until the
bounds are `CLOSE` apart.

Two cables that share an anchor touch there, and a cable touches a body on which it ends. What lies within `zone` [m] of
such an anchor, measured along the cable, is left out.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.body import Body
from cdpr_struct.statics.cable_curves import CableCurves

CLOSE = 1e-5  # [m], between the bounds of a distance
SHARED = 1e-3  # [m]: anchors that are closer count as one
_HALVINGS = 40
_MOST_PIECES = 400_000  # at a time; where there are more, the poses are searched in parts
_SECTIONS = 26  # of the golden section on a chord, after which 4e-6 of it is left
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """Smallest distance at each pose, a flat batch (n).

    distance : (n,) [m], 0 where a cable crosses a body; inf where there is nothing to come close to
    first    : (n,) number of the cable from 0;  second : (n,) of the other cable or of the body from 0
    """

    distance: np.ndarray
    first: np.ndarray
    second: np.ndarray


@dataclass(slots=True, eq=False)
class _Pieces:
    """Pairs of pieces: pose, cable or body (first, second), and shares from `low` to `high` (k, 2) of both."""

    pose: np.ndarray
    first: np.ndarray
    second: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def take(self, index: np.ndarray) -> "_Pieces":
        return _Pieces(*(getattr(self, name)[index] for name in self.__slots__))

    def halved(self, sides: tuple[int, ...]) -> "_Pieces":
        """Both halves of every piece, on one side or on both."""
        parts = [self]
        for side in sides:
            parts = [half for part in parts for half in part._cut(side)]
        return _Pieces(*(np.concatenate([getattr(p, name) for p in parts]) for name in self.__slots__))

    def _cut(self, side: int) -> list["_Pieces"]:
        middle = 0.5 * (self.low[:, side] + self.high[:, side])
        high, low = self.high.copy(), self.low.copy()
        high[:, side], low[:, side] = middle, middle
        rest = self.pose, self.first, self.second
        return [_Pieces(*rest, self.low, high), _Pieces(*rest, low, self.high)]


Enclosed = Callable[[_Pieces], tuple[np.ndarray, np.ndarray]]
"""Distances of the chords of pieces (k,), and how far the pieces lie from them at most (k,) [m]."""


def cable_distance(curves: CableCurves, cables: int, zone: float) -> Nearest:
    """Of every two of the m `cables` of each pose; curves (n m), zone [m] as above."""
    count = len(curves.length) // cables
    one, two = np.triu_indices(cables, 1)
    if not one.size:
        return _nothing(count)
    pose = np.repeat(np.arange(count), len(one))
    pieces = _whole(pose, np.tile(one, count), np.tile(two, count))
    a, b = curves.take(pose * cables + pieces.first), curves.take(pose * cables + pieces.second)
    for end in (0, 1):
        share = np.full(len(pose), float(end))
        shared = np.linalg.norm(a.points(share) - b.points(share), axis=1) < SHARED
        for side, curve in ((0, a), (1, b)):
            _leave_out(pieces, curve, side, end, shared, zone)

    def enclosed(now: _Pieces) -> tuple[np.ndarray, np.ndarray]:
        first, low_a, high_a = _chord(curves.take(now.pose * cables + now.first), now, 0)
        second, low_b, high_b = _chord(curves.take(now.pose * cables + now.second), now, 1)
        return segment_distance(low_a, high_a, low_b, high_b), first + second

    return _searched(pieces, count, (0, 1), enclosed)


def body_distance(
    curves: CableCurves, cables: int, bodies: tuple[Body, ...], pose: tuple[np.ndarray, np.ndarray], zone: float
) -> Nearest:
    """Of every cable to every body; pose: positions (n, 3) [m] and rotations (n, 3, 3) of the platform."""
    count = len(curves.length) // cables
    if not bodies:
        return _nothing(count)
    position, rotation = pose
    number, cable, body = (i.ravel() for i in np.indices((count, cables, len(bodies))))
    pieces = _whole(number, cable, body)
    curve = curves.take(number * cables + cable)

    def away(points: np.ndarray, now: _Pieces) -> np.ndarray:
        found = np.empty(len(points))
        for i, one in enumerate(bodies):
            mine = now.second == i
            place, where = points[mine], now.pose[mine]
            if one.fixed_to == "platform":
                place = np.einsum("kji,kj->ki", rotation[where], place - position[where])
            found[mine] = one.distance(place)
        return found

    for end in (0, 1):
        ends_on = away(curve.points(np.full(len(number), float(end))), pieces) < max(zone, SHARED)
        _leave_out(pieces, curve, 0, end, ends_on, zone)

    def enclosed(now: _Pieces) -> tuple[np.ndarray, np.ndarray]:
        bulge, start, stop = _chord(curves.take(now.pose * cables + now.first), now, 0)
        return _least_along(lambda share: away(start + share[:, None] * (stop - start), now), len(start)), bulge

    return _searched(pieces, count, (0,), enclosed)


def segment_distance(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """(k,) [m] between segments from a to b and from c to d, all (k, 3)."""
    along, across, gap = b - a, d - c, a - c
    aa, bb, ab = (np.einsum("ki,ki->k", *pair) for pair in ((along, along), (across, across), (along, across)))
    ag, bg = np.einsum("ki,ki->k", along, gap), np.einsum("ki,ki->k", across, gap)
    aa, bb = np.maximum(aa, 1e-300), np.maximum(bb, 1e-300)
    bend = aa * bb - ab**2
    s = np.where(bend > 1e-14 * aa * bb, np.clip((ab * bg - bb * ag) / np.maximum(bend, 1e-300), 0.0, 1.0), 0.0)
    t = np.clip((ab * s + bg) / bb, 0.0, 1.0)
    s = np.clip((ab * t - ag) / aa, 0.0, 1.0)
    t = np.clip((ab * s + bg) / bb, 0.0, 1.0)
    found = np.linalg.norm(gap + s[:, None] * along - t[:, None] * across, axis=1)
    for point, other, on, squared in ((a, c, across, bb), (b, c, across, bb), (c, a, along, aa), (d, a, along, aa)):
        share = np.clip(np.einsum("ki,ki->k", point - other, on) / squared, 0.0, 1.0)
        found = np.minimum(found, np.linalg.norm(point - other - share[:, None] * on, axis=1))
    return found


def _whole(pose: np.ndarray, first: np.ndarray, second: np.ndarray) -> _Pieces:
    return _Pieces(pose, first, second, np.zeros((len(pose), 2)), np.ones((len(pose), 2)))


def _leave_out(pieces: _Pieces, curve: CableCurves, side: int, end: int, where: np.ndarray, zone: float) -> None:
    """Take the zone at one end of a cable off, where asked for; works in place."""
    share = np.minimum(zone / curve.length, 0.49)
    if end == 0:
        pieces.low[:, side] = np.where(where, share, 0.0)
    else:
        pieces.high[:, side] = np.where(where, 1.0 - share, 1.0)


def _chord(curve: CableCurves, now: _Pieces, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bulge (k,) and both ends (k, 3) of pieces."""
    low, high = now.low[:, side], now.high[:, side]
    start, stop = curve.points(low), curve.points(high)
    return curve.bulge(low, high, np.linalg.norm(stop - start, axis=1)), start, stop


def _least_along(away: Callable[[np.ndarray], np.ndarray], count: int) -> np.ndarray:
    """(k,) least value on [0, 1] of convex functions: distances from convex bodies along chords."""
    low, high = np.zeros(count), np.ones(count)
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = away(left), away(right)
    least = np.minimum(np.minimum(away(low), away(high)), np.minimum(at_left, at_right))
    for _ in range(_SECTIONS):
        nearer = at_left <= at_right
        low, high = np.where(nearer, low, left), np.where(nearer, right, high)
        new = np.where(nearer, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
        value = away(new)
        left, right = np.where(nearer, new, right), np.where(nearer, left, new)
        at_left, at_right = np.where(nearer, value, at_right), np.where(nearer, at_left, value)
        least = np.minimum(least, value)
    return least


def _searched(pieces: _Pieces, count: int, sides: tuple[int, ...], enclosed: Enclosed) -> Nearest:
    """Branch and bound over pieces, all poses (count) together; in parts where pieces become too many."""
    best, pair = np.full(count, np.inf), np.full((2, count), -1)
    open_ = [(pieces, _HALVINGS)]
    while open_:
        open_ += _narrowed(*open_.pop(), best, pair, sides, enclosed)
    return Nearest(np.where(best <= CLOSE, 0.0, best), *pair)


def _narrowed(
    pieces: _Pieces, halvings: int, best: np.ndarray, pair: np.ndarray, sides: tuple[int, ...], enclosed: Enclosed
) -> list[tuple[_Pieces, int]]:
    """Smallest distances so far, in place (count,), (2, count); pieces that are left where they became too many, in two
    parts by their poses, each with the halvings that are left to it.

    Raises
    ------
    ConvergenceError : too many pieces of a single pose, or no halvings left.
    """
    for used in range(halvings):
        distance, bulge = enclosed(pieces)
        upper = distance + bulge
        order = np.argsort(-upper, kind="stable")  # of several assignments to a pose the last, the least, stays
        better = order[upper[order] < best[pieces.pose[order]]]
        best[pieces.pose[better]] = upper[better]
        pair[:, pieces.pose[better]] = pieces.first[better], pieces.second[better]
        going = np.flatnonzero((distance - bulge < best[pieces.pose] - CLOSE) & (best[pieces.pose] > 0.0))
        if not going.size:
            return []
        pieces = pieces.take(going)
        poses = np.unique(pieces.pose)
        if len(going) > _MOST_PIECES and len(poses) > 1:
            later = pieces.pose >= poses[len(poses) // 2]
            return [(pieces.take(np.flatnonzero(part)), halvings - used) for part in (later, ~later)]
        if len(going) > _MOST_PIECES:
            break
        pieces = pieces.halved(sides)
    left = float(bulge[going].max())
    hint = "Cables that lie along each other or along a body have no nearest point that can be told."
    raise ConvergenceError("smallest distance of the cables", left, used + 1, hint)


def _nothing(count: int) -> Nearest:
    return Nearest(np.full(count, np.inf), np.full(count, -1), np.full(count, -1))

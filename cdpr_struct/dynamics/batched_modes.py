"""Lowest modes of the robot at very many poses, each with its proof.

The fast path: pencils about frequency shifts near the modes that are wanted. It takes poses at which every cable is
taut and runs from a fixed point to the platform; what does not fit, or is not proved, is the general solver's.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.dynamics.cables_of_poses import HangingCables, pieces
from cdpr_struct.dynamics.condensed_cables import HIGHEST_TERM, condensed
from cdpr_struct.dynamics.condensed_robot import Platform, pencil
from cdpr_struct.dynamics.corrected_ritz import corrected, most_below
from cdpr_struct.dynamics.frame_springs import FrameSprings
from cdpr_struct.dynamics.mode_shapes import condensed_shapes, shape_size
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.string_functions import StringFunctions, string_functions
from cdpr_struct.statics.slack_cables import hangs_slack

PROVED = 1e-7  # relative width, of a frequency, that counts as its proof
REACH = 0.6  # of the eliminated motions' lowest squared frequency: so far a shift may lie
_FIRST_PROVED = 1e-9
_SAGGING = 0.4  # w L / T beyond which cables take the higher order
_ROUGH, _ORDER, _SAGGING_ORDER = 5, 8, 10
_SHIFTS = 8
_MANY = ((2, 10), (3, 12), (6, 16))  # leads and order of the attempts at many modes
_RESOLVED = 6.2  # so much must the order exceed twice the half waves of the lowest string that it resolves
_SPARE = 4
_HARMONICS = 5  # of each string, among which the highest mode is expected
_LOW, _HIGH = 0.45, 0.55  # share of the first and of the last squared frequency in the shift


@dataclass(frozen=True, slots=True, eq=False)
class Enclosed:
    """Squared frequencies (n, ...) [rad^2/s^2] and the lower ends of the intervals that hold them; nan where none."""

    squared: np.ndarray
    low: np.ndarray

    @property
    def width(self) -> np.ndarray:
        """(n, ...) relative, of the frequency."""
        return 0.5 * (self.squared - self.low) / self.squared


def reasons_against(point: OperatingPoint) -> list[str]:
    """What the robot has that the fast path does not know."""
    robot = point.arrays
    known = {
        "masts": robot.has_masts,
        "bending stiffness": bool(robot.bending_stiffness.any()),
        "masses at mid-cable": bool(robot.added_mass.any()),
        "parts that move in the platform": robot.has_moving_parts,
        "winches that hold tensions": robot.has_tension_winches,
        "a guided platform": robot.has_guides,
        "tilted gravity": robot.is_tilted,
        "wind on cables": robot.has_cable_drag,
        "masses on cables": robot.has_lumps,
        "parameters of their own at each pose": bool(robot.batch_shape),
    }
    return [name for name, present in known.items() if present]


def fits(point: OperatingPoint) -> np.ndarray:
    """(n,) bool: poses of a flat batch that the fast path takes; at the others a cable hangs slack."""
    if reasons_against(point):
        return np.zeros(len(point.position), dtype=bool)
    return np.asarray(~hangs_slack(point.cables).any(axis=-1))


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Poses (n) that fit."""

    cables: HangingCables
    platform: Platform

    @classmethod
    def of(cls, point: OperatingPoint) -> "Batch":
        fixed = HangingCables.of(point.cables, point.arrays.linear_density)
        cables = replace(fixed, frame=FrameSprings.of(point, fixed.axes(point.cables.heading)))
        return cls(cables, Platform.of(point, cables))

    def take(self, index: np.ndarray) -> "Batch":
        """Some poses; all of them as they are."""
        if index.size == self.cables.length.shape[1]:
            return self
        return Batch(self.cables.take(index), self.platform.take(index))

    @property
    def order(self) -> int:
        """Degree of the polynomials that serve all these cables."""
        return _ORDER if self.cables.sag_ratio.max(initial=0.0) < _SAGGING else _SAGGING_ORDER

    def functions(self, order: int) -> StringFunctions:
        """Those that these cables move in."""
        return string_functions(order, self.cables.frame is not None)

    @property
    def groups(self) -> list[np.ndarray]:
        """Poses by the order that they ask for: in a batch of one group, none depends on its company."""
        heavy = self.cables.sag_ratio.max(axis=0, initial=0.0) >= _SAGGING
        return [part for part in (np.flatnonzero(~heavy), np.flatnonzero(heavy)) if part.size]

    @property
    def strings(self) -> np.ndarray:
        """(m, n) squared first frequencies of uniform strings with the cables' tensions at mid-cable."""
        return np.asarray((0.5 * np.pi) ** 2 * self.cables.tension / self.cables.per_squared)

    @property
    def lowest_string(self) -> np.ndarray:
        """(n,) the lowest of them."""
        return np.asarray(self.strings.min(axis=0))

    def first(self, shift: np.ndarray, chosen: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray]:
        """The first value of the pencil of some poses, and the lower end of its interval; shift (n,) of all."""
        part, own = self.take(chosen), shift[chosen]
        small = pencil(part.platform, condensed(part.cables, own, self.functions(order), 1), own)
        value = small.squared[:, 0]
        return value, small.enclosed(value)


def first_mode(batch: Batch, near: np.ndarray | None = None) -> Enclosed:
    """Squared first frequency (n,) of stable poses; nan where it is not proved.

    near : (n,) where to begin, nan for not known
    """
    n = batch.cables.length.shape[1]
    squared, low = np.full(n, np.nan), np.full(n, np.nan)
    shift, rough = batch.lowest_string, near is None
    if near is not None:
        shift = np.where(np.isfinite(near), np.where(near > 0.0, near, 0.5 * shift), shift)
    todo = np.arange(n)
    for count in range(_SHIFTS):
        order = _ROUGH if rough and count == 0 else batch.order
        found, below = (
            np.concatenate(parts)
            for parts in zip(*(batch.first(shift, own, order) for own in pieces(todo)), strict=True)
        )
        proved = (found - below <= 2.0 * _FIRST_PROVED * found) & (not rough or count > 0)
        squared[todo[proved]], low[todo[proved]] = found[proved], below[proved]
        shift[todo] = np.where(found > 0.0, found, 0.5 * shift[todo])
        todo = todo[~proved & np.isfinite(found)]
        if not todo.size:
            break
    return Enclosed(squared, low)


def lowest_modes(batch: Batch, count: int) -> Enclosed:
    """Squared frequencies (n, count), ascending, of stable poses; nan where they are not proved."""
    return lowest_shapes(batch, count, 0)[0]


def lowest_shapes(batch: Batch, count: int, harmonics: int) -> tuple[Enclosed, np.ndarray]:
    """The same, and the modes' shapes (n, count, d), see `mode_shapes`.

    One shift a pose serves most; where it does not, more leads, more polynomials and a shift by what is known by then.
    """
    n, lowest = batch.cables.length.shape[1], batch.lowest_string
    found = np.full((n, count), np.nan)
    shapes = np.zeros((n, count, shape_size(len(batch.strings), harmonics)))
    strings = np.sort(np.concatenate([k**2 * batch.strings for k in range(1, _HARMONICS + 1)] * 2), axis=0)
    first, top = lowest.copy(), strings[min(count, len(strings)) - 1].copy()
    for leads, order in _MANY:
        hopeless = (top > (0.5 * (order - _RESOLVED)) ** 2 * lowest) & (leads < _MANY[-1][0])
        enough = 6 + 2 * leads * len(batch.strings) >= count
        todo = np.flatnonzero(~np.isfinite(found).all(axis=1) & ~hopeless & enough)
        for own in pieces(todo):
            shift = np.minimum(_LOW * first[own] + _HIGH * top[own], REACH * (leads + 1) ** 2 * lowest[own])
            size = leads, max(order, batch.order)
            guess, proved, shape = _about(batch.take(own), shift, count, size, harmonics)
            new = proved & ~np.isfinite(found[own])
            found[own], shapes[own] = np.where(new, guess, found[own]), np.where(new[..., None], shape, shapes[own])
            first[own], top[own] = guess[:, 0], guess[:, -1]
    return Enclosed(found, found * (1.0 - 2.0 * PROVED)), shapes


def _about(
    batch: Batch, shift: np.ndarray, count: int, size: tuple[int, int], harmonics: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The first `count` squared frequencies (n, count) from one shift, which are proved (n, count), and shapes."""
    leads, order = size
    functions = batch.functions(order)
    own = condensed(batch.cables, shift, functions, leads, HIGHEST_TERM)
    small = pencil(batch.platform, own, shift)
    d, vectors = small.modes
    chosen = slice(0, count + _SPARE)
    squared, motion, turned = corrected(batch.platform, own, small, d[:, chosen], vectors[:, :, chosen])
    kept = vectors[:, 6:, chosen] @ turned[:, :, :count]
    shapes = condensed_shapes(batch.platform, motion[:, :, :count], kept, functions, harmonics)
    squared = squared[:, :count]
    low = squared * (1.0 - 2.0 * PROVED)
    few = [most_below(batch.platform, own, shift, low[:, i]) <= i for i in range(count)]
    half_waves = np.sqrt(np.maximum(squared, 0.0) / batch.lowest_string[:, None])
    return squared, np.stack(few, axis=1) & (2.0 * half_waves <= order - _RESOLVED), shapes

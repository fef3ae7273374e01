"""Lowest modes of the robot at very many poses, each with its proof.

The fast path: pencils about frequency shifts near the modes that are wanted. It takes poses at which every cable is taut
and runs from a fixed point to the platform; what does not fit, or is not proved, is the general solver's.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.condensed_cables import HangingCables, condensed
from cdpr_struct.dynamics.condensed_robot import Pencil, Platform, pencil
from cdpr_struct.dynamics.corrected_ritz import corrected, least_below, most_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.string_functions import string_functions
from cdpr_struct.statics.slack_cables import hangs_slack

PROVED = 1e-7  # relative width, of a frequency, that counts as its proof
_FIRST_PROVED = 1e-9
_SAGGING = 0.4  # w L / T beyond which cables take the higher order
_ROUGH, _ORDER, _SAGGING_ORDER = 5, 8, 10
_SHIFTS = 8
_LEADS = (2, 3)
_REACH = 0.6  # of the eliminated motions' lowest squared frequency: so far a shift may lie
_SPARE = 4
_PLATFORM_LEADS = ((2, 3), (6, 5))  # leads and highest power of the two attempts
_FAR = 4.5  # massless over lowest string's squared frequency: beyond, the first attempt is not worth while
_WINDOW = 8
_NEAR = 0.1  # share of the lowest string in the shift towards the platform's mode
_SEEN = 0.85  # of the eliminated motions' lowest squared frequency: so far modes are taken for known
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
        "pulleys": robot.has_pulleys,
        "masts": robot.has_masts,
        "elasticity in line": bool(robot.series_compliance.any()),
        "bending stiffness": bool(robot.bending_stiffness.any()),
        "masses at mid-cable": bool(robot.added_mass.any()),
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
        cables = HangingCables.of(point.cables, point.arrays.linear_density)
        return cls(cables, Platform.of(point, cables))

    def take(self, index: np.ndarray) -> "Batch":
        return Batch(self.cables.take(index), self.platform.take(index))

    @property
    def order(self) -> int:
        """Degree of the polynomials that serve all these cables."""
        return _ORDER if self.cables.sag_ratio.max(initial=0.0) < _SAGGING else _SAGGING_ORDER

    @property
    def lowest_string(self) -> np.ndarray:
        """(n,) squared first frequency of the lowest of the strings."""
        string = (0.5 * np.pi) ** 2 * self.cables.tension / self.cables.per_squared
        return np.asarray(string.min(axis=0))

    def pencil(self, shift: np.ndarray, order: int) -> Pencil:
        return pencil(self.platform, condensed(self.cables, shift, string_functions(order), 1), shift)


def first_mode(batch: Batch, near: np.ndarray | None = None) -> Enclosed:
    """Squared first frequency (n,) of stable poses; nan where it is not proved.

    near : (n,) where to begin, nan for not known
    """
    n = batch.cables.length.shape[1]
    squared, low = np.full(n, np.nan), np.full(n, np.nan)
    start = batch.lowest_string
    rough = near is None or not np.isfinite(near).all()
    shift = start if rough else np.where(near > 0.0, near, 0.5 * start)
    todo = np.arange(n)
    for count in range(_SHIFTS):
        part = batch if todo.size == n else batch.take(todo)
        own = part.pencil(shift[todo], _ROUGH if rough and count == 0 else batch.order)
        found = own.squared[:, 0]
        below = own.enclosed(found)
        proved = (found - below <= 2.0 * _FIRST_PROVED * found) & (not rough or count > 0)
        squared[todo[proved]], low[todo[proved]] = found[proved], below[proved]
        shift[todo] = np.where(found > 0.0, found, 0.5 * shift[todo])
        todo = todo[~proved & np.isfinite(found)]
        if not todo.size:
            break
    return Enclosed(squared, low)


def lowest_modes(batch: Batch, count: int) -> Enclosed:
    """Squared frequencies (n, count), ascending, of stable poses."""
    first = batch.lowest_string
    strings = np.sort((0.5 * np.pi) ** 2 * batch.cables.tension / batch.cables.per_squared, axis=0)
    top = np.repeat(strings, 2, axis=0)[: max(count - 4, 1)][-1] if count <= 2 * len(strings) else 4.0 * first
    found = _about(batch, _LOW * first + _HIGH * top, count, _LEADS[0])
    for leads in _LEADS[1:]:
        open_ = np.flatnonzero(~np.isfinite(found.squared).all(axis=1))
        if not open_.size:
            break
        again = _about(batch.take(open_), first[open_] * 2.0, count, leads)
        found.squared[open_], found.low[open_] = again.squared, again.low
    return found


def _about(batch: Batch, shift: np.ndarray, count: int, leads: int) -> Enclosed:
    """The first `count` squared frequencies (n, count) from one shift; nan where they are not proved."""
    own = condensed(batch.cables, shift, string_functions(batch.order), leads, 5)
    small = pencil(batch.platform, own, shift)
    d, vectors = small.modes
    chosen = slice(0, count + _SPARE)
    squared, _ = corrected(batch.platform, own, small, d[:, chosen], vectors[:, :, chosen])
    squared = squared[:, :count]
    low = squared * (1.0 - 2.0 * PROVED)
    proved = np.stack(
        [most_below(batch.platform, own, shift, low[:, i]) <= i for i in range(count)], axis=1
    )
    return Enclosed(np.where(proved, squared, np.nan), np.where(proved, low, np.nan))


@dataclass(frozen=True, slots=True, eq=False)
class PlatformMode:
    """Squared frequency (n,) of the mode most like a motion of the platform, nan where it is not proved; and about the
    squared first frequency (n,), nan where even that is not known."""

    squared: np.ndarray
    first: np.ndarray


def platform_mode(batch: Batch, massless: np.ndarray, momentum: np.ndarray, among: int) -> PlatformMode:
    """The mode, `among` so many first ones, whose platform motion is most like a wanted one.

    massless : (n,) squared frequency near which it is to be expected
    momentum : (n, 6) platform mass times that motion, of unit modal mass
    """
    n = len(massless)
    found, first = np.full(n, np.nan), np.full(n, np.nan)
    far = massless > _FAR * batch.lowest_string
    for leads, terms in _PLATFORM_LEADS:
        todo = np.flatnonzero(~np.isfinite(found) & ~(far & (leads == _PLATFORM_LEADS[0][0])))
        if todo.size:
            part = batch if todo.size == n else batch.take(todo)
            found[todo], first[todo] = _most_alike(part, (massless[todo], momentum[todo]), (leads, terms), among)
    return PlatformMode(found, first)


def _most_alike(
    batch: Batch, wanted: tuple[np.ndarray, np.ndarray], size: tuple[int, int], among: int
) -> tuple[np.ndarray, np.ndarray]:
    massless, momentum = wanted
    leads, terms = size
    string = batch.lowest_string
    shift = np.minimum(_NEAR * string + (1.0 - _NEAR) * massless, (_REACH * (leads + 1)) ** 2 * string)
    own = condensed(batch.cables, shift, string_functions(batch.order + 2 * (leads - 2)), leads, terms)
    small = pencil(batch.platform, own, shift)
    d, vectors = small.modes
    chosen, sure = _window(small, (d, vectors), momentum, among)
    values, shapes = np.take_along_axis(d, chosen, axis=1), np.take_along_axis(vectors, chosen[:, None], axis=2)
    squared, motion = corrected(batch.platform, own, small, values, shapes)
    best = (np.einsum("ni,nis->ns", momentum, motion) ** 2).argmax(axis=1)[:, None]
    rank = np.take_along_axis(chosen, best, axis=1)[:, 0]
    found = np.take_along_axis(squared, best, axis=1)[:, 0]
    above = least_below(batch.platform, own, shift, found * (1.0 + 2.0 * PROVED)) > rank
    below = most_below(batch.platform, own, shift, found * (1.0 - 2.0 * PROVED)) <= rank
    known = shift < own.lowest
    return np.where(sure & above & below, found, np.nan), np.where(known, shift + d[:, 0], np.nan)


def _window(
    small: Pencil, modes: tuple[np.ndarray, np.ndarray], momentum: np.ndarray, among: int
) -> tuple[np.ndarray, np.ndarray]:
    """Modes (n, s) around the most alike one, and where it is known that no other of the first can be more alike (n,):
    all of these lie within the shift's reach, or what lies beyond has less in common with the motion altogether."""
    d, vectors = modes
    alike = small.shares(vectors, momentum)
    known = (small.shift[:, None] + d < _SEEN * small.lowest[:, None]) & (np.arange(d.shape[1]) < among)
    best = np.where(known, alike, -1.0).argmax(axis=1)
    row = np.arange(len(best))
    rest = np.where(known, 0.0, alike).sum(axis=1)
    size = min(_WINDOW, d.shape[1])
    start = np.clip(best - size // 2, 0, d.shape[1] - size)
    sure = (known.sum(axis=1) >= among) | (alike[row, best] > rest)
    return start[:, None] + np.arange(size), known[row, best] & sure

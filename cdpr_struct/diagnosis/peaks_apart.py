"""Do the robot's peaks lie by a common factor from the modes that a sensor on the platform can see?

Where peaks are far from every mode the likelihood counts them as belonging to none, and no cause gains from them. Here
all modes are moved by one factor, and what that brings is held against what it brings by chance: in lists drawn from
the robot as entered, with its tolerances, missing modes, and peaks of other origin. A mode counts by its share of the
platform's energy; those of the cables alone, which such a sensor hardly shows, stay where they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.detection import (
    SHARE_INVISIBLE,
    SHARE_RISE,
    SPURIOUS_PER_LIST,
    robot_detection,
)
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.hypotheses.significant import SIGNIFICANT
from cdpr_struct.residuals.assembled import Lists
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import Recorded

_FACTORS = np.exp(np.linspace(np.log(1.0 / 3.5), np.log(3.5), 63))  # of all frequencies: the middle one is 1
_SHAPE = 0.08  # of ln f: by how much modes move otherwise than by the common factor
_FAR = 0.15  # of ln f: a smaller factor is for the fit of single modes to find
_BESIDE = 0.1  # peaks of no mode a list at least
_TYPICAL = 12.0  # peaks of a list that has `SPURIOUS_PER_LIST` of no mode
_BELOW, _ABOVE = 0.35, 0.02  # of ln f: how far from the lowest and highest peak or mode a list was searched
_SEED, _DRAWS = 20251125, 400
_EITHER = ("axial_stiffness", "platform_mass", "platform_inertia")
STIFFER = (*_EITHER, "flexible_platform")
"""Causes that raise the frequencies of a platform: a part of it on a mount is no mass above the mount's frequency."""
SOFTER = (*_EITHER, "joint_compliance", "dead_length", "frame_compliance")
"""Causes that lower them."""


@dataclass(frozen=True, slots=True, eq=False)
class ListApart:
    """One list: its case, measured peaks (J,) [Hz], and the modes (M,) [Hz] that move the platform clearly."""

    case: str
    measured: np.ndarray
    predicted: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class PeaksApart:
    """Peaks beside the modes of the robot as entered.

    factor : of all frequencies, with which most peaks are modes;  p : of so good a factor if nothing were wrong
    gain : log likelihood of the peaks with it against without [nat];  names : causes that could do it
    """

    factor: float
    p: float
    gain: float
    names: tuple[str, ...]
    lists: tuple[ListApart, ...]

    @property
    def found(self) -> bool:
        """Whether peaks and model lie apart, and by more than chance."""
        return self.p < SIGNIFICANT and self.gain > 0.0 and abs(np.log(self.factor)) > _FAR and bool(self.names)

    @property
    def stiffness_per_mass(self) -> float:
        """Factor on the stiffness per mass that the factor of the frequencies means."""
        return self.factor**2


def peaks_apart(search: Search) -> PeaksApart | None:
    """Of the data of a search; None without peaks of the robot."""
    lists = _seen(search.data, search.where)
    if not lists:
        return None
    measured = [one.peaks for one in lists]
    gain, factor = _best(lists, measured)
    rng, p = np.random.default_rng(_SEED), 1.0
    if gain > 0.0 and abs(np.log(factor)) > _FAR:
        chance = sum(_best(lists, _drawn(lists, rng))[0] >= gain for _ in range(_DRAWS))
        p = (1.0 + chance) / (1.0 + _DRAWS)
    known = {cause.name for cause in search.causes}
    names = tuple(name for name in (STIFFER if factor > 1.0 else SOFTER) if name in known)
    cases = search.data.campaign.states.names
    shown = [ListApart(cases[one.state], np.exp(np.sort(one.peaks[:, 0])), one.clear) for one in lists]
    return PeaksApart(float(factor), p, float(gain), names, tuple(shown))


@dataclass(frozen=True, slots=True, eq=False)
class _List:
    """Peaks (J, 2), ln f and sd, and modes that can be seen, ln f (M,).

    share, detection (M,) : of the platform's energy, of a peak;  columns (M, t) : change by a sigma of each tolerance
    """

    state: int
    modes: np.ndarray
    share: np.ndarray
    detection: np.ndarray
    columns: np.ndarray
    peaks: np.ndarray

    @property
    def clear(self) -> np.ndarray:
        """Modes [Hz], ascending, that stand out for certain."""
        return np.asarray(np.exp(np.sort(self.modes[self.share > SHARE_RISE])))


def _seen(data: Recorded, where: Layout) -> list[_List]:
    """The lists with any peak and any mode that can be seen, about the robot as entered."""
    local = Local.about(data, Point.entered(data))
    lists = Lists.of(local, where)
    if lists is None or local.vibrating is None or local.vibrating.robot is None:
        return []
    robot, measured, found = local.vibrating.robot, lists.association.peaks, []
    for k, state in enumerate(local.vibrating.measured.states.tolist()):
        own, picked = robot.mask[k], measured.present[k]
        if own.any() and picked.any():
            peaks = np.stack([measured.ln_frequency[k][picked], measured.sd[k][picked]], axis=1)
            modes, share = local.vibrating.log_hertz[k][own], robot.share[k][own]
            found.append(_List(state, modes, share, robot_detection(share), lists.columns[k][own], peaks))
    return found


def _best(lists: Sequence[_List], measured: Sequence[np.ndarray]) -> tuple[float, float]:
    """Log likelihood of the best factor against one [nat], and that factor."""
    shifts = np.log(_FACTORS)
    moved, still = np.zeros(len(shifts)), 0.0
    for one, peaks in zip(lists, measured, strict=True):
        moved += _likelihood(one, peaks, shifts, _SHAPE)
        still += float(_likelihood(one, peaks, np.zeros(1), 0.0)[0])
    i = int(moved.argmax())
    return float(moved[i]) - still, float(_FACTORS[i])


def _likelihood(one: _List, peaks: np.ndarray, shifts: np.ndarray, shape: float) -> np.ndarray:
    """(a,) log likelihood of peaks (J, 2), each mode leaving peaks independently, with modes shifted by (a,)."""
    low, high = _band(one, peaks)
    variance = (one.columns**2).sum(axis=-1) + peaks[:, 1:] ** 2 + shape**2
    modes = one.modes + shifts[:, None] * (one.share > SHARE_INVISIBLE)
    seen = one.detection * (modes < high)
    off = peaks[:, :1] - modes[:, None]
    density = np.exp(-0.5 * off**2 / variance) / np.sqrt(2.0 * np.pi * variance)
    beside = _beside(len(peaks))
    each = np.log(beside / (high - low) + (seen[:, None] * density).sum(axis=-1)).sum(axis=-1)
    return np.asarray(each - seen.sum(axis=-1) - beside)


def _band(one: _List, peaks: np.ndarray) -> tuple[float, float]:
    """ln of the lowest and highest frequency at which a peak would have been picked."""
    return min(peaks[:, 0].min(), one.modes.min()) - _BELOW, peaks[:, 0].max() + _ABOVE


def _beside(peaks: int) -> float:
    """Expected number of peaks of no mode in a list of so many."""
    return max(SPURIOUS_PER_LIST["robot"] * peaks / _TYPICAL, _BESIDE)


def _drawn(lists: Sequence[_List], rng: np.random.Generator) -> list[np.ndarray]:
    """Lists of peaks of the robot as entered, with tolerances, misses and peaks of other origin."""
    z, found = rng.standard_normal(lists[0].columns.shape[1]), []
    for one in lists:
        low, high = _band(one, one.peaks)
        spread = float(np.median(one.peaks[:, 1]))
        kept = rng.random(len(one.modes)) < one.detection
        own = (one.modes + one.columns @ z + spread * rng.standard_normal(len(one.modes)))[kept]
        peaks = np.concatenate([own, rng.uniform(low, high, rng.poisson(_beside(len(one.peaks))))])
        peaks = peaks[peaks < high] if (peaks < high).any() else one.modes[:1]
        found.append(np.stack([peaks, np.full(len(peaks), spread)], axis=1))
    return found

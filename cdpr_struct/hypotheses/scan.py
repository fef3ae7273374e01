"""Large changes of single numbers, by the peaks that they would put right: beginnings that small steps do not show.

Where modes move past each other, peaks that a wrong mode explains hold a fit where it is. So amplitudes are tried,
modes solved and peaks assigned anew at each; what stands out is fitted from there.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.hypotheses.alternatives import Offered
from cdpr_struct.hypotheses.causes.cause import Pattern
from cdpr_struct.hypotheses.hypothesis import PRICE, SCALES, Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.screening import Screen
from cdpr_struct.residuals.assembled import Lists
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.residuals.vibrations import log_likelihoods
from cdpr_struct.robot.robot_arrays import RobotArrays

AMPLITUDES = (1.0, 2.0, 3.5, 5.5)  # of a cause's prior sigma, both ways where it may be negative
_COARSE = 10.0  # nats by which the grid of amplitudes may miss the best one
_STATES = 6  # those with most peaks: enough to see what stands out
_SPREAD = 0.01  # of ln f: what half a step between amplitudes does to a mode
_OF_A_CAUSE = 2  # amplitudes: the grid may put the best one on either side
_SUITS = 1.0  # nats: a part that swings slowly and suits peaks that are explained by less is not looked for
_LEFT = 2.0  # peaks that belong to no mode, expected: with fewer there is nothing to put right
_STEADY = 1.0  # peaks that belong to no mode, expected near one frequency: from there a mode is looked for
_NEAR, _PLACES = 0.03, 2  # of ln f: so near, and at so many frequencies
_FINE, _BEYOND = 0.012, 0.025  # of ln f: steps of a mount's frequency, and how far beyond its bounds they go
_MOUNT, _BLOCK = 2, 32  # numbers of a part that moves along one axis; robots solved at once
_HEAVY = 0.5  # of the platform's mass: more is not tried
_SMALL = (0.5, *AMPLITUDES)  # of one carrier alone
_FEW_STATES = 3  # those with most peaks, for one carrier
_DOUBT = 3.0  # sigmas that static readings may be off what they say of one carrier
_CARRIERS = 3  # of a cause, the best that are fitted


@dataclass(frozen=True, slots=True, eq=False)
class Beginning:
    """A cause at amplitudes z (d,) of its prior, and how much ln of evidence times prior it seems to bring."""

    part: Part
    z: np.ndarray
    gain: float


def beginnings(data: Recorded, menu: Sequence[Offered], about: Judged, most: int) -> list[Beginning]:
    """The best large changes beside a judged hypothesis.

    Where its modes explain the peaks, only of what the peaks alone can show: those of another platform lie near modes
    of this one, too, and what no other reading sees would never be tried.
    """
    lists = _compared(data, about)
    if lists is None:
        return []
    explained, scan = lists.left < _LEFT, _Scan(data, about)
    best: list[Beginning] = []
    for cause in [one for one in menu if not one.cause.tuned and not one.laws and "RF" in one.cause.seen_in]:
        if explained and cause.cause.seen_in != ("RF",):
            continue
        singles = [i for i, p in enumerate(cause.patterns) if p.basis.shape[1] == 1 and not p.label.startswith("cable")]
        found = sorted((b for i in singles for b in scan.of(cause, i)), key=lambda one: -one.gain)
        best += [one for one in found[:_OF_A_CAUSE] if one.gain > -_COARSE]
    return sorted(best, key=lambda one: -one.gain)[:most]


def mounts(data: Recorded, menu: Sequence[Offered], about: Judged) -> list[Beginning]:
    """Parts that move in the platform, beside a judged hypothesis.

    Where its modes explain the peaks, only parts that swing so slowly that their own are not among them, if these suit
    the peaks better: peaks near modes of a platform that carries all of its mass hide them from every linear test.
    """
    lists = _compared(data, about)
    if lists is None:
        return []
    explained = lists.left < _LEFT
    some = [one for one in menu if (one.cause.tried if explained else one.cause.tuned)]
    if not some:
        return []
    scan = _Scan(data, about)
    places, least = ([], _SUITS) if explained else (_steady_places(lists), -np.inf)
    return [one for cause in some for one in scan.tuned(cause, places, least)]


def _compared(data: Recorded, about: Judged) -> Lists | None:
    """Lists of peaks, None where none were measured or modes are those of the static stiffness."""
    return None if data.campaign.model == "static" else about.lists


def carriers(data: Recorded, menu: Sequence[Offered], about: Judged) -> list[Beginning]:
    """The best changes of one cable, mast or axis alone beside a judged hypothesis, as far as static readings allow."""
    if _compared(data, about) is None:
        return []
    scan, best = _Scan(data, about, _FEW_STATES), []
    for cause in menu:
        if cause.cause.tuned or cause.laws or "RF" not in cause.cause.seen_in:
            continue
        alone = [i for i, p in enumerate(cause.patterns) if p.of_one_carrier]
        found = [max(own, key=lambda one: one.gain) for i in alone if (own := scan.within(cause, i))]
        best += sorted(found, key=lambda one: -one.gain)[:_CARRIERS]
    return sorted(best, key=lambda one: -one.gain)


class _Scan:
    """What amplitudes of causes bring beside a judged hypothesis, modes solved for each."""

    def __init__(self, data: Recorded, about: Judged, states: int = _STATES) -> None:
        self.data, self.about, self.states = data, about, states
        self.screen = Screen.of(about.model, about.fit.noise)
        self.arrays, self.readings = about.point.robot(data), about.point.readings(data)
        self.level = self._of_peaks(replace(self.arrays, mass=np.asarray(self.arrays.mass)[None]))[0]

    def of(self, cause: Offered, i: int) -> list[Beginning]:
        """One pattern at all amplitudes."""
        pattern = cause.patterns[i]
        score, gram = self._static(cause, pattern)
        sizes = np.array(AMPLITUDES if pattern.positive[0] else [*AMPLITUDES, *(-a for a in AMPLITUDES)])
        return self._at(cause, i, sizes, score, gram)

    def within(self, cause: Offered, i: int) -> list[Beginning]:
        """One pattern at what static readings say of it, and at amplitudes that these leave open."""
        pattern = cause.patterns[i]
        score, gram = self._static(cause, pattern)
        likeliest, spread = score / (1.0 / AMPLITUDES[-1] ** 2 + gram), (1.0 / AMPLITUDES[-1] ** 2 + gram) ** -0.5
        sizes = np.array([*_SMALL, *(-a for a in _SMALL), likeliest])
        sizes = sizes[np.abs(sizes - likeliest) < _DOUBT * spread]
        sizes = sizes[sizes > 0.0] if pattern.positive[0] else sizes[sizes != 0.0]
        return self._at(cause, i, sizes, score, gram) if len(sizes) else []

    def _static(self, cause: Offered, pattern: Pattern) -> tuple[float, float]:
        """Score and gram of one number without the peaks."""
        said = self.screen.screened([(part @ pattern.basis) * pattern.prior for part in cause.columns])
        return float(said.score[0]), float(said.gram[0, 0])

    def _at(self, cause: Offered, i: int, sizes: np.ndarray, score: float, gram: float) -> list[Beginning]:
        """One pattern at amplitudes (a,)."""
        pattern = cause.patterns[i]
        theta = (sizes[:, None, None] * pattern.prior) @ pattern.basis.T
        robots = (cause.cause.apply(self.arrays, one[None]) for one in theta)  # one by one: modes need room
        gains = np.concatenate([self._of_peaks(robot) for robot in robots]) - self.level
        gains += sizes * score - 0.5 * sizes**2 * gram
        found = []
        for size, gain in zip(sizes, gains, strict=True):
            found.append(_beginning(cause, i, np.array([size]), float(gain)))
        return found

    def tuned(self, cause: Offered, places: Sequence[float], least: float) -> list[Beginning]:
        """The best of a part on a mount whose mode is at one of these frequencies [Hz], and the same in wider patterns.

        least : nats by which they suit the peaks better

        The mount's own frequency is between that and the one it has where the platform is free: lower by the root of
        one less the part's share of the mass.
        """
        found = []
        for i, pattern in enumerate(cause.patterns):
            rows = self._sizes(pattern, places, cause.cause.tried)
            for some in np.array_split(rows, 1 + len(rows) // _BLOCK) if len(rows) else []:
                theta = ((some * pattern.prior) @ pattern.basis.T)[:, None, :]
                gains = self._of_peaks(cause.cause.apply(self.arrays, theta)) - self.level
                pairs = zip(some, gains, strict=True)
                found += [_beginning(cause, i, row, float(gain)) for row, gain in pairs if gain > least]
        best = sorted(found, key=lambda one: -one.gain)[:_OF_A_CAUSE]
        return [*best, *(wide for one in best[:1] for wide in _widened(cause, one))]

    def _sizes(self, pattern: Pattern, places: Sequence[float], tried: Sequence[float]) -> np.ndarray:
        """(n, d) frequencies, and masses along one axis if the pattern has any, to be tried, in prior sigmas."""
        d, total = len(pattern.prior), float(np.max(self.arrays.mass))
        rows = [np.zeros((0, d))]
        for size in AMPLITUDES if d == _MOUNT else [0.0] if d == 1 else []:
            share = (size * pattern.prior[0]) ** 2 / total
            if share < _HEAVY:
                steps = np.exp(np.arange(0.5 * np.log(1.0 - share) - _BEYOND, _BEYOND, _FINE))
                hertz = np.array([*np.outer(places, steps).ravel(), *tried]) / pattern.prior[-1]
                rows.append(np.stack([np.full(len(hertz), size), hertz], axis=1)[:, -d:])
        return np.concatenate(rows)

    def _of_peaks(self, arrays: RobotArrays) -> np.ndarray:
        data, lists = self.data, self.about.lists
        if data.vibrations is None or lists is None:
            return np.zeros(1)
        noise, measured = lists.association.noise, data.vibrations.richest(self.states)
        return log_likelihoods(data.campaign, data.known, measured, arrays, self.readings, _SPREAD**2, noise)


def _beginning(cause: Offered, i: int, sizes: np.ndarray, gain: float) -> Beginning:
    """A pattern at sizes (d,) in prior sigmas of the scale one, at the scale nearest to the first."""
    scale = min(SCALES, key=lambda s: abs(np.log(abs(sizes[0]) / s)))
    part, z = cause.part(i, scale), sizes / scale
    return Beginning(part, z, gain - 0.5 * float(z @ z) + part.log_weight - PRICE)


def _widened(cause: Offered, one: Beginning) -> list[Beginning]:
    """The same in patterns of more numbers, of which others are zero."""
    theta0 = one.part.pattern.basis @ (one.part.term.sigma * one.z)
    found: list[Beginning] = []
    for i, pattern in enumerate(cause.patterns):
        if len(pattern.prior) > len(one.z):
            part = cause.part(i, one.part.scale)
            theta = np.linalg.pinv(pattern.basis) @ theta0
            gain = one.gain + part.log_weight - one.part.log_weight
            found += [Beginning(part, start / part.term.sigma, gain) for start in _starts(pattern, theta)]
    return found


def _starts(pattern: Pattern, theta: np.ndarray) -> list[np.ndarray]:
    """Numbers (d,) from which a wider pattern is fitted: as they are, and with each other value that is tried."""
    found = [theta]
    for k, parameter in enumerate(pattern.parameters):
        if not parameter.in_band:
            found += [np.where(np.arange(len(theta)) == k, value, theta) for value in parameter.tried]
    return found


def _steady_places(lists: Lists) -> list[float]:
    """Frequencies [Hz] near which most peaks belong to no mode, whatever the state."""
    peaks, last = lists.association.peaks, lists.association.assignment
    if last is None:
        return []
    log = peaks.ln_frequency[peaks.present]
    none = np.clip(1.0 - last.matching.pair.sum(axis=-1), 0.0, 1.0)[peaks.present]
    found: list[float] = []
    while len(found) < _PLACES and none.size:
        near = (np.abs(log[:, None] - log) < _NEAR) * none
        k = int(near.sum(axis=1).argmax())
        if near[k].sum() < _STEADY:
            break
        found.append(float(np.exp((near[k] @ log) / near[k].sum())))
        kept = near[k] == 0.0
        log, none = log[kept], none[kept]
    return found

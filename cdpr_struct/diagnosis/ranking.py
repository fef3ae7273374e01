"""Rankings: each cause refitted alone, or on top of causes that are accepted already, best first."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.evidence import Choice, Screened, candidates, choices, screen
from cdpr_struct.diagnosis.mode_pairing import STRAY_NATS
from cdpr_struct.diagnosis.refit import ASTRAY, Fit, Ground, refit, screen_beyond, settled
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.stray_peaks import caught, explains
from cdpr_struct.side_by_side import side_by_side

_NEAR = 12.0  # nats from the best at screening: refitted
_NEAR_SHARE = 0.2  # of the best gain, which screening misjudges by a share where effects are large
_LARGE = 150.0  # chi^2 beyond its mean from which small steps do not tell enough
_LARGE_STEPS = np.array([-2.5, -1.0, 1.0, 2.5])  # prior sigmas
_SETTLED = 4.0  # nats from the best refit: frequencies are paired again in its own world
_SETTLED_SHARE = 0.5  # of the best gain: large effects move frequencies past each other, and gains with them
_HOPELESS = 2.0  # nats at screening below which a further cause is not refitted


_Key = tuple[tuple[str, str, float], ...]


class Search:
    """Rankings of causes on a ground, and what they rest on, each computed once and when it is asked for."""

    def __init__(self, ground: Ground) -> None:
        self.ground = ground
        self._known: dict[tuple[_Key, bool], list[Fit]] = {}
        self._fits: dict[_Key, Fit] = {}
        self._screened: dict[_Key, list[Screened]] = {}
        self._caught: dict[_Key, list[Fit]] = {}
        self._replacing: dict[_Key, list[Fit]] = {}

    def rank(self, accepted: tuple[Choice, ...] = (), beside: Fit | None = None) -> list[Fit]:
        """Refits of accepted causes plus one more, best first; causes far from the best at screening are left out.

        beside : a fit of other causes that explains everything already: no large change needs to be tried then
        """
        key = (_key(accepted), beside is None)
        if key not in self._known:
            before, rows = self.fitted(accepted), self.screened(accepted)
            found = _ranked(self.ground, before, rows, self.caught(accepted) if beside is None else [], beside)
            self._known[key] = found
            self._fits |= {_key(fit.choices): fit for fit in found}
        return self._known[key]

    def fitted(self, accepted: tuple[Choice, ...]) -> Fit | None:
        """Accepted causes alone; None for none."""
        key = _key(accepted)
        if accepted and key not in self._fits:
            self._fits[key] = settled(self.ground, refit(self.ground, accepted))
        return self._fits.get(key)

    def fits(self, several: list[tuple[Choice, ...]]) -> list[Fit | None]:
        """`fitted` of each."""
        found = side_by_side(self.fitted, several, self.ground.known)
        self._fits |= {_key(accepted): fit for accepted, fit in zip(several, found, strict=True) if fit is not None}
        return found

    def screened(self, accepted: tuple[Choice, ...] = ()) -> list[Screened]:
        """Gains of one more cause by linear evidence, best first; those of further ones in the world of the fit.

        Seen from the world as entered, peaks that the fitted causes move past others look like further causes.
        """
        key = _key(accepted)
        if key not in self._screened:
            self._screened[key] = _screened(self.ground, self.fitted(accepted))
        return self._screened[key]

    def caught(self, accepted: tuple[Choice, ...] = ()) -> list[Fit]:
        """Fits of one more cause whose large change explains peaks that no mode explains yet."""
        key = _key(accepted)
        if key not in self._caught:
            self._caught[key] = caught(self.ground, self.fitted(accepted), self.screened(accepted))
        return self._caught[key]

    def replacing(self, fit: Fit, i: int) -> list[Fit]:
        """Fits of other causes in place of the i-th of a fit that clears the data, best first."""
        key = (*_key(fit.choices), *_key(fit.choices[i : i + 1]))
        if key not in self._replacing:
            self._replacing[key] = _replacing(self.ground, fit, i)
        return self._replacing[key]

    def promise(self, accepted: tuple[Choice, ...]) -> float:
        """Log evidence that accepted causes seem to have with one more, which may also explain every stray peak."""
        fit = self.fitted(accepted)
        if fit is None or not np.isfinite(fit.gain):
            return -np.inf
        further = max((row.gain for row in self.screened(accepted)), default=-np.inf)
        return fit.gain + further + STRAY_NATS * fit.ground.strays


def _key(picked: tuple[Choice, ...]) -> _Key:
    return tuple(sorted((c.candidate.name, c.pattern.label, c.scale) for c in picked))


def _ranked(
    ground: Ground, before: Fit | None, rows: list[Screened], large: list[Fit], beside: Fit | None
) -> list[Fit]:
    """Refits of the causes of a fit and one more, or of one alone, and fits of large changes; best first."""
    if before is not None and rows[0].gain < _HOPELESS and not large:
        return []

    def fitted(tried: tuple[Screened, Choice]) -> Fit:
        row, picked = tried
        fit = refit(ground, (picked,)) if before is None else _with_one_more(before, picked)
        return fit.also_by(row.spread)

    tried = [(row, picked) for row in _promising(ground, rows, before is not None) for picked in _worth_trying(row)]
    fits = side_by_side(fitted, tried, ground.known)
    if ground.paired:
        others = large if beside is None else [beside]
        fits = large + _settled(ground, before, sorted(fits, key=lambda fit: -fit.gain), others)
    return _best_of_each(fits)


def _best_of_each(fits: list[Fit]) -> list[Fit]:
    """The best fit of each set of causes, best first."""
    alone: dict[tuple[str, ...], Fit] = {}
    for fit in sorted(fits, key=lambda fit: -fit.gain):
        alone.setdefault(fit.names, fit)
    return list(alone.values())


def _screened(ground: Ground, before: Fit | None) -> list[Screened]:
    """Gains of causes; of further ones with their signatures in the world of the fit."""
    if before is None:
        return screen(ground.candidates, ground.z)
    left, there = [c.cause for c in ground.candidates if c.name not in before.names], before.ground
    return screen_beyond(before, candidates(there.setting, before.world, there.readings, there.null, left))


def _with_one_more(before: Fit, more: Choice) -> Fit:
    return refit(before.ground, (*before.choices, more), np.concatenate([before.theta, np.zeros(len(more.prior))]))


def _promising(ground: Ground, rows: list[Screened], further: bool) -> list[Screened]:
    """Near the best, and the best few: what looks far off at first sight may come near when refitted."""
    near = [row for row in rows if row.gain > rows[0].gain - max(_NEAR, _NEAR_SHARE * rows[0].gain)]
    chosen = {row.candidate.name: row for row in [*rows[: ground.budget], *near[: 2 * ground.budget]]}
    if not further and float(ground.z @ ground.z) > len(ground.z) + _LARGE:
        chosen |= {row.candidate.name: row for row in _by_large_steps(ground, rows)[: ground.budget]}
    return list(chosen.values())


def _settled(ground: Ground, before: Fit | None, fits: list[Fit], others: list[Fit]) -> list[Fit]:
    """The fits, those settled that may be the best: all if the best explains neither the data nor every peak.

    What is far off stays unsettled, without what the frequencies of a first cause gain by being paired more freely.

    before : fit without the last cause, None for a first one;  others : fits that are settled already
    """
    base, lead = (0.0, max(ground.ahead, 0.0)) if before is None else (before.gain, 0.0)
    ahead = max(fit.gain for fit in [*others, fits[0]])
    reach = ahead - max(_SETTLED, _SETTLED_SHARE * (ahead - base))
    near = max(2, sum(fit.gain > reach for fit in fits))

    def again(fit: Fit) -> Fit:
        return settled(ground, fit, reach)

    first, far = side_by_side(again, fits[:near], ground.known), fits[near:]
    best = max([*others, *first], key=lambda fit: fit.gain)
    if best.ground.strays < ASTRAY or any(explains(fit) for fit in first):
        return first + [replace(fit, gain=fit.gain - lead) for fit in far]
    return first + side_by_side(again, far, ground.known)


def _replacing(ground: Ground, fit: Fit, i: int) -> list[Fit]:
    """Fits of other causes in place of the i-th, looked for in the world of the fit: what else does what it does."""
    kept, there = without(fit, i), fit.ground
    left = [c.cause for c in ground.candidates if c.name not in fit.names]
    found = candidates(there.setting, fit.world, there.readings, there.null, left)
    own = np.hstack([columns for j, columns in enumerate(fit.split(fit.signature)) if j != i])

    def fitted(tried: tuple[Screened, Choice]) -> list[Fit]:
        row, picked = tried
        lowest = np.concatenate([c.pattern.lowest for c in (*kept, picked)])
        start = np.maximum(_at_once(np.hstack([own, -picked.signature]), fit.bare), lowest)
        other = refit(there, (*kept, picked), start).also_by(row.spread)
        return [other, *([settled(ground, other)] if other.gain > fit.gain - _NEAR else [])]

    tried = [(row, c) for row in _promising(there, screen(found, fit.bare, own), True) for c in _worth_trying(row)]
    return _best_of_each([one for fits in side_by_side(fitted, tried, ground.known) for one in fits])


def _at_once(signature: np.ndarray, z: np.ndarray) -> np.ndarray:
    """(d,) sizes that explain whitened residuals best, to first order."""
    result: np.ndarray = np.linalg.solve(np.eye(signature.shape[1]) + signature.T @ signature, signature.T @ z)
    return result


def without(fit: Fit, i: int) -> tuple[Choice, ...]:
    """The causes of a fit but for the i-th."""
    return tuple(c for j, c in enumerate(fit.choices) if j != i)


def _by_large_steps(ground: Ground, rows: list[Screened]) -> list[Screened]:
    """Causes by what large steps of all cables alike would bring, which screening by small ones may not see.

    Robot frequencies are left out if that is better: they may be paired wrongly as entered.
    """
    clear = ~np.isin(ground.setting.labels.block, ("RF", "FA"))

    def best(row: Screened) -> float:
        return max(_drops(ground, row, (np.ones_like(clear), clear)), default=-np.inf)

    gains = side_by_side(best, rows, ground.known)
    return [rows[i] for i in np.argsort(-np.array(gains)) if gains[i] > 0.0]


def _drops(ground: Ground, row: Screened, parts: tuple[np.ndarray, ...]) -> Iterator[float]:
    """By how much chi^2 of some parts of the residuals drops, at best, by large steps of a cause."""
    for pattern in row.candidate.patterns:
        if pattern.basis.shape[1] == 1:
            theta = _LARGE_STEPS[:, None] * pattern.prior
            world = row.candidate.cause.apply(ground.world, theta @ pattern.basis.T)
            white = ground.null.white((residuals(ground.setting, world, ground.readings) + ground.offset).T)
            for part in parts:
                drop = (ground.z[part] ** 2).sum() - (white[part] ** 2).sum(axis=0) - _LARGE_STEPS**2
                yield float(np.nan_to_num(drop, nan=-np.inf).max())
        if pattern.label in ("all alike", ""):
            break


def _worth_trying(row: Screened) -> list[Choice]:
    """The pattern that screening prefers, and all cables alike."""
    alike = [c for c in choices(row.candidate) if c.pattern.label == "all alike" and c.scale == row.best.scale]
    return [row.best, *(c for c in alike if row.best.pattern.label != "all alike")]

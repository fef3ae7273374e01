"""One cause, several causes, or nothing: forward selection, every step with all sizes free, and exchange."""

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.evidence import Choice, Screened, candidates, choices, log_bayes_factor, screen
from cdpr_struct.diagnosis.heldout import groups_of, weakest
from cdpr_struct.diagnosis.refit import Fit, Ground, refit, screen_beyond, settled
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.stray_peaks import caught

FURTHER = 6.0  # nats that each further cause must bring
NEAR = 12.0  # nats from the best at screening: refitted
_NEAR_SHARE = 0.2  # of the best gain, which screening misjudges by a share where effects are large
_ADEQUATE = 1e-3
_LARGE = 150.0  # chi^2 beyond its mean from which small steps do not tell enough
_LARGE_STEPS = np.array([-2.5, -1.0, 1.0, 2.5])  # prior sigmas
_SETTLED = 4.0  # nats from the best refit: frequencies are paired again in its own world
_SETTLED_SHARE = 0.5  # of the best gain: large effects move frequencies past each other, and gains with them
_HOPELESS = 2.0  # nats at screening below which a further cause is not refitted
_HOLDS = 1.0  # nats that a further cause keeps whichever group of states is left out
_BETTER = 0.5  # nats that make an exchange worth while
_BEGINNINGS = 2  # causes to begin with, beside the best single one, where two causes seem better
_SEEN, _MISJUDGED = 1.0, 2.0  # nats of a cause worth beginning with; by which linear evidence of two may be off
_NEEDLESS = 1.0  # nats by which a special case of a cause beats it if its other parameters are needless


@dataclass(frozen=True, slots=True, eq=False)
class Selection:
    """What was chosen.

    fit    : the chosen causes, or None for none;  first : all single causes refitted, best first
    rivals : per chosen cause, the fits in which another cause takes its place and says something else, best first
    caught : (causes, r) by how much less probably a robot frequency belongs to no mode with that cause than without
    """

    fit: Fit | None
    first: list[Fit]
    rivals: list[list[Fit]]
    caught: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))


class Search:
    """Rankings of causes on a ground, each computed once; `large` are single large changes where known already."""

    def __init__(self, ground: Ground, large: list[Fit] | None = None) -> None:
        self.ground, self._large = ground, large
        self._known: dict[tuple[tuple[str, str, float], ...], list[Fit]] = {}
        self._fits: dict[tuple[tuple[str, str, float], ...], Fit] = {}

    def rank(self, accepted: tuple[Choice, ...] = ()) -> list[Fit]:
        """Refits of accepted causes plus one more, best first; causes far from the best at screening are left out."""
        key = _key(accepted)
        if key not in self._known:
            self._known[key] = _ranked(self.ground, self.fitted(accepted), None if accepted else self._large)
            self._fits |= {_key(fit.choices): fit for fit in self._known[key]}
        return self._known[key]

    def fitted(self, accepted: tuple[Choice, ...]) -> Fit | None:
        """Accepted causes alone; None for none."""
        key = _key(accepted)
        if accepted and key not in self._fits:
            self._fits[key] = settled(self.ground, refit(self.ground, accepted))
        return self._fits.get(key)


def _key(picked: tuple[Choice, ...]) -> tuple[tuple[str, str, float], ...]:
    return tuple(sorted((c.candidate.name, c.pattern.label, c.scale) for c in picked))


def _ranked(ground: Ground, before: Fit | None, large: list[Fit] | None) -> list[Fit]:
    """Refits of the causes of a fit and one more, or of one alone; best first."""
    rows = _screened(ground, before)
    if large is None:
        large = caught(ground, before, rows)
    if before is not None and rows[0].gain < _HOPELESS and not large:
        return []
    fits = []
    for row in _promising(ground, rows, before is not None):
        for choice in _worth_trying(row):
            fit = refit(ground, (choice,)) if before is None else _with_one_more(before, choice)
            fits.append(replace(fit, gain=fit.gain + row.spread, spread=row.spread))
    if ground.level != ground.null.level:
        fits = large + _settled(ground, sorted(fits, key=lambda fit: -fit.gain))
    alone: dict[tuple[str, ...], Fit] = {}
    for fit in sorted(fits, key=lambda fit: -fit.gain):
        alone.setdefault(fit.names, fit)
    return list(alone.values())


def _screened(ground: Ground, before: Fit | None) -> list[Screened]:
    """Gains of causes; of further ones in the world of the fit.

    Seen from the world as entered, peaks that the fitted causes move past others look like further causes.
    """
    if before is None:
        return screen(ground.candidates, ground.z)
    left, there = [c.cause for c in ground.candidates if c.name not in before.names], before.ground
    return screen_beyond(before, candidates(there.setting, before.world, there.readings, there.null, left))


def _with_one_more(before: Fit, more: Choice) -> Fit:
    return refit(before.ground, (*before.choices, more), np.concatenate([before.theta, np.zeros(len(more.prior))]))


def _promising(ground: Ground, rows: list[Screened], further: bool) -> list[Screened]:
    """Near the best, and the best few: what looks far off at first sight may come near when refitted."""
    near = [row for row in rows if row.gain > rows[0].gain - max(NEAR, _NEAR_SHARE * rows[0].gain)]
    chosen = {row.candidate.name: row for row in [*rows[: ground.budget], *near[: 2 * ground.budget]]}
    if not further and float(ground.z @ ground.z) > len(ground.z) + _LARGE:
        chosen |= {row.candidate.name: row for row in _by_large_steps(ground, rows)[: ground.budget]}
    return list(chosen.values())


def _settled(ground: Ground, fits: list[Fit]) -> list[Fit]:
    """The fits, those settled that may be the best: all if none of the near ones explains the data."""
    margin = max(_SETTLED, _SETTLED_SHARE * fits[0].gain)
    near = max(2, sum(fit.gain > fits[0].gain - margin for fit in fits))
    first = [settled(ground, fit) for fit in fits[:near]]
    if any(explains(fit) for fit in first):
        return first + [replace(fit, gain=fit.gain - ground.ahead) for fit in fits[near:]]
    return first + [settled(ground, fit) for fit in fits[near:]]


def explains(fit: Fit) -> bool:
    """Whether what a fit leaves may be noise."""
    return float(chi2.sf(fit.adequacy(), len(fit.white))) > _ADEQUATE


def _by_large_steps(ground: Ground, rows: list[Screened]) -> list[Screened]:
    """Causes by what large steps of all cables alike would bring, which screening by small ones may not see.

    Robot frequencies are left out if that is better: they may be paired wrongly as entered.
    """
    clear = ~np.isin(ground.setting.labels.block, ("RF", "FA"))
    gains = []
    for row in rows:
        best = -np.inf
        for pattern in row.candidate.patterns:
            if pattern.basis.shape[1] == 1:
                theta = _LARGE_STEPS[:, None] * pattern.prior
                world = row.candidate.cause.apply(ground.world, theta @ pattern.basis.T)
                white = ground.null.white((residuals(ground.setting, world, ground.readings) + ground.offset).T)
                for part in (np.ones_like(clear), clear):
                    drop = (ground.z[part] ** 2).sum() - (white[part] ** 2).sum(axis=0) - _LARGE_STEPS**2
                    best = max(best, float(np.nan_to_num(drop, nan=-np.inf).max()))
            if pattern.label in ("all alike", ""):
                break
        gains.append(best)
    return [rows[i] for i in np.argsort(-np.array(gains)) if gains[i] > 0.0]


def _worth_trying(row: Screened) -> list[Choice]:
    """The pattern that screening prefers, and all cables alike."""
    alike = [c for c in choices(row.candidate) if c.pattern.label == "all alike" and c.scale == row.best.scale]
    return [row.best, *(c for c in alike if row.best.pattern.label != "all alike")]


def select(ground: Ground, further: float, most: int, large: list[Fit] | None = None) -> Selection:
    """The best cause, and more (`most` in all) that each raise the log evidence by `further`, in all parts of data."""
    return selected(Search(ground, large), further, most)


def selected(search: Search, further: float, most: int) -> Selection:
    """As `select`, from a search that may have ranked causes already."""
    ground, first = search.ground, search.rank()
    best = first[0]
    begun = [best.choices, *(_other_beginnings(ground, further) if most > 1 else [])]
    while len(best.choices) < most:
        more = [fit for one in begun for fit in _one_more(search, one) if fit.gain > best.gain + further]
        if not more:
            break
        best = _exchanged(search, max(more, key=lambda fit: fit.gain))
        begun = [best.choices]
    rivals, caught_by = [], []
    for i, name in enumerate(best.names):
        kept = tuple(c for j, c in enumerate(best.choices) if j != i)
        others = _in_its_place(ground, best, i, [fit for fit in search.rank(kept) if fit.names[-1] != name])
        gains = {name: best.gain, **{fit.names[-1]: fit.gain for fit in others}}
        rivals.append([fit for fit in others if _says_more(fit, gains)])
        caught_by.append(_fewer_strays(ground, search.fitted(kept), best))
    return Selection(best, first, rivals, np.array(caught_by))


def _in_its_place(ground: Ground, best: Fit, i: int, rivals: list[Fit]) -> list[Fit]:
    """Rivals of the i-th cause of a fit, best first, the near ones also with the fit's pairing of the frequencies.

    Which mode a peak is may change by a hair's breadth of a world; that is no evidence between causes.
    """
    if ground.level == ground.null.level:
        return rivals
    parts, found = best.parts(), list(rivals)
    kept = tuple(c for j, c in enumerate(best.choices) if j != i)
    sizes = [part for j, part in enumerate(parts) if j != i]
    for j, rival in enumerate(rivals[: ground.budget]):
        picked = rival.choices[-1]
        begun = refit(best.ground, (*kept, picked), np.concatenate([*sizes, np.zeros(len(picked.prior))]))
        begun = replace(begun, gain=begun.gain + rival.spread, spread=rival.spread)
        found[j] = max(rival, begun, key=lambda fit: fit.gain)
    return sorted(found, key=lambda fit: -fit.gain)


def _other_beginnings(ground: Ground, further: float) -> list[tuple[Choice, ...]]:
    """Single causes to begin with because two causes seem better than any one, best first.

    The best single cause may be one that stands in, each cable its own, for two others together.
    """
    single = screen(ground.candidates, ground.z)[0].gain
    found: dict[tuple[str, str], tuple[float, Choice]] = {}
    for candidate in ground.candidates:
        others = [other for other in ground.candidates if other is not candidate]
        for picked in choices(candidate):
            alone = float(log_bayes_factor(picked.signature, ground.z)) + picked.log_weight
            if alone > _SEEN and others:
                both = alone + screen(others, ground.z, picked.signature)[0].gain
                label = (candidate.name, picked.pattern.label)
                found[label] = max(found.get(label, (-np.inf, picked)), (both, picked), key=lambda row: row[0])
    better = sorted((row for row in found.values() if row[0] > single + further - _MISJUDGED), key=lambda row: -row[0])
    return [(picked,) for _, picked in better[:_BEGINNINGS]]


def _one_more(search: Search, accepted: tuple[Choice, ...]) -> list[Fit]:
    """Accepted causes and one more that does not hang on one group of states."""
    before = search.fitted(accepted)
    return [fit for fit in search.rank(accepted) if _holds(search.ground, before, fit)]


def _fewer_strays(ground: Ground, before: Fit | None, fit: Fit) -> np.ndarray:
    """(r,) by how much less probably a robot frequency belongs to no mode in a fit than before it."""
    return (ground if before is None else before.ground).stray - fit.ground.stray


def _says_more(fit: Fit, gains: dict[str, float]) -> bool:
    """Whether the last cause of a fit is not clearly worse than a special case of it, its other parameters zero."""
    special = fit.choices[-1].candidate.cause.becomes
    return all(gains.get(name, -np.inf) < fit.gain + _NEEDLESS for name in special)


def _holds(ground: Ground, before: Fit | None, fit: Fit) -> bool:
    """Whether the last cause of a fit does not hang on one group of states."""
    stray = np.zeros((len(fit.choices), len(fit.ground.stray)))
    stray[-1] = _fewer_strays(ground, before, fit)
    return bool(weakest(fit, groups_of(fit.ground.setting), stray)[-1] > _HOLDS)


def _exchanged(search: Search, fit: Fit) -> Fit:
    """The fit after each cause but the last had its chance to be replaced by a better one."""
    for i in range(len(fit.choices) - 1):
        kept = tuple(c for j, c in enumerate(fit.choices) if j != i)
        other = search.rank(kept)
        if other and other[0].gain > fit.gain + _BETTER:
            fit = other[0]
    return fit

"""One cause, several causes, or nothing: forward selection, every step with all sizes free, and exchange."""

from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.diagnosis.causes.cause import SCALES
from cdpr_struct.diagnosis.evidence import Choice, choice, gains_of, screen
from cdpr_struct.diagnosis.heldout import groups_of, weakest
from cdpr_struct.diagnosis.ranking import Search, without
from cdpr_struct.diagnosis.refit import Fit, Ground, refit
from cdpr_struct.diagnosis.stray_peaks import clears

FURTHER = 6.0  # nats that each further cause must bring
_HOLDS = 1.0  # nats that a further cause keeps whichever group of states is left out
_BETTER = 0.5  # nats that make an exchange worth while
_BEGINNINGS = 2  # causes to begin with, beside the best single one, where two causes seem better
_SEEN, _MISJUDGED = 1.0, 2.0  # nats of a cause worth beginning with; by which linear evidence of two may be off
_BEHIND = 20.0  # nats that causes may seem to stay behind a law outside the library and yet be looked for
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


def select(search: Search, further: float, most: int, outside: float = -np.inf) -> Selection:
    """The best cause, and more (`most` in all) that each raise the log evidence by `further`, in all parts of data.

    outside : log evidence of the best law outside the library; causes that would stay far behind it are not looked for
    """
    best = _grown(search, further, most, outside)
    rivals = _rivals(search, best)
    better = max((fit for row in rivals for fit in row), key=lambda fit: fit.gain, default=best)
    if better.gain > best.gain + _BETTER:  # with the pairing of what was best
        best, rivals = better, _rivals(search, better)
    before = search.fits([without(best, i) for i in range(len(best.names))])
    caught_by = np.array([_fewer_strays(search.ground, fit, best) for fit in before])
    return Selection(best, search.rank(), rivals, caught_by)


def _grown(search: Search, further: float, most: int, outside: float) -> Fit:
    """The best cause, and as many more as each raise the log evidence enough."""
    best = search.rank()[0]
    begun = [best.choices, *(_other_beginnings(search, further) if most > 1 else [])]
    while len(best.choices) < most:
        hopeful = [one for one in begun if search.promise(one) > outside - _BEHIND]
        more: list[Fit] = []
        for one in hopeful:
            more += _one_more(search, one, best.gain + further, next(filter(clears, more), None))
        if not more:
            break
        best = max(more, key=lambda fit: fit.gain)
        best = best if clears(best) else _exchanged(search, best)
        begun = [best.choices]
    return best


def _rivals(search: Search, best: Fit) -> list[list[Fit]]:
    """Per cause of a fit, the fits in which another takes its place and says something else, best first."""
    found = []
    for i, name in enumerate(best.names):
        if len(best.names) > 1 and search.ground.paired and clears(best):
            others = search.replacing(best, i)
        else:
            others = _in_its_place(search, best, i)
        gains = {name: best.gain, **{fit.names[-1]: fit.gain for fit in others}}
        found.append([fit for fit in others if _says_more(fit, gains)])
    return found


def _in_its_place(search: Search, best: Fit, i: int) -> list[Fit]:
    """Rivals of the i-th cause of a fit, best first, the near ones also with the fit's pairing of the frequencies.

    Which mode a peak is may change by a hair's breadth of a world; that is no evidence between causes.
    """
    ground, kept = search.ground, without(best, i)
    rivals = [fit for fit in search.rank(kept) if fit.names[-1] != best.names[i]]
    if not ground.paired:
        return rivals
    found = list(rivals)
    sizes = [part for j, part in enumerate(best.parts()) if j != i]
    for j, rival in enumerate(rivals[: ground.budget]):
        picked = rival.choices[-1]
        begun = refit(best.ground, (*kept, picked), np.concatenate([*sizes, np.zeros(len(picked.prior))]))
        found[j] = max(rival, begun.also_by(rival.spread), key=lambda fit: fit.gain)
    return sorted(found, key=lambda fit: -fit.gain)


def _other_beginnings(search: Search, further: float) -> list[tuple[Choice, ...]]:
    """Single causes to begin with because two causes seem better than any one, best first.

    The best single cause may be one that stands in, each cable its own, for two others together. What seems better by
    linear evidence must seem so in the world of the refitted beginning, too.
    """
    ground, best = search.ground, search.rank()[0].gain
    z, single, found = ground.z, search.screened()[0].gain, []
    for candidate in ground.candidates:
        others = [other for other in ground.candidates if other is not candidate]
        for pattern, logs in zip(candidate.patterns, gains_of(candidate, z), strict=True):
            alone = float(logs.max())
            if alone > _SEEN and others:
                picked = choice(candidate, pattern, SCALES[int(logs.argmax())])
                found.append((alone + screen(others, z, picked.signature)[0].gain, picked))
    better = sorted((row for row in found if row[0] > single + further - _MISJUDGED), key=lambda row: -row[0])
    begun = [(picked,) for _, picked in better[:_BEGINNINGS]]
    return [one for one in begun if search.promise(one) > best + further - _MISJUDGED]


def _one_more(search: Search, accepted: tuple[Choice, ...], least: float, beside: Fit | None) -> list[Fit]:
    """Accepted causes and one more, of more log evidence than `least`, that does not hang on one group of states."""
    before = search.fitted(accepted)
    return [fit for fit in search.rank(accepted, beside) if fit.gain > least and _holds(search.ground, before, fit)]


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
        other = search.rank(without(fit, i))
        if other and other[0].gain > fit.gain + _BETTER:
            fit = other[0]
    return fit

"""After a diagnosis: which further measurement separates the causes that it leaves open?

The measurements of a plan are judged for just these causes, at the sizes that were fitted, with the other chosen causes
of any size. A pair is told apart by as many nats as whichever of the two is true lets expect at least.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.hypotheses.causes.cause import Pattern
from cdpr_struct.hypotheses.detectable import NAMED
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.hypotheses.search import Answer
from cdpr_struct.planning.candidates import at_the_robot, checks
from cdpr_struct.planning.information import Numbers
from cdpr_struct.planning.measurements import SERIES, Measurement
from cdpr_struct.planning.planned_rows import information_of
from cdpr_struct.planning.separations import WIDE, Pair, Separation, Separator, Sized, separations
from cdpr_struct.residuals.assembled import stacked
from cdpr_struct.residuals.linearised import Local

MOST = 5  # causes of one question
_KINDS = {"locked": "loaded_pose", "cable_frequencies": "cable_frequency", "robot_frequencies": "robot_frequency"}


@dataclass(frozen=True, slots=True, eq=False)
class Recommendation:
    """A further measurement.

    kind : of measurement;  what : check, or places, payloads, sensors
    separates : the pair of causes that it tells apart best, of those that better recommendations leave open
    gain_nats : that it adds to the expected log evidence of that pair, whichever is true
    pairs : all pairs that it tells apart, best first, the smaller evidence of the two ways round
    """

    kind: str
    what: Measurement
    separates: Pair
    gain_nats: float
    pairs: tuple[Separation, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Question:
    """Causes left open in one place, each with its pattern and fitted size; others are there anyway.

    sized : by cause, pattern and size (d,) in sigmas of its prior, of `beside` the pattern
    """

    sized: Mapping[str, tuple[Pattern, np.ndarray]]
    beside: Mapping[str, Pattern]

    @property
    def pairs(self) -> list[Pair]:
        """All pairs."""
        return list(combinations(self.sized, 2))


def recommendations(found: Diagnosis, most: int = 3) -> tuple[Recommendation, ...]:
    """Measurements that separate what a diagnosis leaves open, best first; none if nothing is, or nothing does."""
    asked = questions(found)
    if not asked:
        return ()
    numbers, information = _at_hand(found, asked)
    data = found.explained.search.data
    lacking = {kind for kind, name in _KINDS.items() if name not in data.campaign.kinds()} | {"encoders", *SERIES}
    possible = [*checks(data, numbers, lambda name: name in data.campaign.checked)]
    possible += [(what, more) for what, more in at_the_robot(data, numbers) if what.kind in lacking]
    said: list[Recommendation] = []
    for question in asked:
        own = _answer(question, numbers, information, possible, most, data.campaign.loss.nats_of_a_class)
        said += [one for one in own if all(one.what is not other.what for other in said)]
    return tuple(said[:most])


def questions(found: Diagnosis) -> list[Question]:
    """One a class, or one for all likely causes of an error that nothing in the library explains well."""
    answers = [a for a in found.explained.answers if a.names and UNKNOWN not in a.names]
    if found.fitted.status == "adequate" or not answers:
        return []
    if found.fitted.status == UNKNOWN:
        none = next(a.score for a in found.explained.answers if not a.names)
        single = [a for a in answers if len(a.names) == 1]
        near = [a for a in single if a.score > max(single[0].score - NAMED, none)]
        asked = [Question(_sized(near[:MOST], ()), {})]
    else:
        asked = [_of_class(found, i, answers) for i in range(len(found.chosen.hypothesis.names))]
    return [question for question in asked if question.pairs]


def _of_class(found: Diagnosis, i: int, answers: Sequence[Answer]) -> Question:
    """The i-th chosen cause and those that could stand in its place, the other chosen ones being there."""
    parts = [part for part in found.chosen.hypothesis.parts if not part.cause.outside]
    name, others = parts[i].cause.name, tuple(part.cause for j, part in enumerate(parts) if j != i)
    rest = tuple(cause.name for cause in others)
    same = [a for a in answers if len(a.names) == len(parts) and set(rest) < set(a.names)]
    own = next(a for a in same if name in a.names)
    named = next((names for names in found.fitted.classes if name in names), (name,))
    rivals = [a for a in same if a is not own and set(a.names) - set(rest) <= set(named)]
    if len(named) == 1:
        rivals = [a for a in same if a is not own and a.score > own.score - found.explained.search.budget.near][:1]
    beside = {p.cause.name: p.pattern for j, p in enumerate(parts) if j != i and p.law is None and not p.cause.tuned}
    return Question(_sized([own, *rivals][:MOST], rest), beside)


def _sized(answers: Sequence[Answer], beside: Sequence[str]) -> dict[str, tuple[Pattern, np.ndarray]]:
    """The one cause of each answer that is not beside, with its fitted size; laws and added modes have no columns."""
    found = {}
    for answer in answers:
        best = answer.best
        for part, size in zip(best.hypothesis.parts, best.sizes, strict=True):
            if part.cause.name not in beside and part.law is None and not part.cause.tuned:
                found[part.cause.name] = (part.pattern, part.scale * size)
    return found


def _at_hand(found: Diagnosis, asked: Sequence[Question]) -> tuple[Numbers, np.ndarray]:
    """Numbers of the causes in question, and the information of the data about the chosen hypothesis."""
    search, chosen = found.explained.search, found.chosen
    names = {name for question in asked for name in (*question.sized, *question.beside)}
    numbers = Numbers.of(search.data.cables, [c for c in search.causes if c.name in names], search.seen)
    local = Local.about(search.data, chosen.point)
    causes = [stacked(search.where, local.columns(numbers.term(name))) for name in numbers.causes]
    drift = sum(len(t.sigma) for t in chosen.point.terms[1 : len(chosen.point.terms) - len(chosen.hypothesis.parts)])
    own = [stack.X[..., : numbers.tolerances + drift] for stack in chosen.model.stacks]
    columns = [np.concatenate(parts, axis=-1) for parts in zip(own, *causes, strict=True)]
    whole = information_of(chosen.model, chosen.fit.noise, chosen.fit.soft, columns)
    return numbers, _without(whole, slice(numbers.tolerances, numbers.tolerances + drift))


def _without(information: np.ndarray, own: slice) -> np.ndarray:
    """Information on the others, some numbers N(0, 1) that only these data know integrated out."""
    left = np.delete(np.arange(len(information)), own)
    inner, cross = information[own, own], information[own][:, left]
    kept = information[np.ix_(left, left)]
    return np.asarray(kept - cross.T @ np.linalg.solve(np.eye(len(inner)) + inner, cross))


def _answer(
    question: Question, numbers: Numbers, information: np.ndarray,
    possible: Sequence[tuple[Measurement, np.ndarray]], most: int, apart: float,
) -> list[Recommendation]:  # fmt: skip
    """The best measurement, then others for the pairs that it leaves open; of those that add `apart` nats at least."""
    sized = {name: Sized.fitted(numbers, name, *own) for name, own in question.sized.items()}
    others = [WIDE * numbers.pattern(name, pattern) for name, pattern in question.beside.items()]
    ways = [*question.pairs, *((b, a) for a, b in question.pairs)]
    separator = Separator(numbers, information, sized, ways, np.hstack([np.zeros((numbers.count, 0)), *others]))
    before = separator.nats()
    after = np.array([separator.nats(more) for _, more in possible]).reshape((len(possible), len(ways)))
    added = (after - before).reshape((len(possible), 2, -1)).min(axis=1)
    worth = np.where(added >= apart, np.minimum(added, NAMED), 0.0)
    aside = np.array([what.kind == "check" for what, _ in possible])
    said: list[Recommendation] = []
    left = np.ones(len(question.pairs), dtype=bool)
    while len(said) < most and worth[:, left].any():
        total = worth[:, left].sum(axis=1).round(1)
        best = max(range(len(possible)), key=lambda i: (total[i], aside[i], added[i, left].sum()))
        first = int(np.where(left, added[best], -np.inf).argmax())
        both = np.stack([before, after[best]]).reshape((2, 2, -1)).min(axis=1)
        told = [i for i in np.argsort(-added[best], kind="stable") if worth[best, i]]
        pairs = separations([question.pairs[i] for i in told], both[0, told], both[1, told])
        what = possible[best][0]
        said.append(Recommendation(what.kind, what, question.pairs[first], float(added[best, first]), pairs))
        left = left & (worth[best] == 0.0)
    return said

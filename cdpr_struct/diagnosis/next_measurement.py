"""What to measure next: of the causes that a diagnosis leaves open, which measurement tells them apart?

The measurements of `plan` are simulated for just these causes, at the sizes that were fitted, with the other chosen
causes of any size. A pair is told apart by as many nats as whichever of the two is true lets expect at least.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.evidence import Choice
from cdpr_struct.diagnosis.planned_checks import CHECKS
from cdpr_struct.diagnosis.planned_gain import ENOUGH, Judge, NewRows, checked, possible
from cdpr_struct.diagnosis.planned_series import series
from cdpr_struct.diagnosis.planned_states import of_lacking_kinds
from cdpr_struct.diagnosis.refit import Fit, Ground
from cdpr_struct.diagnosis.wording import listed

NEAR = 10.0  # nats from a named cause within which its next rival is worth telling apart
APART = 2.0  # nats below which a measurement does not tell a pair apart
LIKELY = 5.0  # nats from the best candidate of an unknown
MOST = 5  # causes of one question
_MOST_PROPOSED = 3
_MANY = 50.0  # nats beyond which the number says nothing more

Pair = tuple[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Question:
    """Causes left open in one place: pattern and fitted size theta (d,) of each; other causes are there anyway."""

    sized: Mapping[str, tuple[Choice, np.ndarray]]
    beside: tuple[Choice, ...] = ()

    @property
    def pairs(self) -> list[Pair]:
        """All pairs."""
        return list(combinations(self.sized, 2))


@dataclass(frozen=True, slots=True, eq=False)
class Worth:
    """A measurement, whether it is done beside the robot, and by how many nats more it tells each pair apart."""

    text: str
    aside: bool
    nats: Mapping[Pair, float]

    def on(self, pairs: Sequence[Pair]) -> float:
        """Nats over the pairs that it tells apart, each up to `ENOUGH`: that names a cause."""
        return sum(min(self.nats[pair], ENOUGH) for pair in filter(self.tells, pairs))

    def tells(self, pair: Pair) -> bool:
        """Whether it tells a pair apart."""
        return self.nats[pair] >= APART


def next_measurement(found: Diagnosis, classes: Sequence[tuple[str, ...]]) -> str:
    """What to measure next in words, or "" where nothing is left open and the library knows no hint.

    classes : names not told apart, one group an effect; () where no cause in the library explains the data
    """
    open_ones = _questions(found, classes)
    if not open_ones:
        return _hint(found, [n for names in classes[-1:] for n in names])
    measured = _measurements(found.ground, open_ones)
    return "; ".join(dict.fromkeys(_answer(found, question, measured) for question in open_ones))


def _questions(found: Diagnosis, classes: Sequence[tuple[str, ...]]) -> list[Question]:
    fit = found.selection.fit
    if not classes:
        first = found.selection.first
        near = [f for f in first if f.gain > max(first[0].gain - LIKELY, 0.0)]
        return [Question(_sized(near))] if len(near) > 1 else []
    asked = []
    for i, names in enumerate(classes[len(found.corrections) :]):
        assert fit is not None
        rivals = [f for f in found.selection.rivals[i] if f.names[-1] not in fit.names]
        kept = [f for f in rivals if f.names[-1] in names]
        if len(names) == 1:
            kept = [f for f in rivals[:1] if f.gain > fit.gain - NEAR]
        own = {fit.names[i]: (fit.choices[i], fit.parts()[i])}
        beside = tuple(choice for j, choice in enumerate(fit.choices) if j != i)
        asked.append(Question({**own, **_sized(kept)}, beside))
    return [question for question in asked if question.pairs]


def _sized(fits: Sequence[Fit]) -> dict[str, tuple[Choice, np.ndarray]]:
    """The last cause of each fit, the best fit of each."""
    found: dict[str, tuple[Choice, np.ndarray]] = {}
    for fit in fits:
        found.setdefault(fit.names[-1], (fit.choices[-1], fit.parts()[-1]))
    return dict(list(found.items())[:MOST])


def _measurements(ground: Ground, asked: Sequence[Question]) -> list[tuple[str, bool, NewRows]]:
    """Candidates with their rows: checks beside the robot that were not made yet first, then states."""
    named = {name for q in asked for name in (*q.sized, *(c.candidate.name for c in q.beside))}
    ground = replace(ground, candidates=[c for c in ground.candidates if c.name in named])
    campaign = ground.setting.campaign
    rows = [(check.text, True, checked(ground, check)) for check in CHECKS]
    found = [row for row in rows if not any(np.any(row[2].signature.get(name, 0.0)) for name in campaign.checked)]
    acting = [
        proposal
        for proposal in (*of_lacking_kinds(campaign), *series(campaign))
        if not proposal.acts or named & set(proposal.acts)  # else nothing in question acts otherwise there
    ]
    return found + [(proposal.text, False, rows) for proposal, rows in possible(ground, acting)]


def _answer(found: Diagnosis, question: Question, measured: Sequence[tuple[str, bool, NewRows]]) -> str:
    """The best measurement, others for what it leaves open or one instead of it, and what stays open."""
    judge = _Both(found.ground, question)
    worths = [Worth(text, aside, judge.gains(rows)) for text, aside, rows in measured]
    never = [pair for pair in question.pairs if not any(w.tells(pair) for w in worths)]
    pairs = [pair for pair in question.pairs if pair not in never]
    said = _proposed(worths, pairs) if pairs else []
    if never:
        hint = _hint(found, [name for pair in never for name in pair])
        said.append(
            f"no measurement that was simulated tells {_told(never)}"
            + (f" (perhaps {hint.replace('; ', ' or ')})" if hint else "")
        )
    return "; ".join(said)


def _proposed(worths: Sequence[Worth], pairs: Sequence[Pair]) -> list[str]:
    """Measurements for pairs each of which one of them tells apart: the best, then those for what is left."""
    best, *others = sorted(worths, key=lambda w: (-round(w.on(pairs), 1), not w.aside, -w.on(pairs)))
    said, left = [_words(best, pairs)], [pair for pair in pairs if not best.tells(pair)]
    if not left:
        other = max(others, key=lambda w: (w.on(pairs) > 0.0, w.aside != best.aside, w.on(pairs)), default=best)
        if other is not best and other.on(pairs):
            said.append("or " + _words(other, pairs, short=len(pairs) == 1))
    while left and len(said) < _MOST_PROPOSED:
        more = max(worths, key=lambda w: w.on(left))
        said.append("and " + _words(more, left))
        left = [pair for pair in left if not more.tells(pair)]
    return [*said, f"these do not tell {_told(left)}"] if left else said


class _Both:
    """Judge of pairs either of whose causes may be the true one."""

    def __init__(self, ground: Ground, question: Question) -> None:
        self.pairs = question.pairs
        ways = [*self.pairs, *((b, a) for a, b in self.pairs)]
        self.judge = Judge(ground, ways, question.sized, question.beside)

    def gains(self, rows: NewRows) -> dict[Pair, float]:
        """Nats that rows add for each pair, of its two ways round the smaller."""
        more = (self.judge.nats(rows) - self.judge.before).reshape((2, -1)).min(axis=0)
        return dict(zip(self.pairs, more.tolist(), strict=True))


def _words(worth: Worth, pairs: Sequence[Pair], short: bool = False) -> str:
    """A measurement with what it is expected to tell apart."""
    seen = sorted(filter(worth.tells, pairs), key=lambda p: -worth.nats[p])
    if short:
        return f"{worth.text}: {_nats(worth.nats[seen[0]])}"
    told = [f"{_plain(a)} from {_plain(b)} by {_nats(worth.nats[a, b])}" for a, b in seen]
    return f"{worth.text}: expected to separate " + " and ".join(told)


def _told(pairs: Sequence[Pair]) -> str:
    """What is not told apart: of more than two causes all together, or pair by pair."""
    names = list(dict.fromkeys(name for pair in pairs for name in pair))
    if len(names) > 2 and len(pairs) == len(names) * (len(names) - 1) // 2:
        return f"{listed(names)} apart"
    return " nor ".join(f"{_plain(a)} from {_plain(b)}" for a, b in pairs)


def _nats(nats: float) -> str:
    return f"{nats:.0f} nats" if nats < _MANY else f"more than {_MANY:.0f} nats"


def _plain(name: str) -> str:
    return name.replace("_", " ")


def _hint(found: Diagnosis, names: Sequence[str]) -> str:
    """What the library says of the first of some causes that it has a word about."""
    library = {c.name: c.cause.separated_by for c in found.ground.candidates}
    return next((library[name] for name in names if library.get(name)), "")

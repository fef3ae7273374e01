"""From a campaign to what may be wrong with it: data as recorded, and corrected where people handled them wrongly."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.hypotheses.budget import Budget
from cdpr_struct.hypotheses.correction import Correction
from cdpr_struct.hypotheses.handled import promising, readings_felt
from cdpr_struct.hypotheses.handling import corrections, shortcuts
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.hypotheses.search import Answer, Search
from cdpr_struct.inference.posterior import probabilities
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.recorded import recorded


@dataclass(frozen=True, slots=True)
class Belief:
    """A set of causes that may be the truth, none for nothing wrong, and its probability."""

    names: tuple[str, ...]
    probability: float


@dataclass(frozen=True, slots=True, eq=False)
class Explained:
    """A campaign, corrected or as recorded, with its hypotheses; `price` is what the correction costs [nat]."""

    correction: Correction | None
    search: Search
    answers: tuple[Answer, ...]
    price: float

    def beliefs(self) -> list[tuple[tuple[str, ...], float]]:
        """Sets of names with ln of evidence times prior; what holds an unknown law is unknown as a whole."""
        own = () if self.correction is None else (self.correction.cause,)
        return [
            ((UNKNOWN,) if UNKNOWN in answer.names else (*own, *answer.names), answer.score + self.price)
            for answer in self.answers
        ]


def explained(campaign: Campaign, budget: Budget, progress: Callable[[str], None]) -> list[Explained]:
    """The campaign as recorded, and corrected in every way that may explain it as well; best first."""
    progress("fitting causes")
    first = _searched(campaign, None, budget, 0.0)
    progress("trying how the data may have been handled")
    found = [first, *_corrected(campaign, first, budget)]
    return sorted(found, key=lambda one: -(one.answers[0].score + one.price))


def _searched(campaign: Campaign, correction: Correction | None, budget: Budget, price: float) -> Explained:
    search = Search(recorded(campaign), budget)
    return Explained(correction, search, tuple(search.run()), price)


def _corrected(campaign: Campaign, first: Explained, budget: Budget) -> list[Explained]:
    """Corrections whose data come near the best explanation of those recorded, beside causes of that or alone."""
    best = first.answers[0].score
    beside = _beside(first.answers[0].best.hypothesis)
    felt, found = readings_felt(first.search.data), []
    for correction in [*promising(first.search.data, corrections(campaign), felt), *shortcuts(campaign)]:
        data, price = recorded(correction.campaign), correction.log_prior + correction.log_stretch(felt)
        if any(judged(data, first.search.where, one).score + price > best - budget.near for one in beside):
            found.append(_searched(correction.campaign, correction, budget, price))
            best = max(best, found[-1].answers[0].score + found[-1].price)
    return found


def _beside(best: Hypothesis) -> list[Hypothesis]:
    """Nothing wrong, each cause of a hypothesis alone, and all of them: what may be true beside a correction.

    One of two causes may do in vain what the correction does. Laws hold for the data that they were found in.
    """
    causes = tuple(part for part in best.parts if part.law is None and not part.cause.tuned)
    kept = {tuple(part.key for part in parts): parts for parts in [(), *((part,) for part in causes), causes]}
    return [Hypothesis(parts, best.drift if parts else None) for parts in kept.values()]


def believed(found: Sequence[Explained]) -> list[Belief]:
    """Probabilities of all sets of names."""
    logs: dict[tuple[str, ...], list[float]] = {}
    for one in found:
        for names, score in one.beliefs():
            logs.setdefault(tuple(sorted(names)), []).append(score)
    whole = {names: float(logsumexp(scores)) for names, scores in logs.items()}
    probability = probabilities(np.array(list(whole.values())), np.zeros(len(whole)))
    return [Belief(names, float(p)) for names, p in zip(whole, probability, strict=True)]

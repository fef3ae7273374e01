"""The whole diagnosis of a campaign."""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.diagnosis.decision import UNKNOWN, Decision, Loss, decided, fits
from cdpr_struct.diagnosis.detectable_sizes import minimum_detectable
from cdpr_struct.diagnosis.diagnosis import Candidate, Diagnosis
from cdpr_struct.diagnosis.errors_of_kinds import errors_of_kinds, located
from cdpr_struct.diagnosis.explain import Explained, believed, explained
from cdpr_struct.diagnosis.judge import Judged
from cdpr_struct.diagnosis.left_out import left_out
from cdpr_struct.diagnosis.search import BUDGETS, Answer
from cdpr_struct.diagnosis.set_aside import set_aside
from cdpr_struct.diagnosis.whole_sizes import whole_sizes
from cdpr_struct.measurement.campaign import Campaign

KEEPS = 1.0  # nats that a cause must keep without the block of data that it needs most: else it explains that block
HANGS = 0.6  # largest probability that is said of a cause that does not


def diagnosed(
    campaign: Campaign, budget: str = "small", progress: Callable[[str], None] = lambda _: None, loss: Loss = Loss()
) -> Diagnosis:
    """Diagnose a campaign.

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    found = explained(campaign, BUDGETS[budget], progress)
    beliefs = believed(found)
    decision = decided(beliefs, loss)
    story = _story(found, decision)
    null, chosen = _null(story.answers), _chosen(story, decision)
    progress("predicting what was left out")
    data, where = story.search.data, story.search.where
    left = left_out(data, where, chosen) if decision.status in ("named", "class") else None
    confirmed = left is None or bool((left.kept >= KEEPS).all())
    return Diagnosis(
        campaign=campaign,
        decision=decision if confirmed else _unconfirmed(decision),
        beliefs=tuple(sorted(beliefs, key=lambda one: -one.probability)),
        p_value=_p_value(found),
        explained=story,
        correction=story.correction,
        chosen=chosen,
        null=null,
        candidates=tuple(_candidate(story, answer, null) for answer in story.answers if answer.names),
        set_aside=tuple(set_aside(data, where, chosen)),
        errors=tuple(errors_of_kinds(found[0] if found[0].correction is None else _recorded(found))),
        location=located(story, null, chosen) if decision.status != "adequate" else None,
        left_out=left,
        confirmed=confirmed,
        not_testable=story.search.hidden,
        minimum_detectable=minimum_detectable(story.search, null),
    )


def _recorded(found: Sequence[Explained]) -> Explained:
    return next(one for one in found if one.correction is None)


def _story(found: Sequence[Explained], decision: Decision) -> Explained:
    """The data that the decision believes: corrected if it speaks of a correction."""
    said = {name for names in decision.classes for name in names}
    for one in found:
        if (one.correction is None) == (not any(f.correction and f.correction.cause in said for f in found)):
            if one.correction is None or one.correction.cause in said:
                return one
    return found[0]


def _null(answers: Sequence[Answer]) -> Judged:
    return next(answer.best for answer in answers if not answer.names)


def _chosen(story: Explained, decision: Decision) -> Judged:
    """The fit that the decision speaks of: the likeliest of its sets of causes; of `unknown` the likeliest law."""
    if decision.status == "adequate":
        return _null(story.answers)
    if decision.status == UNKNOWN:
        return next((a.best for a in story.answers if UNKNOWN in a.names), _null(story.answers))
    mended = set() if story.correction is None else {story.correction.cause}
    wanted = [names for names in decision.classes if not mended & set(names)]
    for answer in story.answers:
        if len(answer.names) == len(wanted) and fits(tuple(wanted), answer.names):
            return answer.best
    return _null(story.answers)


def _unconfirmed(decision: Decision) -> Decision:
    """A cause that hangs on one block of data is a candidate, no more."""
    return Decision("class", decision.classes, min(decision.probability, HANGS))


def _p_value(found: Sequence[Explained]) -> float:
    """Of nothing being wrong: the likelihood ratio of everything else against it is above 1 / p no more often than p."""
    recorded = _recorded(found)
    null = max(answer.score for answer in recorded.answers if not answer.names)
    others = [score for one in found for names, score in one.beliefs() if names]
    return float(min(1.0, np.exp(null - logsumexp(others)))) if others else 1.0


def _candidate(story: Explained, answer: Answer, null: Judged) -> Candidate:
    sizes = whole_sizes(story.search.data, story.search.seen, answer.best)
    gain = answer.score - _null_score(story)
    return Candidate(answer.names, answer.best, tuple(sizes), gain, _share(answer.best, null))


def _null_score(story: Explained) -> float:
    return next(answer.score for answer in story.answers if not answer.names)


def _share(found: Judged, null: Judged) -> float:
    """Share of the whitened sum of squares beyond noise that a hypothesis takes away, 0 to 1."""
    before, after = null.misfit, found.misfit
    excess = before - null.rows
    return float(np.clip(1.0 - (after - found.rows) / excess, 0.0, 1.0)) if excess > 0.0 else 0.0

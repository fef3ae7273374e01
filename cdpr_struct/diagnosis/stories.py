"""The answers of a search as a diagnosis tells them: candidates with sizes, corrections, what was chosen."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.diagnosis.decision import Decision, fits
from cdpr_struct.diagnosis.diagnosis import Candidate, Drifted, Tried
from cdpr_struct.diagnosis.whole_sizes import whole_sizes
from cdpr_struct.hypotheses.drift import TRACKER, Drift
from cdpr_struct.hypotheses.explain import Explained
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.hypotheses.search import Answer


def as_recorded(found: Sequence[Explained]) -> Explained:
    """The data as they were filed."""
    return next(one for one in found if one.correction is None)


def believed_data(found: Sequence[Explained], decision: Decision) -> Explained:
    """The data that the decision believes: corrected if it speaks of a correction; the likeliest of what is unknown."""
    if decision.status == UNKNOWN:
        return found[0]
    said = {name for names in decision.classes for name in names}
    for one in found:
        if one.correction is not None and one.correction.cause in said:
            return one
    return as_recorded(found)


def null_of(story: Explained) -> Answer:
    """Nothing wrong."""
    return next(answer for answer in story.answers if not answer.names)


def chosen_of(story: Explained, decision: Decision) -> Judged:
    """The fit that the decision speaks of: the likeliest of its sets of causes; of `unknown` the likeliest law."""
    null = null_of(story).best
    if decision.status == "adequate":
        return null
    if decision.status == UNKNOWN:
        return next((a.best for a in story.answers if UNKNOWN in a.names), null)
    mended = set() if story.correction is None else {story.correction.cause}
    wanted = tuple(names for names in decision.classes if not mended & set(names))
    for answer in story.answers:
        if len(answer.names) == len(wanted) and fits(wanted, answer.names):
            return answer.best
    return null


def candidates(story: Explained) -> list[Candidate]:
    """Every set of causes that was fitted, best first."""
    null, rows = null_of(story), []
    for answer in story.answers:
        if answer.names:
            sizes = whole_sizes(story.search.data, story.search.seen, answer.best)
            share = _share(answer.best, null.best)
            ahead = answer.score - max(one.score for one in story.answers if Counter(one.names) < Counter(answer.names))
            rows.append(Candidate(answer.names, answer.best, tuple(sizes), answer.score - null.score, share, ahead))
    return rows


def without_size(found: Sequence[Explained], told: Sequence[Sequence[Candidate]]) -> set[str]:
    """Causes of which no fit, on any data, is likelier than none with sizes that are changes."""
    sized = {name for rows in told for row in rows if row.has_size for name in row.names}
    start = null_of(as_recorded(found)).score
    for one in found:
        if one.correction is not None and one.answers[0].score + one.price > start:
            sized.add(one.correction.cause)
    every = {name for rows in told for row in rows for name in row.names}
    every |= {one.correction.cause for one in found if one.correction is not None}
    return every - sized - {UNKNOWN}


def tried(found: Sequence[Explained], story: Explained) -> list[Tried]:
    """Corrections that were looked into, the believed one first."""
    start, rows = null_of(as_recorded(found)), []
    for one in sorted(found, key=lambda one: one is not story):
        if one.correction is not None:
            null = null_of(one)
            rows.append(Tried(one.correction, null.score + one.price - start.score, _share(null.best, start.best)))
    return rows


def p_value(found: Sequence[Explained]) -> float:
    """Of nothing being wrong: of any law at its smallest detectable size, or by the evidence, which is above 1 / p
    against the null no more often than p."""
    null = max(answer.score for answer in as_recorded(found).answers if not answer.names)
    others = [score for one in found for names, score in one.beliefs() if names]
    bound = float(np.exp(min(null - logsumexp(others), 0.0))) if others else 1.0
    return min(bound, as_recorded(found).search.p_value)


def drift_of(story: Explained, chosen: Judged) -> Drifted | None:
    """Which sensors drift beside what was chosen, and how far; None where none do."""
    drift, zeros = chosen.hypothesis.drift, chosen.drifted(story.search.data)
    if not isinstance(drift, Drift) or zeros is None:
        return None
    spans = np.ptp(zeros, axis=0)
    own, turn = (spans[:3], spans[3:]) if drift.sensor == TRACKER else (spans, np.zeros(1))
    return Drifted(drift.sensor, float(np.sqrt(np.mean(own**2))), float(np.sqrt(np.mean(turn**2))))


def _share(found: Judged, null: Judged) -> float:
    """Share of the whitened sum of squares beyond noise that a hypothesis takes away, 0 to 1."""
    before, after = null.misfit, found.misfit
    excess = before - null.rows
    return float(np.clip(1.0 - (after - found.rows) / excess, 0.0, 1.0)) if excess > 0.0 else 0.0

"""Every cause in every pattern at every scale: what each adds to the evidence of a fitted hypothesis, in closed form.

The noise's sizes and the point of linearisation are kept, so each value is a lower bound of the log evidence, to first
order about the point. It takes microseconds an alternative, and says which are worth fitting.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.cause import Cause, Pattern, Seen
from cdpr_struct.hypotheses.hypothesis import PRICE, SCALES, Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.laws import OUTSIDE, laws, patterns
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.screening import Screen
from cdpr_struct.inference.screening import gains as scaled_gains
from cdpr_struct.residuals.assembled import stacked
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.linearised import Local, Outside, Term
from cdpr_struct.residuals.recorded import Recorded


@dataclass(frozen=True, slots=True, eq=False)
class Offered:
    """A cause with what its basic parameters do at a point, columns (K, n, d0) a shelf and unit, and its patterns.

    laws : of what is no change of the robot, what each pattern does to the rows
    """

    cause: Cause
    patterns: tuple[Pattern, ...]
    columns: list[np.ndarray]
    laws: tuple[Outside, ...] = ()

    def part(self, i: int, scale: float) -> Part:
        """The i-th pattern at a scale."""
        return Part(self.cause, self.patterns[i], scale, self.laws[i] if self.laws else None)


@dataclass(frozen=True, slots=True, eq=False)
class Gains:
    """A cause beside a fitted hypothesis: ln of evidence times prior it adds, by pattern and scale (p, s)."""

    offered: Offered
    logs: np.ndarray

    @property
    def cause(self) -> Cause:
        return self.offered.cause

    @property
    def total(self) -> float:
        """Over all patterns and scales."""
        return float(logsumexp(self.logs))

    def leading(self, count: int) -> list[tuple[Part, float]]:
        """The best alternatives of so many patterns, best first, and by how much all that each stands for exceed it.

        Each stands for the other scales of its pattern, and the first for all other patterns as well. Of a cause whose
        numbers may go along: the best pattern with them and the best without, each for all others that are so.
        """
        if self.cause.along:
            return self._with_and_without()
        order = np.argsort(-self.logs.max(axis=1), kind="stable")
        found = []
        for k, i in enumerate(order[:count]):
            own = [i] if k else [i, *order[count:]]
            part = self.offered.part(int(i), SCALES[int(self.logs[i].argmax())])
            found.append((part, float(logsumexp(self.logs[own]) - self.logs[i].max())))
        return found

    def _with_and_without(self) -> list[tuple[Part, float]]:
        """The best of the patterns with the numbers that may go along, and of those without."""
        along = np.array([pattern.label.endswith(self.cause.along) for pattern in self.offered.patterns])
        found = []
        for group in (np.flatnonzero(~along), np.flatnonzero(along)):
            i = int(group[self.logs[group].max(axis=1).argmax()])
            part = self.offered.part(i, SCALES[int(self.logs[i].argmax())])
            found.append((part, float(logsumexp(self.logs[group]) - self.logs[i].max())))
        return found


def offered(data: Recorded, where: Layout, seen: Seen, causes: Sequence[Cause], about: Judged) -> list[Offered]:
    """What causes do about the point of a fitted hypothesis."""
    local, found = Local.about(data, about.point), []
    for cause in causes:
        sigma = np.array([p.prior for p in cause.basic(seen)])
        own = local.columns(Term(cause.apply, np.eye(len(sigma)), sigma))
        columns = [part / sigma for part in stacked(where, own)]
        found.append(Offered(cause, tuple(cause.patterns(seen)), columns))
    return [*found, *_internal(local, where), *_laws(local, where)]


def _internal(local: Local, where: Layout) -> list[Offered]:
    """Internal force, where commands stand in for encoders."""
    internal = local.data.sent.internal
    if not internal.any():
        return []
    found = tuple(local.acting_on(own) for own in internal_force.columns(internal))
    states = found[1].count // internal.shape[-1]
    columns = stacked(where, local.r.of_outside(Outside.joined(found)))
    return [Offered(internal_force.CAUSE, internal_force.patterns(internal.shape[-1], states), columns, found)]


def _laws(local: Local, where: Layout) -> list[Offered]:
    """Laws outside the library, all as one more cause."""
    found = laws(local)
    if not found:
        return []
    own = tuple(law.columns for law in found)
    return [Offered(OUTSIDE, patterns(found), stacked(where, local.r.of_outside(Outside.joined(own))), own)]


def gains(causes: Sequence[Offered], about: Judged, noise: NoiseState | None = None) -> list[Gains]:
    """What each cause adds to a hypothesis, best first; at other sizes of the noise than its own if given."""
    screen = Screen.of(about.model, about.fit.noise if noise is None else noise, about.fit.soft)
    shelves = zip(*(cause.columns for cause in causes), strict=True)
    said = screen.screened([np.concatenate(parts, axis=-1) for parts in shelves])
    rows, start = [], 0
    for cause in causes:
        own = slice(start, start + cause.columns[0].shape[-1])
        start = own.stop
        rows.append(_gains(cause, said.gram[own, own], said.score[own]))
    return sorted(rows, key=lambda row: -row.total)


def _gains(cause: Offered, gram: np.ndarray, score: np.ndarray) -> Gains:
    """From gram (d0, d0) and score (d0,) of the basic parameters."""
    logs = []
    for pattern in cause.patterns:
        weight = np.log(pattern.weight / len(SCALES)) - PRICE
        own = scaled_gains(*of_pattern(pattern, gram, score), np.array(SCALES), pattern.positive)
        logs.append(own + weight)
    return Gains(cause, np.array(logs))


def of_pattern(pattern: Pattern, gram: np.ndarray, scores: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gram (d, d) and scores (d, ...) of a pattern's parameters, a prior sigma, from (d0, d0), (d0, ...) of all."""
    used = np.flatnonzero(pattern.basis.any(axis=1))
    basis = pattern.basis[used] * pattern.prior
    return basis.T @ gram[np.ix_(used, used)] @ basis, basis.T @ scores[used]

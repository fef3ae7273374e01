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
from cdpr_struct.residuals.linearised import Local, Term
from cdpr_struct.residuals.recorded import Recorded


@dataclass(frozen=True, slots=True, eq=False)
class Offered:
    """A cause with what its basic parameters do at a point, columns (K, n, d0) a shelf and unit, and its patterns.

    laws : of laws outside the model, what each pattern does to the rows of the states, (S, 6 + m, d)
    """

    cause: Cause
    patterns: tuple[Pattern, ...]
    columns: list[np.ndarray]
    laws: tuple[np.ndarray, ...] = ()

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

    @property
    def part(self) -> Part:
        """The best alternative."""
        i, j = np.unravel_index(int(self.logs.argmax()), self.logs.shape)
        return self.offered.part(int(i), SCALES[j])

    @property
    def spread(self) -> float:
        """By how much all alternatives together exceed the best."""
        return self.total - float(self.logs.max())


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
    found = internal_force.columns(internal)
    states = found[1].shape[-1] // internal.shape[-1]
    columns = stacked(where, local.r.only_static(np.concatenate(found, axis=-1)))
    return [Offered(internal_force.CAUSE, internal_force.patterns(internal.shape[-1], states), columns, found)]


def _laws(local: Local, where: Layout) -> list[Offered]:
    """Laws outside the library, all as one more cause."""
    found = laws(local)
    if not found:
        return []
    columns = np.concatenate([law.columns for law in found], axis=-1)
    return [
        Offered(
            OUTSIDE, patterns(found), stacked(where, local.r.only_static(columns)), tuple(law.columns for law in found)
        )
    ]


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
        basis, weight = pattern.basis * pattern.prior, np.log(pattern.weight / len(SCALES)) - PRICE
        own = scaled_gains(basis.T @ gram @ basis, basis.T @ score, np.array(SCALES), pattern.positive)
        logs.append(own + weight)
    return Gains(cause, np.array(logs))

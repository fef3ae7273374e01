"""Which hypotheses are worth the evidence? Screened in closed form, fitted from several starts, pairs on top.

A hypothesis that was fitted once is fitted again from the noise of the best ones, nothing being wrong among them:
outliers that one start sets aside may be what another explains. The best of all starts counts, so that a longer search
never finds less.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.diagnosis.alternatives import Gains, Offered, gains, offered
from cdpr_struct.diagnosis.assembled import Layout, layout
from cdpr_struct.diagnosis.hypotheses.cause import Cause, Seen
from cdpr_struct.diagnosis.hypotheses.drift import AMPLITUDES
from cdpr_struct.diagnosis.hypothesis import Hypothesis
from cdpr_struct.diagnosis.judge import Judged, judged
from cdpr_struct.diagnosis.recorded import Recorded
from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.scale_mixture import NoiseState


@dataclass(frozen=True, slots=True)
class Budget:
    """Causes fitted at least, nats from the best within which all are, beginnings of pairs, pairs of each fitted.

    near : in the closed form, which errs by some nats where effects are large
    """

    causes: int = 3
    near: float = 14.0
    beginnings: int = 3
    pairs: int = 3


BUDGETS = {"small": Budget(), "full": Budget(6, 20.0, 5, 6)}


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """A set of causes: its best fit, and ln of evidence times prior over all its patterns and scales."""

    names: tuple[str, ...]
    best: Judged
    score: float


class Search:
    """Hypotheses of one campaign, each with the best fit found so far."""

    def __init__(self, data: Recorded, seen: Seen, causes: Sequence[Cause], budget: Budget) -> None:
        self.data, self.seen, self.causes, self.budget = data, seen, list(causes), budget
        self.where: Layout = layout(data)
        self.found: dict[tuple[object, ...], Judged] = {}
        self.spread: dict[tuple[object, ...], float] = {}

    def fitted(self, hypothesis: Hypothesis, start: Judged | None = None, noise: NoiseState | None = None) -> Judged:
        """The best fit of a hypothesis so far, after one more from a start."""
        point = None if start is None else start.likeliest(self.data, self.where)
        sizes = noise if noise is not None or start is None else start.fit.noise
        own = judged(self.data, self.where, hypothesis, point, sizes)
        before = self.found.get(hypothesis.key)
        if before is None or own.log_evidence > before.log_evidence:
            self.found[hypothesis.key] = own
        return self.found[hypothesis.key]

    def run(self) -> list[Answer]:
        """Everything worth fitting, best first."""
        nulls = self._nulls()
        base = max(nulls, key=lambda one: one.score)
        menu = offered(self.data, self.where, self.seen, self.causes, base)
        self._fit_best(self._screened(menu, nulls, self._rich(menu, base)))
        self._transfer()
        for first in self._singles()[: self.budget.beginnings]:
            self._pairs(first)
        self._transfer()
        return self.answers()

    def answers(self) -> list[Answer]:
        """Sets of causes, best first."""
        groups: dict[tuple[str, ...], list[Judged]] = {}
        for one in self.found.values():
            groups.setdefault(tuple(sorted(one.hypothesis.names)), []).append(one)
        rows = []
        for names, own in groups.items():
            score = float(logsumexp([one.score + self.spread.get(one.hypothesis.key, 0.0) for one in own]))
            rows.append(Answer(names, max(own, key=lambda one: one.score), score))
        return sorted(rows, key=lambda row: -row.score)

    def _nulls(self) -> list[Judged]:
        """Nothing wrong, load cells drifting or not."""
        first = self.fitted(Hypothesis())
        return [first, *(self.fitted(Hypothesis(drift=size), first) for size, _ in AMPLITUDES if size > 0.0)]

    def _rich(self, menu: Sequence[Offered], base: Judged) -> NoiseState:
        """Sizes of the noise where every cause may act at once: what none of them explains."""
        columns = [cause.columns * cause.patterns[-1].prior.max() for cause in menu]
        everything = base.model.with_columns(np.concatenate(columns, axis=-1))
        return fit(everything, base.fit.noise).noise

    def _screened(
        self, menu: Sequence[Offered], bases: Sequence[Judged], rich: NoiseState | None
    ) -> list[tuple[float, Gains, Judged, NoiseState]]:
        """Gains of every cause beside every base, at its own noise and at the rich one; the best of each cause."""
        best: dict[str, tuple[float, Gains, Judged, NoiseState]] = {}
        for base in bases:
            for noise in [base.fit.noise, *([rich] if rich is not None else [])]:
                bound = base.log_evidence if noise is base.fit.noise else fit(base.model, noise).bounds[0]
                level = bound + base.hypothesis.log_prior
                for row in gains(menu, base, noise):
                    if row.cause.name not in best or level + row.total > best[row.cause.name][0]:
                        best[row.cause.name] = (level + row.total, row, base, noise)
        return sorted(best.values(), key=lambda row: -row[0])

    def _fit_best(self, rows: list[tuple[float, Gains, Judged, NoiseState]], most: int | None = None) -> None:
        for i, (score, row, base, noise) in enumerate(rows):
            if i < self.budget.causes or (score > rows[0][0] - self.budget.near and (most is None or i < most)):
                hypothesis = Hypothesis((*base.hypothesis.parts, row.part), base.hypothesis.drift)
                self.spread[hypothesis.key] = row.spread
                self.fitted(hypothesis, base, noise)

    def _singles(self) -> list[Judged]:
        own = [one for one in self.found.values() if len(one.hypothesis.parts) == 1]
        return sorted(own, key=lambda one: -one.score)

    def _transfer(self) -> None:
        """Every hypothesis again from the noise of the best two."""
        ranked = sorted(self.found.values(), key=lambda one: -one.score)
        for other in ranked[:2]:
            for one in [o for o in ranked if o is not other and o.score > ranked[0].score - self.budget.near - 20.0]:
                self.fitted(one.hypothesis, one, other.fit.noise)

    def _pairs(self, first: Judged) -> None:
        """A second cause beside one."""
        left = [cause for cause in self.causes if cause.name not in first.hypothesis.names]
        menu = offered(self.data, self.where, self.seen, left, first)
        self._fit_best(self._screened(menu, [first], None)[: self.budget.pairs], self.budget.pairs)

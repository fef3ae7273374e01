"""Which hypotheses are worth the evidence? Screened in closed form, fitted from several starts, pairs on top.

A hypothesis that was fitted once is fitted again from the noise of the best ones, nothing being wrong among them:
outliers that one start sets aside may be what another explains. The best of all starts counts, so that a longer search
never finds less.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.hypotheses.alternatives import Gains, Offered, gains, offered
from cdpr_struct.hypotheses.budget import Budget
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.library import testable
from cdpr_struct.hypotheses.choices import bent, occurs, same, with_choices
from cdpr_struct.hypotheses.hypothesis import PRICE, SCALES, Hypothesis, Part
from cdpr_struct.hypotheses.imitation import alone, imitated
from cdpr_struct.hypotheses.judge import NEAR, SETTLED, Judged, again, begun, converged, extended, judged, settled
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.hypotheses.nulls import nulls_of, rich_noise
from cdpr_struct.hypotheses.scan import Beginning, beginnings, carriers, mounts
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.hypotheses.significant import SIGNIFICANT, p_of_null
from cdpr_struct.inference.evidence import bound_at
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.residuals.layout import Layout, layout
from cdpr_struct.residuals.recorded import Recorded

_NOTHING = 2.0  # nats by which the best single cause may be behind none: else a second one beside it is not looked for
_NESTED = 2  # of the likeliest hypotheses, from whose points nothing wrong is judged
_LAWS = 3  # outside the library, the likeliest, that are fitted where one may be
_RICH = (1.0, SCALES[-1])  # scales of all causes at once: where they are small, outliers stand for large ones
_AGAIN = 6  # hypotheses that are fitted from another one's noise


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """A set of causes: its best fit, and ln of evidence times prior over all its patterns and scales."""

    names: tuple[str, ...]
    best: Judged
    score: float


@dataclass(frozen=True, slots=True, eq=False)
class _Screened:
    """A cause beside a base at sizes of the noise: ln of evidence times prior, in closed form."""

    score: float
    gains: Gains
    base: Judged
    noise: NoiseState


class Search:
    """Hypotheses of one campaign, each with the best fit found so far."""

    def __init__(self, data: Recorded, budget: Budget) -> None:
        self.data, self.seen, self.budget = data, seen_in(data), budget
        self.causes, self.hidden = testable(self.seen, data.campaign.checked)
        if not data.sent.internal.any():
            self.hidden[internal_force.CAUSE.name] = internal_force.REASON
        self.where: Layout = layout(data)
        self.p_value = 1.0
        self.found: dict[tuple[object, ...], Judged] = {}
        self.spread: dict[tuple[object, ...], float] = {}

    def keep(self, found: Judged) -> Judged:
        """The best fit of a hypothesis so far."""
        before = self.found.get(found.hypothesis.key)
        if before is None or found.log_evidence > before.log_evidence:
            self.found[found.hypothesis.key] = found
        return self.found[found.hypothesis.key]

    def run(self) -> list[Answer]:
        """Everything worth fitting, best first."""
        known = [self.keep(one) for one in nulls_of(self.data, self.where)]
        base = max(known, key=lambda one: one.score)
        nulls = [known[0], *(one for one in known[1:] if one.score > base.score - self.budget.near)]
        menu = offered(self.data, self.where, self.seen, self.causes, base)
        self.p_value = p_of_null(menu, base)
        begin = (base.fit.noise, NoiseState.stated(base.model.groups))
        rich = [rich_noise(menu, base, scale, noise) for scale, noise in zip(_RICH, begin, strict=True)]
        menu = with_choices(menu, base, [base.fit.noise, *rich], self.seen)
        rows = self._screened(menu, nulls, rich)
        self._fit_best(menu, rows, self.budget.causes, rows[0].score - self.budget.near)
        self._bend(nulls)
        large = beginnings(self.data, menu, base, self.budget.beginnings + 1)
        self._begin([*large, *mounts(self.data, menu, base)], base)
        if self.p_value < SIGNIFICANT:
            self._begin_alone(carriers(self.data, menu, base), base)
        self._transfer()
        self._beside_other_errors()
        self._as_the_best(menu, base)
        singles = self._singles()
        if singles[0].score > base.score:
            self._begin([*large, *mounts(self.data, menu, singles[0])], singles[0])
        least = max(singles[0].score - self.budget.near, self._ranked(0)[0].score - _NOTHING)
        for first in [one for one in singles[: self.budget.beginnings] if one.score > least]:
            self._pairs(first)
            self._transfer(2)
        self._exchange()
        self._laws_beside(self._ranked()[0])
        self._converge()
        return self.answers()

    def answers(self) -> list[Answer]:
        """Sets of causes, best first."""
        groups: dict[tuple[str, ...], list[Judged]] = {}
        for one in self._ranked():
            groups.setdefault(tuple(sorted(one.hypothesis.names)), []).append(one)
        rows = []
        for names, own in groups.items():
            score = float(logsumexp([one.score + self.spread.get(one.hypothesis.key, 0.0) for one in own]))
            rows.append(Answer(names, max(own, key=lambda one: one.score), score))
        return sorted(rows, key=lambda row: -row.score)

    def _screened(
        self, menu: Sequence[Offered], bases: Sequence[Judged], rich: Sequence[NoiseState] = ()
    ) -> list[_Screened]:
        """The best of each cause beside every base at its noise, beside the likeliest two at rich ones; best first."""
        best: dict[str, _Screened] = {}
        shapes = [part.shape[:2] for part in menu[0].columns] if menu else []
        likeliest = [bases[0], max(bases, key=lambda one: one.score)]
        for base in bases:
            if [stack.r.shape for stack in base.model.stacks] != shapes:
                continue  # about its point the robot has other modes than about that of the menu
            for noise in [base.fit.noise, *(rich if base in likeliest else [])]:
                bound = base.log_evidence if noise is base.fit.noise else bound_at(base.model, noise, base.fit.soft)
                for row in (one for one in gains(menu, base, noise) if not one.cause.tuned):  # those are begun
                    score = bound + base.hypothesis.log_prior + row.total
                    if row.cause.name not in best or score > best[row.cause.name].score:
                        best[row.cause.name] = _Screened(score, row, base, noise)
        return sorted(best.values(), key=lambda one: -one.score)

    def _fit_best(self, menu: Sequence[Offered], rows: Sequence[_Screened], at_least: int, above: float) -> None:
        """Fits of what screening finds best: some at least, and all above a score."""
        columns = {cause.cause.name: cause.columns for cause in menu}
        for i, row in enumerate(rows):
            if i < at_least or row.score > above:
                cause = row.gains.cause
                for part, spread in row.gains.leading(_LAWS if cause.name == UNKNOWN else cause.fitted):
                    more = Hypothesis((*row.base.hypothesis.parts, part), row.base.hypothesis.drift)
                    self.spread[more.key] = spread
                    sigma = part.scale * part.pattern.prior
                    own = [shelf @ part.pattern.basis * sigma for shelf in columns[part.cause.name]]
                    found = extended(self.data, self.where, row.base, more, own, row.noise)
                    if found.log_evidence < row.base.log_evidence + part.log_weight:
                        found = again(self.data, self.where, found, row.base.fit.noise)
                    self.keep(self._followed(found))

    def _followed(self, found: Judged) -> Judged:
        """Linearised about its likeliest point where that may matter: as one of the best, or far from the first."""
        worth = self.budget.hopeless if found.moved > NEAR else PRICE
        return settled(self.data, self.where, found) if found.score > self._ranked()[0].score - worth else found

    def _bend(self, nulls: Sequence[Judged]) -> None:
        """Causes whose carriers have one of several ways, fitted so that these ways may bend."""
        for one in [one for one in self._ranked(1) if one.hypothesis.parts[0].cause.one_of]:
            base = next(null for null in nulls if null.hypothesis.drift == one.hypothesis.drift)
            for part in bent(one.hypothesis.parts[0], self.seen):
                more = Hypothesis((part,), one.hypothesis.drift)
                self.spread[more.key] = self.spread.get(one.hypothesis.key, 0.0)
                z = np.append(one.sizes[0], np.zeros(len(part.pattern.prior) - len(one.sizes[0])))
                self._begin_at(z, more, base)

    def _begin(self, large: Sequence[Beginning], base: Judged) -> None:
        """Fits of large changes that would put peaks right, beside what is known by then."""
        present = {part.cause.name for part in base.hypothesis.parts}
        for one in large:
            if one.part.cause.name not in present:
                more = Hypothesis((*base.hypothesis.parts, one.part), base.hypothesis.drift)
                self._begin_at(one.z, more, base, self._ranked()[0].score - self.budget.hopeless)

    def _begin_at(self, z: np.ndarray, more: Hypothesis, base: Judged, least: float = -np.inf) -> None:
        """A fit with one more cause than the base, from its numbers z on, if there may be such a robot."""
        with suppress(UnstableEquilibriumError):
            self.keep(begun(self.data, self.where, base, more, z, least))

    def _beside_other_errors(self) -> None:
        """The likeliest cause alone, beside each drift or correlation that is likelier than independent noise.

        A large cause may look like a drift of its own, so that the sensors' true one is not the likeliest without it.
        """
        nulls, best = self._ranked(0), self._ranked()[0]
        independent = next(one.score for one in nulls if one.hypothesis.drift is None)
        for null in nulls if best.hypothesis.parts else ():
            if null.score >= independent and null.hypothesis.drift != best.hypothesis.drift:
                self._begin_beside(null, best.hypothesis.parts[0], best.sizes[0])

    def _as_the_best(self, menu: Sequence[Offered], base: Judged) -> None:
        """Rivals of the likeliest cause beside its drift, from sizes with which they do what it does.

        Among them that cause at one cable, mast or axis alone, where it acts on several: the likeliest of these.
        """
        best, *others = self._singles()
        if best.score < base.score or _unlike(best.hypothesis.parts[0]):
            return
        near = [one.hypothesis.parts[0] for one in others if one.score > best.score - self.budget.near]
        rivals = [part for part in near if not _unlike(part)]
        found = imitated(menu, base, best, [*rivals, *alone(menu, best)])
        of_one_carrier = sorted(found[len(rivals) :], key=lambda one: -one.share)
        null = next(one for one in self._ranked(0) if one.hypothesis.drift == best.hypothesis.drift)
        for one in [*found[: len(rivals)], *of_one_carrier[:1]]:
            self._begin_beside(null, one.part, one.z)

    def _begin_beside(self, null: Judged, part: Part, z: np.ndarray) -> None:
        """A cause alone beside the drift of a null; its other scales and patterns count there as elsewhere."""
        more = Hypothesis((part,), null.hypothesis.drift)
        known = [self.spread.get(Hypothesis((part,), one.hypothesis.drift).key, 0.0) for one in self._ranked(0)]
        self.spread.setdefault(more.key, max(known))
        self._begin_at(z, more, null, self._ranked()[0].score - self.budget.near)

    def _begin_alone(self, alone: Sequence[Beginning], base: Judged) -> None:
        """Fits of changes of one cable, mast or axis: those that may come near the best, the likeliest first."""
        few = alone[: self.budget.alone]
        self._begin([one for one in few if one.gain > alone[0].gain - self.budget.near], base)

    def _ranked(self, causes: int | None = None) -> list[Judged]:
        """All fits, or those of so many causes, best first, that say what may occur."""
        own = [one for one in self.found.values() if causes in (None, len(one.hypothesis.parts)) and occurs(one)]
        return sorted(own, key=lambda one: -one.score)

    def _singles(self) -> list[Judged]:
        """The best fit of each single cause, best first; all laws outside the library are one cause."""
        best: dict[str, Judged] = {}
        for one in self._ranked(1):
            best.setdefault(one.hypothesis.parts[0].cause.name, one)
        return list(best.values())

    def _transfer(self, causes: int | None = None) -> None:
        """The likeliest hypotheses, and nothing wrong, again from the noise of the best two."""
        ranked = self._ranked()
        near = [one for one in self._ranked(causes) if one.score > ranked[0].score - self.budget.near]
        for other in ranked[:2]:
            for one in [*near[:_AGAIN], *self._ranked(0)]:
                if one.hypothesis.key != other.hypothesis.key:
                    before = self.found[one.hypothesis.key]
                    found = again(self.data, self.where, before, other.fit.noise)
                    self.keep(found if found is before else self._followed(found))

    def _converge(self) -> None:
        """The likeliest hypotheses, and nothing wrong, linearised again until their evidence stays.

        Nothing wrong is judged once more from their points: tolerances alone may give peaks to modes as they do.
        """
        ranked = self._ranked()
        near = [one for one in ranked if self._may_matter(one, ranked[0])]
        for one in {one.hypothesis.key: one for one in [*near[: self.budget.converged], self._ranked(0)[0]]}.values():
            self.found[one.hypothesis.key] = converged(self.data, self.where, one)
        for best in [one for one in self._ranked()[:_NESTED] if one.hypothesis.parts]:
            null = Hypothesis(drift=best.hypothesis.drift)
            there = best.likeliest(self.data, self.where)
            self.keep(judged(self.data, self.where, null, there, best.fit.noise))

    def _may_matter(self, found: Judged, best: Judged) -> bool:
        """Whether evidence is near the best. Where nothing is wrong effects are small, and what has settled stays."""
        small = not best.hypothesis.parts and found.moved < SETTLED
        return found.score > best.score - (PRICE if small else self.budget.sure)

    def _pairs(self, first: Judged, *others: NoiseState) -> None:
        """A second cause beside one, where that may come near the best; screened at other sizes of the noise, too."""
        present = {part.cause.name for part in first.hypothesis.parts}
        known = [part.cause for part in first.hypothesis.parts]
        left = [c for c in self.causes if c.name not in present and not any(same(c, one) for one in known)]
        menu = offered(self.data, self.where, self.seen, left, first)
        menu = with_choices(menu, first, [first.fit.noise, *others], self.seen)
        rows = self._screened(menu, [first], others)[: self.budget.pairs]
        self._fit_best(menu, rows, 0, self._ranked()[0].score - self.budget.pair_near)

    def _exchange(self) -> None:
        """Each cause of the likeliest pair against its rivals beside the other, which alone may have been unlikely.

        What explains a large effect best alone has a share in the small one; with that known, a rival may be likelier.
        """
        best = self._ranked()[0]
        if len(best.hypothesis.parts) != 2:
            return
        for part in best.hypothesis.parts:
            if not part.cause.tuned and part.law is None:
                alone = Hypothesis((part,), best.hypothesis.drift)
                known = self.keep(judged(self.data, self.where, alone, noise=best.fit.noise))
                self._pairs(known, best.fit.noise)

    def _laws_beside(self, best: Judged) -> None:
        """A law outside the library beside the two likeliest causes: these may have shared out its effect."""
        if len(best.hypothesis.parts) < 2 or UNKNOWN in best.hypothesis.names:
            return
        menu = [one for one in offered(self.data, self.where, self.seen, [], best) if one.cause.name == UNKNOWN]
        self._fit_best(menu, self._screened(menu, [best]), 0, best.score - self.budget.pair_near)


def _unlike(part: Part) -> bool:
    """Whether a cause does nothing to first order, or is no change of the robot."""
    return part.cause.tuned or part.law is not None

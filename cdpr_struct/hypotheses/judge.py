"""How probable is a hypothesis, given a campaign? Evidence at the likeliest point, linearised there again and again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.errors import CdprError, UnstableEquilibriumError
from cdpr_struct.hypotheses.drift import Drift
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.inference.evidence import Fit, fit
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.residuals.assembled import Lists, linear_model
from cdpr_struct.residuals.layout import Layout, noise_of_states
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import Recorded

PASSES = 5  # linearisations at most; near the data the steps shrink by ten and more each
_STEPS = (1.0, 0.4, 0.1)  # of the way to the likeliest point, as long as that leads nowhere
WORTH = 0.1  # nats: a smaller difference is none; by so much must another start be better to be followed
NEAR = 3.0  # sigmas: so far the model is straight, and a step that is no shorter only assigns peaks anew
_BENDS = np.repeat([0.01, 0.005], 3)  # m, rad: a pose that moves so far counts as a sigma where it was not read
_SLACKEST = 20.0  # weight over tension of a cable: no state with more is measured, and its modes take minutes
_STILL = 0.01  # sigmas: so near its point the evidence of a hypothesis has converged
SETTLED = 0.5  # sigmas: a point that moves less is where it was; what bends on so short a way is no tenth of a nat


@dataclass(frozen=True, slots=True, eq=False)
class Judged:
    """A hypothesis with its evidence: fitted numbers, and the linear model about the point they were found from.

    lists : peaks of the robot as they were assigned, None without any
    moved : by how many sigmas the likeliest numbers lie from that point, at most; of what bends sooner, see `straight`
    """

    hypothesis: Hypothesis
    point: Point
    model: LinearModel
    lists: Lists | None
    fit: Fit
    moved: float

    @property
    def log_evidence(self) -> float:
        """[nat], without the prior."""
        return self.fit.log_evidence

    @property
    def score(self) -> float:
        """ln of evidence times prior."""
        return self.log_evidence + self.hypothesis.log_prior

    def split(self, value: np.ndarray) -> list[np.ndarray]:
        """Parts of (..., t) numbers, those of each term of the point."""
        return np.split(value, np.cumsum([len(term.sigma) for term in self.point.terms])[:-1], axis=-1)

    @property
    def rows(self) -> int:
        """Number of rows that are read directly, padding left out."""
        return sum(int((stack.A.any(axis=2) & stack.hard).sum()) for stack in self.model.stacks)

    @property
    def misfit(self) -> float:
        """Sum of squares of the noise and the numbers that explain the data, in stated and prior sigmas."""
        inferred = np.isnan(self.model.groups.fixed_variance)
        causes = sum(len(part.pattern.prior) for part in self.hypothesis.parts)
        z = self.fit.z_mean[: len(self.fit.z_mean) - causes]
        pairs = zip(self.model.stacks, self.fit.noise_mean, strict=True)
        noise = sum(float((u[(s.index >= 0) & inferred[s.index]] ** 2).sum()) for s, u in pairs)
        return noise + float(z @ z)

    @property
    def sizes(self) -> list[np.ndarray]:
        """z of each cause, in sigmas of its prior at its scale."""
        return self.split(self.fit.z_mean)[len(self.point.terms) - len(self.hypothesis.parts) :]

    def drifted(self, data: Recorded) -> np.ndarray | None:
        """(S, n) zeros of the sensors that drift [N, m, rad]; None where none do."""
        drift = self.hypothesis.drift
        return drift.zeros(data, self.split(self.fit.z_mean)[1]) if isinstance(drift, Drift) else None

    def likeliest(self, data: Recorded, where: Layout) -> Point:
        """The point of the likeliest numbers."""
        noise = noise_of_states(data, where, self.fit.noise_mean)
        return replace(self.point, z=tuple(self.split(self.fit.z_mean)), noise=noise)


def judged(
    data: Recorded, where: Layout, hypothesis: Hypothesis, start: Point | None = None, noise: NoiseState | None = None
) -> Judged:
    """The evidence of a hypothesis, from a point and sizes of noise to begin with (default: as entered, as stated)."""
    point = _with_terms(data, hypothesis, Point.entered(data) if start is None else start)
    return settled(data, where, _fitted(data, where, hypothesis, point, noise))


def begun(
    data: Recorded, where: Layout, base: Judged, more: Hypothesis, z: np.ndarray, least: float = -np.inf
) -> Judged:
    """A hypothesis with one more cause than a judged one, from those numbers z of it on; `least` as in `settled`.

    Raises
    ------
    UnstableEquilibriumError : such a robot is not at rest, or a cable of it hangs slack.
    """
    start = base.likeliest(data, where)
    point = replace(start.with_term(more.parts[-1].term, z), noise=start.noise)
    if not _possible(data, point):
        raise UnstableEquilibriumError("a cable hangs slack")
    local = Local.about(data, point)
    model, lists = linear_model(local, where), Lists.of(local, where)
    covariance = np.zeros((model.parameters, model.parameters))
    known = len(base.fit.z_mean)
    covariance[:known, :known] = base.fit.z_covariance
    assigned = None if lists is None else lists.at_point(covariance)
    return settled(data, where, _of_model(data, where, more, point, model, base.fit.noise, lists, assigned), least)


def extended(
    data: Recorded, where: Layout, base: Judged, more: Hypothesis, columns: Sequence[np.ndarray], noise: NoiseState
) -> Judged:
    """A hypothesis with one more term than a judged one, about its point; columns (K, n, d) of its numbers a shelf."""
    point = _with_terms(data, more, base.point)
    model = base.model.with_columns(columns)
    return _of_model(data, where, more, point, model, noise, _copied(base.lists), base.fit.soft)


def again(data: Recorded, where: Layout, found: Judged, noise: NoiseState) -> Judged:
    """A hypothesis from other sizes of the noise, about the point that it has; the better of both."""
    point, model, lists = found.point, found.model, _copied(found.lists)
    other = _of_model(data, where, found.hypothesis, point, model, noise, lists, found.fit.soft)
    return other if other.log_evidence >= found.log_evidence + WORTH else found


def settled(data: Recorded, where: Layout, found: Judged, least: float = -np.inf) -> Judged:
    """Linearised about its likeliest point until that stays where it is, or comes no nearer to that.

    Or until a score `least` would not be reached if each pass left gained as much as the last one.
    """
    for done in range(1, PASSES + 1):
        if found.moved < SETTLED:
            break
        nearer = _nearer(data, where, found)
        if nearer is None:
            break
        before, found = found, nearer
        if found.score + (PASSES - done) * max(found.score - before.score, 0.0) < least:
            break
    return found


def _nearer(data: Recorded, where: Layout, found: Judged, steps: Sequence[float] = _STEPS) -> Judged | None:
    """Linearised at the likeliest point or on the way to it, where the next one is nearer; None if that is nowhere.

    A hypothesis that does not explain the data may ask for readings that no robot has; there it is not followed.
    """
    there = found.likeliest(data, where)
    for share in steps:
        point = found.point.towards(there, share)
        if not _possible(data, point):
            continue
        try:
            other = _fitted(data, where, found.hypothesis, point, found.fit.noise, found)
        except (CdprError, np.linalg.LinAlgError):  # the robot has no stable equilibrium there
            continue
        if other.moved < max(found.moved, NEAR):
            return other
    return None


def converged(data: Recorded, where: Layout, found: Judged) -> Judged:
    """Linearised about its likeliest point until the evidence stays: modes that nearly coincide bend to the last."""
    for _ in range(PASSES):
        if found.moved < _STILL:
            break
        nearer = _nearer(data, where, found, (1.0,))
        if nearer is None:
            break
        before, found = found, nearer
        if abs(found.log_evidence - before.log_evidence) < WORTH:
            break
    return found


def _possible(data: Recorded, point: Point) -> bool:
    """Whether all cables are tight and have a length, and the platform has a mass."""
    readings, arrays = point.readings(data), point.robot(data)
    tight = (readings.tension > 0.0) & (readings.tension * _SLACKEST > arrays.weight * readings.length)
    return bool(tight.all() and (readings.length > 0.0).all() and np.all(arrays.mass > 0.0))


def _copied(lists: Lists | None) -> Lists | None:
    return None if lists is None else lists.copy()


def _with_terms(data: Recorded, hypothesis: Hypothesis, start: Point) -> Point:
    """A point of the hypothesis: what it shares with the start in front keeps its numbers, the rest is zero."""
    terms = (start.terms[0], *hypothesis.terms(data))
    kept = start.z if len(start.z) <= len(terms) else start.z[:1]
    point = replace(start, terms=terms[: len(kept)], z=kept)
    for term in terms[len(kept) :]:
        point = point.with_term(term)
    return point


def _fitted(
    data: Recorded, where: Layout, hypothesis: Hypothesis, point: Point, noise: NoiseState | None,
    before: Judged | None = None,
) -> Judged:  # fmt: skip
    """Linearised about a point; peaks assigned there as sure as numbers are after an earlier fit, if any."""
    local = Local.about(data, point)
    model, lists = linear_model(local, where), Lists.of(local, where)
    sure = None if before is None or lists is None else lists.at_point(before.fit.z_covariance)
    return _of_model(data, where, hypothesis, point, model, noise, lists, sure)


def _of_model(
    data: Recorded, where: Layout, hypothesis: Hypothesis, point: Point, model: LinearModel,
    noise: NoiseState | None, lists: Lists | None, assigned: SoftExpectation | None,
) -> Judged:  # fmt: skip
    found = fit(model, noise, lists, assigned, hypothesis.positive(point))
    there = noise_of_states(data, where, found.noise_mean)
    by_noise = _shift(data, there - point.noise)
    by_numbers = np.abs(found.z_mean - np.concatenate(point.z)) / hypothesis.straight(point)
    moved = max(float(by_numbers.max()), float(by_noise))
    return Judged(hypothesis, point, model, lists, found, moved)


def _shift(data: Recorded, change: np.ndarray) -> float:
    """The largest change (S, 6 + 2 m) of the readings' noise, in sigmas; of unread poses by how they bend."""
    pose = np.abs(change[:, :6] * data.sigma[:, :6]) / _BENDS
    return float(max(np.abs(change)[data.read].max(initial=0.0), pose[~data.read[:, :6]].max(initial=0.0)))

"""How probable is a hypothesis, given a campaign? Evidence at the likeliest point, linearised there again and again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.assembled import Layout, assembled, noise_of_states
from cdpr_struct.diagnosis.hypothesis import Hypothesis
from cdpr_struct.diagnosis.linearised import Local, Point
from cdpr_struct.diagnosis.recorded import Recorded
from cdpr_struct.inference.evidence import Fit, fit
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseState

PASSES = 4  # linearisations at most; the steps shrink by ten and more each
_SETTLED = 0.2  # sigmas: a point that moves less is where it was


@dataclass(frozen=True, slots=True, eq=False)
class Judged:
    """A hypothesis with its evidence: fitted numbers, and the linear model about the point they were found from.

    moved : by how many sigmas the likeliest numbers lie from that point, at most
    """

    hypothesis: Hypothesis
    point: Point
    model: LinearModel
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
    def sizes(self) -> list[np.ndarray]:
        """z of each cause, in sigmas of its prior at its scale."""
        return self.split(self.fit.z_mean)[len(self.point.terms) - len(self.hypothesis.parts) :]

    def likeliest(self, data: Recorded, where: Layout) -> Point:
        """The point of the likeliest numbers."""
        noise = noise_of_states(data, where, self.fit.noise_mean)
        return replace(self.point, z=tuple(self.split(self.fit.z_mean)), noise=noise)


def judged(
    data: Recorded,
    where: Layout,
    hypothesis: Hypothesis,
    start: Point | None = None,
    noise: NoiseState | None = None,
    passes: int = PASSES,
) -> Judged:
    """The evidence of a hypothesis, from a point and sizes of noise to begin with (default: as entered, as stated)."""
    point = _begun(data, hypothesis, start)
    for _ in range(passes):
        found = _once(data, where, hypothesis, point, noise)
        if found.moved < _SETTLED:
            break
        point, noise = found.likeliest(data, where), found.fit.noise
    return found


def _begun(data: Recorded, hypothesis: Hypothesis, start: Point | None) -> Point:
    """The point with the hypothesis's own terms; tolerances and noise as at the start."""
    if start is not None and len(start.terms) == 1 + len(hypothesis.terms(data)):
        return start
    base = Point.entered(data) if start is None else start
    point = replace(base, terms=base.terms[:1], z=base.z[:1])
    for term in hypothesis.terms(data):
        point = point.with_term(term)
    return point


def _once(data: Recorded, where: Layout, hypothesis: Hypothesis, point: Point, noise: NoiseState | None) -> Judged:
    model = linear_model(data, where, point)
    found = fit(model, noise, one_sided=hypothesis.positive(point))
    here = np.concatenate(point.z)
    there = noise_of_states(data, where, found.noise_mean)
    moved = max(
        float(np.abs(found.z_mean - here).max()), float(np.abs((there - point.noise)[data.read]).max(initial=0.0))
    )
    return Judged(hypothesis, point, model, found, moved)


def linear_model(data: Recorded, where: Layout, point: Point) -> LinearModel:
    """Residuals about a point, referred to zero noise and zero numbers: r = R + A u0 + X z0."""
    local = Local.about(data, point)
    by_noise, columns = local.by_noise(), local.own_columns()
    shift = np.einsum("srj,sj->sr", by_noise, point.noise) + columns @ np.concatenate(point.z)
    return assembled(data, where, local.r + shift, by_noise, columns)


def best(found: Sequence[Judged]) -> Judged:
    """The one of the highest score."""
    return max(found, key=lambda one: one.score)

"""Errors of peaks as a mixture of scales, learnt per kind of list.

ln f of a peak is N(ln f_mode, (tau kappa s)^2) with kappa one of SCALES. The factors of the bound are those of the
readings in `inference`: weights of the scales are integrated out, ln Gamma of each count replaced by its chord
between whole counts, and tau^2 has a scaled inverse chi-squared posterior. An unassigned peak has a scale, too, of
which its place says nothing: so the number of peaks that drew a scale is always that of all peaks.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import digamma, gammaln

from cdpr_struct.association.peaks import KINDS
from cdpr_struct.inference import scale_mixture
from cdpr_struct.inference.scale_mixture import TAU_DEGREES

SCALES = scale_mixture.KAPPA[:-1]
"""kappa [-] of the readings, but for the largest: a peak that far off is another mode's, or none's."""
PSEUDO_COUNTS = scale_mixture.PSEUDO_COUNTS[:-1]
"""Prior counts of these scales [peaks]."""


@dataclass(frozen=True, slots=True, eq=False)
class ScaleCounts:
    """What a matching says of the noise, per kind of list.

    number (n, 4) : expected number of peaks on each scale, unassigned ones included
    assigned (n,) : expected number of assigned peaks
    square (n,) : their expected squared errors, summed in units of (kappa s)^2
    """

    number: np.ndarray
    assigned: np.ndarray
    square: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class PeakNoise:
    """State of the noise of peaks, one row per kind.

    weight (n, 4) : expected share of each scale, rows of sum one
    degrees (n,) : degrees of freedom of tau^2, inf if tau is known
    tau (n,) : 1 / sqrt(E 1/tau^2), factor on every stated sd
    """

    weight: np.ndarray
    degrees: np.ndarray
    tau: np.ndarray

    def __post_init__(self) -> None:
        if not (self.weight > 0.0).all() or not (self.tau > 0.0).all():
            raise ValueError("PeakNoise.weight and PeakNoise.tau must be positive")

    @property
    def known(self) -> bool:
        """Whether weights and tau are given, not learnt."""
        return bool(np.isinf(self.degrees).any())

    @property
    def ln_tau(self) -> np.ndarray:
        """(n,) expected ln tau."""
        if self.known:
            return np.log(self.tau)
        shape = 0.5 * self.degrees
        return np.log(self.tau) + 0.5 * (np.log(shape) - digamma(shape))

    def expected_log(self, counts: ScaleCounts) -> float:
        """Share of the noise in the log likelihood expected under a matching, sd and kappa apart [nats]."""
        return float((counts.number * np.log(self.weight)).sum() + self._errors(counts))

    def bound(self, counts: ScaleCounts) -> float:
        """The same with weights and tau integrated out [nats]; at most of the updated noise."""
        if self.known:
            return self.expected_log(counts)
        return float(_weight_bound(counts.number) + self._errors(counts) - self._tau_divergence())

    def updated(self, counts: ScaleCounts) -> "PeakNoise":
        """The noise after a matching; raises `bound`, or leaves it."""
        if self.known:
            return self
        degrees = TAU_DEGREES + counts.assigned
        weight = PSEUDO_COUNTS + np.floor(counts.number)
        return PeakNoise(
            weight / weight.sum(axis=1, keepdims=True), degrees, np.sqrt((TAU_DEGREES + counts.square) / degrees)
        )

    def _errors(self, counts: ScaleCounts) -> float:
        return float(-(counts.assigned * self.ln_tau + 0.5 * counts.square * self.tau**-2.0).sum())

    def _tau_divergence(self) -> float:
        """Kullback-Leibler divergence of the posterior of tau^2 from its prior."""
        shape, prior = 0.5 * self.degrees, 0.5 * TAU_DEGREES
        rate = shape * self.tau**2
        parts = (shape - prior) * digamma(shape) - gammaln(shape) + gammaln(prior)
        return float((parts + prior * np.log(rate / prior) + shape * (prior - rate) / rate).sum())


def stated_noise() -> PeakNoise:
    """The prior: errors as stated, outliers rare."""
    weight = np.tile(PSEUDO_COUNTS / PSEUDO_COUNTS.sum(), (len(KINDS), 1))
    return PeakNoise(weight, np.full(len(KINDS), TAU_DEGREES), np.ones(len(KINDS)))


def known_noise(weight: np.ndarray, tau: np.ndarray) -> PeakNoise:
    """Noise that is given: weights (n, 4) of the scales, each row of sum one, and tau (n,)."""
    tau = np.array(tau, float)
    return PeakNoise(np.array(weight, float), np.full(tau.shape, np.inf), tau)


def _weight_bound(number: np.ndarray) -> float:
    """Bound of E ln p(scales), weights integrated out: ln Gamma by its chord between neighbouring whole counts."""
    whole = np.floor(number)
    chord = gammaln(PSEUDO_COUNTS + whole) + (number - whole) * np.log(PSEUDO_COUNTS + whole) - gammaln(PSEUDO_COUNTS)
    total = PSEUDO_COUNTS.sum()
    return float(chord.sum() + (gammaln(total) - gammaln(total + number.sum(axis=1))).sum())

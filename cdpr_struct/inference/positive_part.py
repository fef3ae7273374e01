"""How probable is it that Gaussian quantities are all positive, and where are they then?

One quantity: exact. Several: expectation propagation, one site per quantity, to convergence (Cunningham, Hennig,
Lacoste-Julien, Gaussian probabilities and expectation propagation, arXiv:1111.6832). It does not depend on the
order of the quantities.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import erfcx, log_ndtr

# Sweeps of expectation propagation at most, and the change of a standardised mean [-] at which it stops.
MAX_SWEEPS = 50
SETTLED = 1e-8
# Below this many standard deviations, moments of the tail come from their asymptotic series (error 2e-8 there).
FAR_TAIL = -60.0


@dataclass(frozen=True, slots=True, eq=False)
class PositivePart:
    """A Gaussian restricted to positive values.

    log_probability : (...) ln P(all > 0)
    mean            : (..., d) given that all are positive
    covariance      : (..., d, d) given that all are positive
    """

    log_probability: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray


def tail_moments(ratio: np.ndarray | float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """ln P(x > 0), E[x | x > 0] and var[x | x > 0] of x ~ N(ratio, 1)."""
    a = np.asarray(ratio, dtype=float)
    near = np.maximum(a, FAR_TAIL)
    hazard = np.sqrt(2.0 / np.pi) / erfcx(-near / np.sqrt(2.0))
    far = 1.0 / np.minimum(a, FAR_TAIL) ** 2
    mean = np.where(a > FAR_TAIL, near + hazard, np.sqrt(far) * (1.0 - far * (2.0 - 10.0 * far)))
    variance = np.where(a > FAR_TAIL, 1.0 - hazard * (near + hazard), far * (1.0 - far * (6.0 - 50.0 * far)))
    return log_ndtr(a), mean, variance


def positive_part(mean: np.ndarray, covariance: np.ndarray) -> PositivePart:
    """Restrict x ~ N(mean (..., d), covariance (..., d, d)) to x > 0."""
    scale = np.sqrt(np.einsum("...ii->...i", covariance))
    product = scale[..., :, None] * scale[..., None, :]
    ratio = mean / scale
    if mean.shape[-1] == 1:
        log_probability, centre, spread = tail_moments(ratio)
        return PositivePart(log_probability[..., 0], scale * centre, spread[..., None] * product)
    part = _propagated(ratio, covariance / product)
    return PositivePart(part.log_probability, scale * part.mean, part.covariance * product)


def _propagated(ratio: np.ndarray, correlation: np.ndarray) -> PositivePart:
    """The positive part of x ~ N(ratio, correlation) by one site exp(slope x - precision x^2/2) per quantity."""
    slope, precision = np.zeros(ratio.shape), np.zeros(ratio.shape)
    mean, covariance = ratio.copy(), correlation.copy()
    for _ in range(MAX_SWEEPS):
        before = mean
        for i in range(ratio.shape[-1]):
            variance = covariance[..., i, i]
            cavity_precision = 1.0 / variance - precision[..., i]
            root = np.sqrt(cavity_precision)
            cavity_slope = mean[..., i] / variance - slope[..., i]
            _, centre, spread = tail_moments(cavity_slope / root)
            change = cavity_precision / spread - cavity_precision - precision[..., i]
            step = centre * root / spread - cavity_slope - slope[..., i]
            precision[..., i] += change
            slope[..., i] += step
            column = covariance[..., i] / (1.0 + change * variance)[..., None]
            covariance = covariance - change[..., None, None] * column[..., :, None] * covariance[..., None, i, :]
            mean = mean + column * (step - change * mean[..., i])[..., None]
        if np.abs(mean - before).max(initial=0.0) < SETTLED:
            break
    found = PositivePart(np.zeros(ratio.shape[:-1]), mean, covariance)
    return replace(found, log_probability=_log_probability(ratio, correlation, slope, precision, found))


def _log_probability(
    ratio: np.ndarray, correlation: np.ndarray, slope: np.ndarray, precision: np.ndarray, found: PositivePart
) -> np.ndarray:
    """ln P(x > 0) from sites that have settled."""
    mean, variance = found.mean, np.einsum("...ii->...i", found.covariance)
    cavity_precision, cavity_slope = 1.0 / variance - precision, mean / variance - slope
    own = log_ndtr(cavity_slope / np.sqrt(cavity_precision))
    own -= 0.5 * (mean**2 / variance - cavity_slope**2 / cavity_precision + np.log(cavity_precision * variance))
    joint = np.linalg.slogdet(np.eye(ratio.shape[-1]) + correlation * precision[..., None, :])[1]
    # (slope + P m)' C (slope + P m) - m' P m with P the prior's precision, without forming P.
    gain = (slope * mean + ratio * (slope - precision * mean)).sum(axis=-1)
    return own.sum(axis=-1) + 0.5 * (gain - joint)

"""How probable is it that Gaussian quantities are all positive, and where are they then?

One quantity: exact. Several: expectation propagation, one site per quantity, to convergence (Cunningham, Hennig,
Lacoste-Julien, Gaussian probabilities and expectation propagation, arXiv:1111.6832). It does not depend on the
order of the quantities.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import erfcx, log_ndtr

# Sweeps of expectation propagation at most, and the change of a standardised mean [-] at which it stops.
MAX_SWEEPS = 50
SETTLED = 1e-9
# Below this many standard deviations, moments of the tail come from their asymptotic series (error 2e-8 there).
FAR_TAIL = -60.0


@dataclass(frozen=True, slots=True, eq=False)
class PositivePart:
    """A Gaussian restricted to positive values.

    log_probability : ln P(all > 0)
    mean            : (d,) given that all are positive
    covariance      : (d, d) given that all are positive
    """

    log_probability: float
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
    """Restrict x ~ N(mean (d,), covariance (d, d)) to x > 0."""
    scale = np.sqrt(np.diag(covariance))
    ratio, correlation = mean / scale, covariance / np.outer(scale, scale)
    if len(mean) == 1:
        exact = tail_moments(ratio)
        return PositivePart(float(exact[0][0]), scale * exact[1], exact[2][:, None] * covariance)
    log_probability, centre, spread = _propagated(ratio, correlation)
    return PositivePart(log_probability, scale * centre, spread * np.outer(scale, scale))


def _propagated(ratio: np.ndarray, correlation: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """ln P(x > 0), mean and covariance of x ~ N(ratio, correlation), given x > 0."""
    slope, precision = np.zeros(len(ratio)), np.zeros(len(ratio))
    mean, covariance = ratio.copy(), correlation.copy()
    for _ in range(MAX_SWEEPS):
        before = mean
        for i in range(len(ratio)):
            cavity_precision = 1.0 / covariance[i, i] - precision[i]
            cavity = (mean[i] / covariance[i, i] - slope[i]) / cavity_precision
            _, centre, spread = tail_moments(cavity * np.sqrt(cavity_precision))
            target = spread / cavity_precision
            change = 1.0 / target - cavity_precision - precision[i]
            precision[i] += change
            step = centre / np.sqrt(cavity_precision) / target - cavity * cavity_precision - slope[i]
            slope[i] += step
            column = covariance[:, i] / (1.0 + change * covariance[i, i])
            mean = mean + column * (step - change * mean[i])
            covariance = covariance - change * np.outer(column, covariance[i])
        if np.abs(mean - before).max() < SETTLED:
            break
    return _log_probability(ratio, correlation, slope, precision, mean, covariance), mean, covariance


def _log_probability(
    ratio: np.ndarray,
    correlation: np.ndarray,
    slope: np.ndarray,
    precision: np.ndarray,
    mean: np.ndarray,
    covariance: np.ndarray,
) -> float:
    """ln P(x > 0) from converged sites exp(slope x - precision x^2/2)."""
    variance = np.diag(covariance)
    cavity_precision = 1.0 / variance - precision
    cavity_slope = mean / variance - slope
    own = log_ndtr(cavity_slope / np.sqrt(cavity_precision))
    own -= 0.5 * (mean**2 / variance - cavity_slope**2 / cavity_precision + np.log(cavity_precision * variance))
    sign, log_determinant = np.linalg.slogdet(np.eye(len(ratio)) + correlation * precision)
    # (slope + P m)' C (slope + P m) - m' P m with P the prior's precision, without forming P.
    gain = slope @ mean + ratio @ (slope - precision * mean)
    return float(own.sum() + 0.5 * (gain - log_determinant)) if sign > 0 else -np.inf

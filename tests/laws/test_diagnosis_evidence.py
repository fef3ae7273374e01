"""The closed-form evidence is that of the Gaussian integrals that it stands for."""

import numpy as np
from scipy.stats import multivariate_normal

from cdpr_struct.diagnosis.causes.cause import SCALES, Cause, Parameter, Pattern
from cdpr_struct.diagnosis.evidence import Candidate, Freed, gains_of, log_bayes_factor, scaled_log_bayes_factors

RNG = np.random.default_rng(4)
G, Z = RNG.standard_normal((12, 3)), RNG.standard_normal(12)


def density(z, *signatures):
    covariance = np.eye(len(z)) + sum((g @ g.T for g in signatures), np.zeros((len(z), len(z))))
    return multivariate_normal(np.zeros(len(z)), covariance).logpdf(z)


def test_bayes_factor_is_the_ratio_of_two_densities():
    assert np.isclose(log_bayes_factor(G, Z), density(Z, G) - density(Z), rtol=1e-10)


def test_scales_multiply_the_signature():
    logs = scaled_log_bayes_factors(G.T @ G, G.T @ Z, (0.4, 2.5))
    assert np.allclose(logs, [log_bayes_factor(s * G, Z) for s in (0.4, 2.5)])


def test_evidence_on_top_of_others_is_conditional():
    """ln B of a cause whitened by others is that of both together less that of the others."""
    others = RNG.standard_normal((12, 2))
    free = Freed(others)
    both = density(Z, G, others) - density(Z, others)
    assert np.isclose(log_bayes_factor(free.of(G), free.of(Z)), both, rtol=1e-9)


def one_size(positive: bool) -> Candidate:
    named = (Parameter("size", "1", 1.0, positive=positive),)
    cause = Cause("one", "one", named, lambda world, theta: world)
    return Candidate(cause, 3.0 * np.eye(12)[:, :1], [Pattern("", np.eye(1), named, 1.0)])


def test_a_size_that_cannot_be_negative_counts_only_the_side_that_explains():
    """Residuals are minus the signature times the size: what a positive size explains has the sign of -signature."""
    z = np.zeros(12)
    z[0] = -4.0
    free, bound = gains_of(one_size(False), z), gains_of(one_size(True), z)
    assert bound.shape == (1, len(SCALES))
    assert np.all(bound > free + 0.5)  # up to ln 2
    assert np.all(gains_of(one_size(True), -z) < free - 3.0)

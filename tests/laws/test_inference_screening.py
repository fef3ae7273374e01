"""Gains in closed form are those of a refit; one-sided sizes; probabilities of hypotheses."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.positive_part import positive_part, tail_moments
from cdpr_struct.inference.posterior import inclusion, probabilities, summed
from cdpr_struct.inference.screening import Screen, gains
from tests.laws.inference_cases import campaign

SCALES = np.array([0.5, 1.0, 4.0, 16.0])


def candidates(model, count, seed=3):
    return np.random.default_rng(seed).normal(size=(*model.stacks[0].r.shape, count))


def test_gain_is_the_difference_of_evidence_in_the_gaussian_case():
    model = campaign(3, given=2.0)
    columns = candidates(model, 5)
    screened = Screen.of(model, fit(model).noise).screened([columns])
    for chosen in ([0], [1, 4], [0, 2, 3]):
        found = gains(*screened.take(np.array(chosen)), SCALES)
        refit = [fit(model.with_columns([s * columns[..., chosen]])).log_evidence for s in SCALES]
        np.testing.assert_allclose(found, np.array(refit) - fit(model).log_evidence, atol=1e-9)


def test_gain_beside_an_accepted_column_is_conditional_on_it():
    model = campaign(4, given=1.0)
    columns = candidates(model, 2)
    accepted = model.with_columns([columns[..., :1]])
    screened = Screen.of(accepted, fit(model).noise).screened([columns[..., 1:]])
    both = fit(model.with_columns([columns])).log_evidence - fit(accepted).log_evidence
    assert gains(screened.gram, screened.score, np.ones(1))[0] == pytest.approx(both, abs=1e-9)


@pytest.mark.parametrize("chosen", [[0], [1, 4], [0, 2, 3]])
def test_one_sided_gain_is_that_of_the_one_sided_refit(chosen):
    model = campaign(5, given=2.0)
    columns = candidates(model, 5)
    sided = np.arange(model.parameters + len(chosen)) >= model.parameters
    screened = Screen.of(model, fit(model).noise).screened([columns])
    found = gains(*screened.take(np.array(chosen)), SCALES, np.ones(len(chosen), bool))
    refit = [fit(model.with_columns([s * columns[..., chosen]]), one_sided=sided).log_evidence for s in SCALES]
    np.testing.assert_allclose(found, np.array(refit) - fit(model).log_evidence, atol=1e-7)


def test_many_candidates_at_once_are_each_of_them_alone():
    model = campaign(6, outlier=8.0)
    screened = Screen.of(model, fit(model).noise).screened([candidates(model, 6)])
    pairs = np.array([[0, 1], [2, 5], [3, 4]])
    for sided in (None, np.array([True, False]), np.array([True, True])):
        together = gains(*screened.take(pairs), SCALES, sided)
        alone = [gains(*screened.take(pair), SCALES, sided) for pair in pairs]
        np.testing.assert_allclose(together, alone, atol=1e-12)


def test_both_signs_of_a_size_share_its_evidence():
    """Half of the prior lies on either side: E(z) = (E(z > 0) + E(z < 0))/2."""
    model = campaign(7, given=1.0)
    column = candidates(model, 1)
    sided = np.arange(model.parameters + 1) == model.parameters
    either = [fit(model.with_columns([sign * column]), one_sided=sided).log_evidence for sign in (1.0, -1.0)]
    assert summed(np.array(either)) == pytest.approx(fit(model.with_columns([column])).log_evidence, abs=1e-9)


def test_a_one_sided_size_that_looks_negative_stays_near_zero():
    """Data made with -3 prior sigmas of the column."""
    model = campaign(8, shape=(6, 5, 8, 2), given=1.0)
    column = candidates(model, 1)
    data = model.with_residual([model.stacks[0].r - 3.0 * column[..., 0]]).with_columns([column])
    free, sided = fit(data), fit(data, one_sided=np.array([False, False, True]))
    assert free.z_mean[2] < -2.0
    assert 0.0 < sided.z_mean[2] < 0.2
    assert sided.log_evidence < fit(model.with_residual([data.stacks[0].r])).log_evidence < free.log_evidence


def test_a_one_sided_posterior_is_that_of_drawing_and_rejecting():
    model = campaign(9, shape=(2, 2, 4, 3), given=1.0)
    free, sided = fit(model), fit(model, one_sided=np.array([True, False, True]))
    draws = np.random.default_rng(9).multivariate_normal(free.z_mean, free.z_covariance, 400_000)
    kept = draws[(draws[:, [0, 2]] > 0.0).all(axis=1)]
    np.testing.assert_allclose(sided.z_mean, kept.mean(axis=0), atol=0.02)  # drawn .005, propagated .01
    np.testing.assert_allclose(sided.z_covariance, np.cov(kept.T), atol=0.02)


def test_moments_of_a_tail_are_those_of_quadrature_and_meet_their_series():
    x, width = np.linspace(0.0, 60.0, 2_000_001, retstep=True)
    for ratio in (-20.0, -3.0, 0.0, 4.0):
        weight = np.exp(-0.5 * (x - ratio) ** 2 + 0.5 * min(ratio, 0.0) ** 2)
        weight[0] *= 0.5
        mean = (weight * x).sum() / weight.sum()
        variance = (weight * (x - mean) ** 2).sum() / weight.sum()
        log_probability = np.log(weight.sum() * width / np.sqrt(2.0 * np.pi)) - 0.5 * min(ratio, 0.0) ** 2
        found = [float(value) for value in tail_moments(ratio)]
        np.testing.assert_allclose(found, [log_probability, mean, variance], rtol=1e-6, atol=1e-9)
    near, far = tail_moments(-60.0 + 1e-9), tail_moments(-60.0 - 1e-9)
    np.testing.assert_allclose(near, far, rtol=1e-6)


@pytest.mark.parametrize("count", [2, 3, 6])
def test_several_one_sided_sizes_by_expectation_propagation(count):
    """Against the numerical normal integral of SciPy; measured .03 nats at most over 6 draws of 2 to 8 sizes."""
    rng = np.random.default_rng(count)
    factor = rng.normal(size=(count, count + 2))
    mean, covariance = 2.0 * rng.normal(size=count), factor @ factor.T
    exact = np.log(multivariate_normal.cdf(mean, np.zeros(count), covariance, rng=0))
    found = positive_part(mean, covariance)
    assert found.log_probability == pytest.approx(exact, abs=0.05)
    order = rng.permutation(count)
    other = positive_part(mean[order], covariance[np.ix_(order, order)])
    assert other.log_probability == pytest.approx(found.log_probability, abs=1e-7)
    np.testing.assert_allclose(other.mean, found.mean[order], atol=1e-6)
    draws = rng.multivariate_normal(mean, covariance, 400_000)
    inside = draws[(draws > 0.0).all(axis=1)]
    np.testing.assert_allclose(found.mean, inside.mean(axis=0), atol=0.05 * np.sqrt(np.diag(covariance)).max())


def test_probabilities_of_hypotheses_and_of_names():
    members = [(), ("a",), ("b",), ("a", "b")]
    probability = probabilities(np.array([0.0, 2.0, 1.0, 4.0]) - 1e4, np.array([0.0, -3.0, -3.0, -6.0]))
    expected = np.exp([0.0, -1.0, -2.0, -2.0])
    np.testing.assert_allclose(probability, expected / expected.sum())
    names = inclusion(members, probability)
    assert list(names) == ["a", "b"]
    assert names["a"] == pytest.approx(probability[1] + probability[3])


def test_alternatives_that_say_the_same_are_one():
    assert summed(np.full(7, -3.0)) == pytest.approx(-3.0)
    assert summed(np.array([-3.0, -np.inf]), np.log([0.25, 0.75])) == pytest.approx(-3.0 + np.log(0.25))


def test_nothing_possible_is_an_error():
    with pytest.raises(ValueError, match="finite for one hypothesis"):
        probabilities(np.array([-np.inf, -np.inf]), np.zeros(2))

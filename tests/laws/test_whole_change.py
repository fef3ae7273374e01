"""The whole change of a cause's parameters is the posterior of the sum of cause and tolerance."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.evidence import choices
from cdpr_struct.diagnosis.null_model import reading_count, tolerance_count
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.refit import refit
from cdpr_struct.diagnosis.whole_change import whole_change
from tests.laws.crime_campaign import hidden


@pytest.fixture(scope="module")
def ground():
    return prepare(hidden(lambda w: w.plus(cell_bias=9.0 * np.eye(w.cables)[2])), BUDGETS["small"]).ground


def fitted(ground, name, label):
    candidate = next(c for c in ground.candidates if c.name == name)
    return refit(ground, (next(c for c in choices(candidate) if c.pattern.label == label and c.scale == 1.0),))


def test_it_is_the_posterior_of_the_sum(ground):
    """Against the joint posterior of sizes and tolerances, with the noise that is left without these."""
    fit = fitted(ground, "load_cell_bias", "each its own")
    null, setting = fit.ground.null, fit.ground.setting
    first, count, m = reading_count(setting), tolerance_count(setting), len(fit.theta)
    tolerances = null.white(null.columns[:, first : first + count])
    noise = np.eye(len(null.r)) - tolerances @ tolerances.T
    both = np.hstack([fit.signature, -tolerances])
    precision = np.eye(m + count) + both.T @ np.linalg.solve(noise, both)
    z = fit.white + fit.signature @ fit.theta
    mean = np.linalg.solve(precision, both.T @ np.linalg.solve(noise, z))
    linear = fit.covariance @ fit.signature.T @ z
    fit = replace(fit, theta=linear, white=z - fit.signature @ linear)
    bias = slice(m + count - 2 * m, m + count - m)  # the last tolerances are those of load cells and pulleys
    share = setting.campaign.tolerances.load_cell_bias_N / fit.choices[0].prior[0]
    add = np.zeros((m, m + count))
    add[:, :m], add[:, bias] = np.eye(m), share * np.eye(m)
    theta, covariance = whole_change(fit)
    np.testing.assert_allclose(theta, add @ mean, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(covariance, add @ np.linalg.inv(precision) @ add.T, rtol=1e-6, atol=1e-12)


def test_it_is_known_better_than_the_cause_beside_its_tolerance(ground):
    fit = fitted(ground, "load_cell_gain", "each its own")
    _, covariance = whole_change(fit)
    assert np.all(np.diagonal(covariance) < 0.6 * np.diagonal(fit.covariance))


def test_of_cables_alike_the_mean_tolerance_counts(ground):
    fit = fitted(ground, "axial_stiffness", "all alike")
    theta, covariance = whole_change(fit)
    own = fitted(ground, "axial_stiffness", "each its own")
    mean = float((whole_change(own)[0] * own.choices[0].prior).mean())
    assert float(theta[0] * fit.choices[0].prior[0]) == pytest.approx(mean, abs=0.02)
    assert covariance.shape == (1, 1)


def test_a_cause_of_which_there_is_no_tolerance_stays_as_it_is(ground):
    fit = fitted(ground, "joint_compliance", "all alike")
    theta, covariance = whole_change(fit)
    np.testing.assert_array_equal(theta, fit.theta)
    np.testing.assert_allclose(covariance, fit.covariance, rtol=1e-12)

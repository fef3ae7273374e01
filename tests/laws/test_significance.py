"""Is anything wrong at all? The likelihood ratio of any law against the null."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter, Pattern
from cdpr_struct.diagnosis.detectable import FALSE_ALARMS, POWER, noncentrality
from cdpr_struct.diagnosis.evidence import Candidate
from cdpr_struct.diagnosis.significance import log_ratio

ROWS, DRAWS = 40, 40_000


def candidate(name: str, prior: float, seed: int, numbers: int = 1, positive: bool = False) -> Candidate:
    signature = np.random.default_rng(seed).standard_normal((ROWS, numbers))
    parameters = tuple(Parameter(f"{name}_{i}", "1", prior, positive=positive) for i in range(numbers))
    cause = Cause(name, name, parameters, lambda world, theta: world)
    return Candidate(cause, signature, [Pattern("", np.eye(numbers), parameters, 1.0)])


def draws(seed: int = 1, count: int = DRAWS) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal((ROWS, count))


@pytest.mark.parametrize("positive", [False, True])
def test_is_a_likelihood_ratio(positive):
    """Its mean under the null is one, for any mixture of laws."""
    laws = [candidate("a", 1.0, 2, positive=positive), candidate("b", 3.0, 3, numbers=4)]
    ratio = np.exp(log_ratio(laws, [candidate("c", 1.0, 4)], draws()))
    assert ratio.mean() == pytest.approx(1.0, abs=5.0 * ratio.std() / np.sqrt(DRAWS))


def test_does_not_depend_on_how_large_a_cause_is_expected_to_be():
    narrow, wide = ([candidate("a", prior, 2), candidate("b", 1.0, 3)] for prior in (1.0, 100.0))
    np.testing.assert_allclose(log_ratio(narrow, [], draws()), log_ratio(wide, [], draws()), rtol=1e-9)


def test_what_cannot_show_does_not_count():
    hidden = candidate("hidden", 1e-6, 3)
    alone, together = ([candidate("a", 1.0, 2), *more] for more in ([], [hidden]))
    np.testing.assert_array_equal(log_ratio(alone, [], draws()), log_ratio(together, [], draws()))
    assert not log_ratio([hidden], [], draws()).any()


def test_one_sided_causes_are_seen_on_their_side_only():
    """A residual that a positive size explains is minus its signature."""
    one_sided = candidate("a", 1.0, 2, positive=True)
    towards = -4.0 * one_sided.signature / np.linalg.norm(one_sided.signature)
    right, wrong = log_ratio([one_sided], [], np.hstack([towards, -towards]))
    both = log_ratio([candidate("a", 1.0, 2)], [], towards)[0]
    assert right == pytest.approx(both + np.log(2.0), abs=1e-3)
    assert wrong < -2.0


@pytest.mark.parametrize("numbers", [2, 3, 24])
def test_a_law_has_its_smallest_detectable_size_in_any_direction(numbers):
    """The mean over the sphere, one angle counts; its cosine has the density (1 - t^2)^((d - 3) / 2)."""
    law, z = candidate("a", 1.0, 2, numbers), 1.5 * draws(3, 1)
    basis, _ = np.linalg.qr(law.signature)
    size, seen = np.sqrt(noncentrality(numbers)), np.linalg.norm(basis.T @ z)
    angles = (np.arange(20_000) + 0.5) * np.pi / 20_000
    weight = np.sin(angles) ** (numbers - 2)
    expected = np.log((weight * np.exp(size * seen * np.cos(angles))).sum() / weight.sum()) - 0.5 * size**2
    assert log_ratio([law], [], z)[0] == pytest.approx(expected, abs=1e-6)


def test_a_single_number_has_two_directions():
    law, z = candidate("a", 1.0, 2), draws(3, 5)
    size, seen = np.sqrt(noncentrality(1)), (law.signature / np.linalg.norm(law.signature)).T @ z
    np.testing.assert_allclose(log_ratio([law], [], z), np.log(np.cosh(size * seen[0])) - 0.5 * size**2, atol=1e-9)


def test_the_smallest_detectable_size_is_found_with_its_power():
    limit = chi2.isf(FALSE_ALARMS, 6)
    shift = np.full((6, 1), np.sqrt(noncentrality(6) / 6.0))
    found = ((np.random.default_rng(6).standard_normal((6, DRAWS)) + shift) ** 2).sum(axis=0) > limit
    assert found.mean() == pytest.approx(POWER, abs=0.01)


@pytest.mark.parametrize("numbers", [1, 3, 24])
def test_no_size_is_too_large(numbers):
    """As large as a unit error makes it, and without a step where the Bessel function is scaled."""
    law = candidate("a", 1.0, 2, numbers)
    along = law.signature[:, :1] / np.linalg.norm(law.signature[:, 0])
    ratio = log_ratio([law], [], along * np.concatenate([np.linspace(0.0, 60.0, 6001), [1e4, 1e6]]))
    assert np.isfinite(ratio).all()
    assert (np.diff(ratio) > -1e-9).all()
    assert np.diff(ratio[:-2]).max() < 1.001 * np.sqrt(noncentrality(numbers)) * 0.01


def test_finds_what_is_just_detectable_more_often_than_chance():
    """Four sigmas along one of ten causes, at one false alarm in fifty: found in three cases of four or more."""
    laws = [candidate(f"cause_{k}", 1.0, k) for k in range(10)]
    limit = np.quantile(log_ratio(laws, [], draws()), 0.98)
    signature = laws[0].signature / np.linalg.norm(laws[0].signature)
    found = log_ratio(laws, [], draws(5, 4000) - 4.0 * signature) > limit
    assert 0.75 < found.mean() < 0.95  # known in advance, two-sided: 0.95
    doubled = [replace(law, signature=2.0 * law.signature) for law in laws]
    np.testing.assert_allclose(log_ratio(doubled, [], draws()), log_ratio(laws, [], draws()), rtol=1e-9)

"""Is anything wrong at all? The likelihood ratio of any law against the null."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter, Pattern
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


def test_finds_what_is_just_detectable_more_often_than_chance():
    """Four sigmas along one of ten causes, at one false alarm in fifty: found in three cases of four or more."""
    laws = [candidate(f"cause_{k}", 1.0, k) for k in range(10)]
    limit = np.quantile(log_ratio(laws, [], draws()), 0.98)
    signature = laws[0].signature / np.linalg.norm(laws[0].signature)
    found = log_ratio(laws, [], draws(5, 4000) - 4.0 * signature) > limit
    assert 0.75 < found.mean() < 0.95  # known in advance, two-sided: 0.95
    doubled = [replace(law, signature=2.0 * law.signature) for law in laws]
    np.testing.assert_allclose(log_ratio(doubled, [], draws()), log_ratio(laws, [], draws()), rtol=1e-9)

"""The study of ranks: true sizes are those of the true robot, and wrong intervals are seen."""

import numpy as np
import pytest

from benchmarks.posterior_ranks.drawing import CAUSES, drawn
from benchmarks.posterior_ranks.summary import faults, summary
from benchmarks.posterior_ranks.trying import posterior

NUMBER = {sized.cause: seed for seed, sized in enumerate(CAUSES)}


def told(ranks: np.ndarray) -> list[dict]:
    return [{"cause": "temperature", "rank": float(rank), "passed_over": 0} for rank in ranks]


@pytest.mark.parametrize("cause", ["unstrained_length_offset", "center_of_mass", "frame_anchor_position"])
def test_the_true_size_is_that_of_the_true_robot(cause):
    one = drawn(NUMBER[cause])
    field = np.asarray(one.case.truth["deviations"][cause]).reshape(-1, len(one.theta))
    row = int(one.label.split()[1]) - 1 if one.label else 0
    np.testing.assert_allclose(field[row], one.theta, rtol=1e-12)


def test_the_size_of_what_all_cables_share_is_their_mean():
    one = drawn(NUMBER["axial_stiffness"])
    field = np.asarray(one.case.truth["deviations"]["axial_stiffness"])
    np.testing.assert_allclose(field.mean(), one.theta[0], rtol=1e-12)
    assert np.ptp(field) > 0.0


def test_gravity_leans_as_the_diagnosis_says():
    one = drawn(NUMBER["gravity_tilt"])
    turned = one.case.truth["deviations"]["gravity_tilt"]
    np.testing.assert_allclose([-turned[1], turned[0]], one.theta, rtol=1e-12)


def test_a_size_is_found_and_another_one_excluded():
    one = drawn(NUMBER["platform_mass"])
    said = posterior(one)
    assert abs(one.theta[0] - said.mean[0]) < 4.0 * said.sigma[0]
    assert abs(0.5 * one.theta[0] - said.mean[0]) > 4.0 * said.sigma[0]


def test_intervals_that_are_too_narrow_are_seen():
    even = (np.arange(200) + 0.5) / 200
    assert list(faults(told(even))) == []
    assert list(faults(told(0.5 + 0.5 * np.sign(even - 0.5) * np.sqrt(np.abs(2.0 * even - 1.0))))) == ["temperature"]
    assert "| `temperature` | 200 | 100 / 180 / 198 |" in summary(told(even))

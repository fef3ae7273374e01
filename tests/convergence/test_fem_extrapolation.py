"""Does the extrapolation find an order it was given, and say so when there is none?"""

import numpy as np
import pytest

from cdpr_struct.fem_reference import extrapolate


@pytest.mark.parametrize("counts", [[10, 20, 40], [10, 15, 35], [8, 16, 32, 64]])
@pytest.mark.parametrize("order", [1.0, 2.0, 3.7])
def test_a_pure_power_is_recovered_for_any_refinement(counts, order):
    sizes = np.array(counts, dtype=float)
    values = np.array([5.0, -3.0]) + np.array([2.0, -0.7]) * sizes[:, None] ** -order
    result = extrapolate(counts, values)
    assert result.order == pytest.approx([order, order], abs=1e-6)
    assert result.limit == pytest.approx([5.0, -3.0], rel=1e-9)
    assert list(result.reason) == ["", ""]


def test_the_error_estimate_covers_the_error_of_a_mixed_power():
    counts = np.array([10, 20, 40, 80])
    values = 7.0 + 3.0 / counts**2.0 - 20.0 / counts**4.0
    result = extrapolate(counts, values)
    assert abs(result.limit - 7.0) <= result.error_estimate < 2e-4


def test_round_off_has_no_order_and_says_so():
    result = extrapolate([10, 20, 40], [1.0, 1.0 + 2e-16, 1.0 - 1e-16])
    assert np.isnan(result.order)
    assert result.reason == "noise floor"
    assert result.error_estimate > 0.0
    exact = extrapolate([10, 20, 40], [0.0, 0.0, 0.0])
    assert exact.reason == "noise floor"
    assert exact.limit == 0.0


def test_values_that_do_not_converge_say_so():
    assert extrapolate([10, 20, 40], [1.0, 2.0, 1.5]).reason == "not monotone"
    assert extrapolate([10, 20, 40], [1.0, 2.0, 4.0]).reason == "order out of range"
    assert extrapolate([10, 20, 40], [1.0, 2.0, 4.0]).error_estimate == 3.0


def test_arguments_are_checked():
    with pytest.raises(ValueError, match=r"at least three increasing counts, got \[10, 20\]"):
        extrapolate([10, 20], [1.0, 2.0])
    with pytest.raises(ValueError, match="at least three increasing counts"):
        extrapolate([10, 20, 20], [1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"one entry per mesh \(3\), got 2"):
        extrapolate([10, 20, 40], [1.0, 2.0])

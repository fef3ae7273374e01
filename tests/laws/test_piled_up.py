"""The chance of so many outliers of one sensor is that of the binomial distribution."""

import pytest
from scipy.stats import binom

from cdpr_struct.diagnosis.piled_up import _at_least


@pytest.mark.parametrize("successes", [0, 1, 3, 12])
def test_the_chance_of_so_many_or_more_is_binomial(successes):
    assert _at_least(successes, 12, 0.05) == pytest.approx(binom.sf(successes - 1, 12, 0.05), rel=1e-12)

"""Arrays of a linear model fit together to the last one, or are refused by name."""

import numpy as np
import pytest

from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.posterior import inclusion, probabilities, summed
from cdpr_struct.inference.scale_mixture import PADDING, UNIT, NoiseGroups, NoiseState
from cdpr_struct.inference.soft_rows import SoftExpectation
from tests.laws.inference_cases import campaign, changed

MODEL = campaign(1)  # 3 blocks, 4 rows, 6 readings, 3 parameters, 15 groups
TWO = np.zeros((1, 2))


def padded(A):
    index = MODEL.stacks[0].index.copy()
    index[2, 5] = PADDING
    return changed(MODEL, index=index, A=A)


REFUSED = {
    "A must be finite": lambda: changed(MODEL, A=np.where(MODEL.stacks[0].A > 1.0, np.inf, 0.0)),
    r"r \(4,\), A": lambda: changed(MODEL, r=np.zeros(4)),
    r"index \(3,\) do not fit together": lambda: changed(MODEL, index=np.zeros(3)),
    r"X \(3, 4\)": lambda: changed(MODEL, X=np.zeros((3, 4))),
    r"floor \(3, 3\)": lambda: changed(MODEL, floor=np.ones((3, 3))),
    r"index \(2, 6\) do not fit r": lambda: changed(MODEL, index=np.zeros((2, 6))),
    "floor must not be negative": lambda: changed(MODEL, floor=np.where(np.eye(3, 4) > 0.0, -1e-9, 1.0)),
    r"different rows, got \[1, 1\]": lambda: changed(MODEL, soft=[1, 1]),
    r"different rows, got \[\[1\]\]": lambda: changed(MODEL, soft=[[1]]),
    r"within 0 and 3, got \[-1\]": lambda: changed(MODEL, soft=[-1]),
    r"within 0 and 3, got \[0, 4\]": lambda: changed(MODEL, soft=[0, 4]),
    "A must be zero for readings of index -1": lambda: padded(MODEL.stacks[0].A),
    "index of readings must lie within -2 and 14": lambda: changed(MODEL, index=np.full((3, 6), UNIT - 1)),
    "within -2 and 14": lambda: changed(MODEL, index=np.full((3, 6), 15)),
    r"needs kind \(G,\)": lambda: NoiseGroups(np.zeros((2, 2)), np.zeros((2, 2))),
    r"got \(2,\), \(3,\)": lambda: NoiseGroups(np.zeros(2), np.ones(3)),
    "kind must not be negative": lambda: NoiseGroups([0, -1], [np.nan, np.nan]),
    "fixed_variance must be positive": lambda: NoiseGroups([0, 1], [0.0, np.nan]),
    "must be positive or nan": lambda: NoiseGroups([0, 1], [np.inf, 1.0]),
    r"tau \(3,\) do not fit": lambda: NoiseState.of(MODEL.groups, np.ones((15, 5)), np.ones(3)),
    r"responsibility \(15, 4\)": lambda: NoiseState.of(MODEL.groups, np.ones((15, 4)), np.ones(2)),
    r"must both be \(K, s\)": lambda: SoftExpectation(np.zeros((1, 2)), np.zeros((1, 3)), 0.0),
    r"value \(2,\)": lambda: SoftExpectation(np.zeros(2), np.zeros(2), 0.0),
    "precisions that are not negative": lambda: SoftExpectation(TWO, np.array([[1.0, -1e-9]]), 0.0),
    "finite precisions": lambda: SoftExpectation(TWO, np.array([[1.0, np.inf]]), 0.0),
    "needs finite values": lambda: SoftExpectation(np.array([[np.nan, 0.0]]), TWO, 0.0),
    "one entry for each of 3": lambda: fit(MODEL, one_sided=np.ones(2, bool)),
    "2 hypotheses, but 3": lambda: inclusion([(), ("a",)], np.ones(3)),
    "never nan": lambda: probabilities(np.array([0.0, np.nan]), np.zeros(2)),
    "finite for one hypothesis": lambda: probabilities(np.array([[0.0, 1.0], [-np.inf, -np.inf]]), np.zeros(2)),
}


@pytest.mark.parametrize(("message", "make"), REFUSED.items(), ids=REFUSED)
def test_what_does_not_fit_together_is_refused(message, make):
    with pytest.raises(ValueError, match=message):
        make()


def test_what_just_fits_together_is_taken():
    assert changed(MODEL, soft=[0, 3]).stacks[0].hard.tolist() == [False, True, True, False]
    changed(MODEL, index=np.full((3, 6), UNIT))
    changed(MODEL, index=np.full((3, 6), 14))
    A = MODEL.stacks[0].A.copy()
    A[2, :, 5] = 0.0
    padded(A)
    nothing = SoftExpectation.none(3, 2)
    assert (nothing.value.shape, nothing.precision.any(), nothing.constant) == ((3, 2), np.False_, 0.0)


def test_padding_has_no_variance_and_noise_of_no_group_has_one():
    index = MODEL.stacks[0].index.copy()
    index[0, :2] = PADDING, UNIT
    A = MODEL.stacks[0].A.copy()
    A[0, :, 0] = 0.0
    (found,) = changed(MODEL, index=index, A=A).readings.spread(np.arange(15.0) + 3.0)
    assert found[0, :3].tolist() == [0.0, 1.0, index[0, 2] + 3.0]


def test_hypotheses_in_rows_have_probabilities_in_rows():
    """Along the last axis; names come with the most probable first."""
    log_evidence, weight = np.log([[1.0, 3.0], [4.0, 1.0]]), np.log([2.0, 6.0])
    np.testing.assert_allclose(probabilities(log_evidence, np.zeros(2)), [[0.25, 0.75], [0.8, 0.2]])
    np.testing.assert_allclose(summed(log_evidence, weight), np.log([2.5, 1.75]))
    names = inclusion([("a",), ("b",), ("a", "b")], np.array([0.1, 0.6, 0.3]))
    assert list(names.items()) == [("b", pytest.approx(0.9)), ("a", pytest.approx(0.4))]

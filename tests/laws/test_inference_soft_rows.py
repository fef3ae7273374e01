"""Rows that are a mixture: a certain one is a Gaussian reading, an uncertain one a sum over its labels."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.special import logsumexp, xlogy

from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.soft_rows import SoftExpectation
from tests.laws.inference_cases import NO_ROWS, campaign, changed, dense_log_density

SIGMA = 0.3


@dataclass(frozen=True)
class LabelledPeaks:
    """Each block: one peak (K,), which belongs to one of the soft rows, with equal prior."""

    peak: np.ndarray

    def expect(self, mean: np.ndarray, variance: np.ndarray) -> SoftExpectation:
        square = (self.peak[:, None] - mean) ** 2 + variance
        logit = -0.5 * square / SIGMA**2
        share = np.exp(logit - logsumexp(logit, axis=1, keepdims=True))
        constant = -np.log(mean.shape[1] * SIGMA * np.sqrt(2.0 * np.pi)) * len(mean) - xlogy(share, share).sum()
        return SoftExpectation(np.broadcast_to(self.peak[:, None], mean.shape), share / SIGMA**2, constant)


def labelled_evidence(model, peak, labels):
    """Dense evidence if the peak of block k is the soft row labels[k]."""
    stack = model.stacks[0]
    read = stack.soft[np.array(labels)]
    hard = np.flatnonzero(stack.hard)
    rows = np.concatenate((np.broadcast_to(hard, (len(peak), len(hard))), read[:, None]), axis=1)
    r, floor = np.take_along_axis(stack.r, rows, 1), np.take_along_axis(stack.floor, rows, 1)
    r[:, -1], floor[:, -1] = peak, SIGMA
    A, X = (np.take_along_axis(values, rows[..., None], 1) for values in (stack.A, stack.X))
    dense = changed(model, r=r, A=A, X=X, floor=floor, soft=NO_ROWS)
    variance = model.groups.fixed_variance

    def normaliser(model):
        part = model.stacks[0]
        noise = part.A @ part.A.swapaxes(1, 2) + np.eye(part.r.shape[1]) * part.floor[:, None] ** 2
        return 0.5 * np.linalg.slogdet(noise)[1].sum()

    only_hard = changed(dense, r=r[:, :-1], A=A[:, :-1], X=X[:, :-1], floor=floor[:, :-1])
    return dense_log_density(dense, variance) - normaliser(dense) + normaliser(only_hard)


def test_a_peak_with_one_label_is_a_gaussian_reading():
    model, peak = campaign(1, given=2.0, soft=1), np.array([0.5, -1.0, 2.0])
    found = fit(model, soft=LabelledPeaks(peak))
    assert found.log_evidence == pytest.approx(labelled_evidence(model, peak, [0, 0, 0]), abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_a_peak_with_two_labels_is_bounded_by_the_sum_over_them(seed):
    model, peak = campaign(seed, given=1.0, soft=2), np.array([0.5, -1.0, 2.0])
    labels = np.stack(np.meshgrid(*[[0, 1]] * 3), axis=-1).reshape(-1, 3)
    exact = logsumexp([labelled_evidence(model, peak, label) for label in labels]) - 3 * np.log(2.0)
    found = fit(model, soft=LabelledPeaks(peak))
    assert 0.0 <= exact - found.log_evidence < 1.5  # one set of labels at most is lost, ln 8 at worst
    assert (np.diff(found.bounds) > -1e-9).all()


def test_predictions_are_those_of_the_posterior():
    """With nothing read in soft rows: mean and variance of A u + X z by the dense formula."""
    model = campaign(2, shape=(1, 4, 6, 3), given=1.0, soft=2)
    found = fit(model)
    rows = np.hstack((model.stacks[0].A[0], model.stacks[0].X[0]))
    hard, soft = rows[:4], rows[4:]
    gain = soft @ hard.T @ np.linalg.inv(hard @ hard.T + 0.1**2 * np.eye(4))
    np.testing.assert_allclose(found.soft_mean[0], gain @ model.stacks[0].r[0, :4], atol=1e-10)
    np.testing.assert_allclose(found.soft_variance[0], np.diag(soft @ soft.T - gain @ hard @ soft.T), atol=1e-10)


def test_given_responsibilities_start_the_fit_and_a_row_of_no_precision_is_not_read():
    model = campaign(3, given=1.0, soft=2)
    nothing = SoftExpectation.none(3, 2)
    assert fit(model, soft_start=nothing).log_evidence == pytest.approx(fit(model).log_evidence, abs=1e-12)
    peaks = LabelledPeaks(np.array([0.5, -1.0, 2.0]))
    first = fit(model, soft=peaks)
    again = fit(model, soft=peaks, soft_start=first.soft)
    assert again.log_evidence >= first.log_evidence - 1e-9
    assert again.iterations == 2

"""Peaks as soft readings of modes: one pseudo-reading per mode, and what the lists add to the log evidence.

With the assignment held, the exponent of every peak is quadratic in the ln f of its modes. So the peaks act as one
reading per mode, of precision w = sum_j r_j / (tau kappa s_j)^2 and value sum_j r_j ln f_j / (tau kappa s_j)^2 / w. For
modes that are N(m, v) when the assignment is made,

    constant = ln Z(m, v) + sum_mu w ((value - m)^2 + v) / 2  +  noise after minus noise before its update

makes  ln integral prior exp(-sum_mu w (value - ln f)^2 / 2) + constant  a lower bound of the log evidence; Z is the
likelihood of the lists summed over assignments.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import expit, xlogy

from cdpr_struct.association.belief_propagation import neighbours
from cdpr_struct.association.detection import Clutter
from cdpr_struct.association.matching import Matching
from cdpr_struct.association.modes import PredictedModes, allowed_pairs
from cdpr_struct.association.one_to_one import one_to_one_matching
from cdpr_struct.association.pair_density import PairDensity, pair_density
from cdpr_struct.association.peak_noise import SCALES, PeakNoise, ScaleCounts, stated_noise
from cdpr_struct.association.peaks import KINDS, PeakLists
from cdpr_struct.association.poisson_process import poisson_matching
from cdpr_struct.inference.soft_rows import SoftExpectation

Rule = Literal["one_to_one", "exact", "poisson"]


@dataclass(frozen=True, slots=True, eq=False)
class Assignment:
    """The last matching of an association.

    matching : which peak is which mode, if the list is of its state
    own_state (L,) : probability that the list is of the state it is filed under
    number (L, 4) : expected number of assigned peaks on each scale of error, wrong lists allowed for
    pull (L, J, M) : expected 1 / (kappa s)^2 of each pair, tau apart, wrong lists allowed for
    """

    matching: Matching
    own_state: np.ndarray
    number: np.ndarray
    pull: np.ndarray


class Association:
    """Lists of peaks as the soft rows of an inference.

    Each call of `expect` updates the noise, so that the bound of a fit never falls. The object carries that state:
    `noise` and `assignment`; `at` gives an independent copy, for other modes or another start.
    """

    def __init__(
        self,
        peaks: PeakLists,
        modes: PredictedModes,
        clutter: Clutter,
        noise: PeakNoise | None = None,
        shape_factor: np.ndarray | None = None,
        wrong_state: float = 0.0,
        rule: Rule = "one_to_one",
    ) -> None:
        """Peaks, the modes they may belong to, and what is known of their noise.

        Parameters
        ----------
        shape_factor : (L, J, M) ln of how much better the measured shape fits the mode than it fits clutter [nats]; 0
            where no shape was measured.
        wrong_state : prior probability that a whole list is of another pose; 0 in the first steps of a fit at least:
            it may swallow a large but true shift of a harmonic series.
        rule : how the sum over assignments is taken; `exact` is one_to_one with small blocks summed exactly.
        """
        self.peaks, self.modes, self.clutter = peaks, modes, clutter
        self.noise = stated_noise() if noise is None else noise
        self.wrong_state, self.rule = wrong_state, rule
        self.assignment: Assignment | None = None
        self._shape_factor = shape_factor
        pair = allowed_pairs(peaks, modes).astype(float)
        self._pair = pair if shape_factor is None else pair * np.exp(shape_factor)
        self._slots = neighbours(modes.ln_frequency[peaks.state], modes.detection > 0.0)

    def at(
        self,
        modes: PredictedModes | None = None,
        noise: PeakNoise | None = None,
        shape_factor: np.ndarray | None = None,
        wrong_state: float | None = None,
        rule: Rule | None = None,
    ) -> "Association":
        """A copy with its own state, at other modes, another noise, another prior of wrong lists or by another rule."""
        return Association(
            self.peaks,
            self.modes if modes is None else modes,
            self.clutter,
            self.noise if noise is None else noise,
            self._shape_factor if modes is None and shape_factor is None else shape_factor,
            self.wrong_state if wrong_state is None else wrong_state,
            self.rule if rule is None else rule,
        )

    def expect(self, mean: np.ndarray, variance: np.ndarray, predictive: bool | None = None) -> SoftExpectation:
        """Pseudo-readings at the best assignment for modes ln f ~ N(ln_frequency + mean, variance).

        Parameters
        ----------
        mean, variance : (K, M), mean relative to `modes.ln_frequency` [-].
        predictive : weigh pairs by the predictive density, see `pair_density`; by default in the first call only. To
            start a fit from the assignment of another, call this with its `soft_mean` and `soft_variance` and False,
            and hand the answer to the fit.
        """
        predictive = self.assignment is None if predictive is None else predictive
        state = self.peaks.state
        located = (self.modes.ln_frequency + mean)[state]
        density = pair_density(self.peaks, self.noise, located, variance[state], predictive)
        constant = self._assign(density)
        value, precision = self._pseudo_readings()
        constant += 0.5 * float((precision * ((value - mean) ** 2 + variance)).sum())
        return SoftExpectation(value, precision, constant)

    def _assign(self, density: PairDensity) -> float:
        """Updates assignment and noise; returns the expected log likelihood plus entropies after it [nats]."""
        matching = self._matching(density.total * self._pair)
        own = self._own_state(matching)
        share = matching.pair * own[:, None, None] / np.where(density.total > 0.0, density.total, 1.0)
        number = np.einsum("cljm,ljm->lc", density.by_scale, share)
        pull = np.einsum("c,cljm->ljm", SCALES**-2.0, density.by_scale) * share * self.peaks.sd[:, :, None] ** -2.0
        self.assignment = Assignment(matching, own, number, pull)
        counts = self._scale_counts(number, (pull * density.square).sum(axis=(1, 2)))
        before, self.noise = self.noise, self.noise.updated(counts)
        bound = self._lists_log_likelihood(matching, own) + self.noise.bound(counts) - before.expected_log(counts)
        if density.correction is not None:
            bound += float((density.by_scale * share * density.correction).sum())
        return bound

    def _matching(self, density: np.ndarray) -> Matching:
        detection, exact = self.modes.detection, self.rule == "exact"
        if self.rule == "poisson":
            return poisson_matching(density, detection, self.clutter, self.peaks)
        return one_to_one_matching(density, detection, self.clutter, self.peaks, self._slots, exact)

    def _own_state(self, matching: Matching) -> np.ndarray:
        """(L,) probability that each list is of the state it is filed under."""
        if self.wrong_state == 0.0:
            return np.ones(len(self.peaks.state))
        prior = np.log1p(-self.wrong_state) - np.log(self.wrong_state)
        return expit(matching.log_likelihood - self._elsewhere() + prior)

    def _elsewhere(self) -> np.ndarray:
        """(L,) log likelihood of a list that is of another pose: as many peaks as expected, anywhere in the band."""
        expected = self.modes.detection.sum(axis=1) + self.clutter.expected
        return self.peaks.count * np.log(expected / self.peaks.bandwidth) - expected

    def _lists_log_likelihood(self, matching: Matching, own: np.ndarray) -> float:
        """Bound of ln L of all lists at the noise and modes of the matching [nats]."""
        right = matching.log_likelihood
        if self.wrong_state == 0.0:
            return float(right.sum())
        mixed = own * (right + np.log1p(-self.wrong_state)) + (1.0 - own) * (
            self._elsewhere() + np.log(self.wrong_state)
        )
        return float((mixed - xlogy(own, own) - xlogy(1.0 - own, 1.0 - own)).sum())

    def _scale_counts(self, number: np.ndarray, square: np.ndarray) -> ScaleCounts:
        """Sums over the lists of each kind of their numbers (L, 4) and squares (L,)."""
        assigned = number.sum(axis=1)
        everything = number + (self.peaks.count - assigned)[:, None] * self.noise.weight[self.peaks.kind]
        by_kind = (self.peaks.kind == np.arange(len(KINDS))[:, None]).astype(float)  # (n, L)
        return ScaleCounts(by_kind @ everything, by_kind @ assigned, by_kind @ square)

    def _pseudo_readings(self) -> tuple[np.ndarray, np.ndarray]:
        """Value, relative to `modes.ln_frequency`, and precision of each mode, both (K, M)."""
        state, modes = self.peaks.state, self.modes.ln_frequency
        precision, moment = np.zeros((2, *modes.shape))
        if self.assignment is not None:
            pull = self.assignment.pull * self.noise.tau[self.peaks.kind][:, None, None] ** -2.0
            offset = self.peaks.ln_frequency[:, :, None] - modes[state][:, None, :]
            np.add.at(precision, state, pull.sum(axis=1))
            np.add.at(moment, state, (pull * offset).sum(axis=1))
        return np.where(precision > 0.0, moment / np.where(precision > 0.0, precision, 1.0), 0.0), precision

"""How probable are the data under a linear model whose noise may hold outliers?

Variational Bayes: u and z are jointly Gaussian, the scales independent of them. Gaussian and scales are improved in
turn; each step raises a lower bound of the log evidence, and the bound is the evidence reported. Derivation: Bishop,
Pattern Recognition and Machine Learning, section 10.1.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.joint_posterior import JointPosterior
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.marginal_scales import first_noise
from cdpr_struct.inference.scale_mixture import NoiseState, mixture_bound, updated_noise
from cdpr_struct.inference.soft_rows import SoftExpectation, SoftRows
from cdpr_struct.inference.white_rows import WhiteRows

# Steps at most, and the change of the bound [nat] at which they stop: far below the 3 nats of a decision.
MAX_STEPS = 40
SETTLED = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """What the data say under one hypothesis.

    log_evidence   : lower bound of the log evidence [nat], rows white at stated sigmas
    z_mean         : (t,) parameters in prior sigmas
    z_covariance   : (t, t)
    noise_mean     : (K, q) errors of the readings in stated sigmas
    noise_variance : (K, q)
    noise          : scales of the noise
    soft           : the mixture of the soft rows at its last responsibilities; None without soft rows
    soft_mean      : (K, s) predictions of the soft rows
    soft_variance  : (K, s)
    bounds         : the bound after each step
    converged      : whether the bound settled
    """

    log_evidence: float
    z_mean: np.ndarray
    z_covariance: np.ndarray
    noise_mean: np.ndarray
    noise_variance: np.ndarray
    noise: NoiseState
    soft: SoftExpectation | None
    soft_mean: np.ndarray
    soft_variance: np.ndarray
    bounds: tuple[float, ...]
    converged: bool

    @property
    def iterations(self) -> int:
        """Number of steps."""
        return len(self.bounds)


def fit(
    model: LinearModel,
    start: NoiseState | None = None,
    soft: SoftRows | None = None,
    soft_start: SoftExpectation | None = None,
    one_sided: np.ndarray | None = None,
) -> Fit:
    """Evidence and posterior of a linear model.

    Parameters
    ----------
    start : scales to begin with; without it, those of `first_noise`. Different starts may end in different maxima of
        the bound; the highest is the best answer.
    soft : readings of the soft rows; without it, these rows are not read.
    soft_start : responsibilities to begin with; without it, those at the prediction from the hard rows.
    one_sided : (t,) mask of parameters that cannot be negative; their prior is the positive half of N(0, 1). The
        posterior is truncated accordingly (several such parameters: by expectation propagation).
    """
    rows, groups = WhiteRows.of(model), model.groups
    sided = np.flatnonzero(np.zeros(model.parameters, bool) if one_sided is None else one_sided)
    if one_sided is not None and len(one_sided) != model.parameters:
        raise ValueError(f"one_sided needs one entry for each of {model.parameters} parameters, got {len(one_sided)}")
    noise = first_noise(rows, groups, soft_start, sided) if start is None else start
    mixture = soft_start
    if soft is not None and mixture is None:
        joint = JointPosterior.of(rows, groups.spread(noise.variance), None, sided)
        mixture = soft.expect(joint.soft_mean, joint.soft_variance)
    bounds: list[float] = []
    while True:
        joint = JointPosterior.of(rows, groups.spread(noise.variance), mixture, sided)
        bounds.append(joint.parameters.log_evidence + mixture_bound(groups, noise))
        bounds[-1] += 0.0 if mixture is None else mixture.constant
        converged = len(bounds) > 1 and abs(bounds[-1] - bounds[-2]) < SETTLED
        if converged or len(bounds) == MAX_STEPS:
            return _answer(joint, noise, mixture, tuple(bounds), converged)
        noise = updated_noise(groups, noise, groups.sums(joint.noise_mean**2 + joint.noise_variance))
        if soft is not None:
            mixture = soft.expect(joint.soft_mean, joint.soft_variance)


def _answer(
    joint: JointPosterior,
    noise: NoiseState,
    mixture: SoftExpectation | None,
    bounds: tuple[float, ...],
    converged: bool,
) -> Fit:
    return Fit(
        bounds[-1],
        joint.parameters.mean,
        joint.parameters.covariance,
        joint.noise_mean,
        joint.noise_variance,
        noise,
        mixture,
        joint.soft_mean,
        joint.soft_variance,
        bounds,
        converged,
    )

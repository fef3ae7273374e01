"""How probable are the data under a linear model whose noise may hold outliers?

Variational Bayes: u and z are jointly Gaussian, the scales independent of them. Gaussian and scales are improved in
turn; each step raises a lower bound of the log evidence, and the bound is the evidence reported. Derivation: Bishop,
Pattern Recognition and Machine Learning, section 10.1. Where steps shrink slowly, one leaps to where they lead, and is
taken back if the bound falls.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.extrapolation import extrapolated
from cdpr_struct.inference.joint_posterior import JointPosterior, Marginal, ParameterPosterior
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.marginal_scales import first_noise
from cdpr_struct.inference.scale_mixture import GroupedReadings, NoiseState, mixture_bound, updated_noise
from cdpr_struct.inference.soft_rows import SoftExpectation, SoftRows

# Steps at most, and the change of the bound [nat] at which they stop: far below the 3 nats of a decision.
MAX_STEPS = 40
SETTLED = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """What the data say under one hypothesis.

    log_evidence   : lower bound of the log evidence [nat], rows white at stated sigmas
    z_mean         : (t,) parameters in prior sigmas
    z_covariance   : (t, t)
    noise_mean     : (K, q) a stack, errors of the readings in stated sigmas
    noise_variance : (K, q) a stack
    noise          : scales of the noise
    soft           : the mixture of the soft rows at its last responsibilities; None without soft rows
    soft_mean      : (K, s) predictions of the soft rows; (0, 0) without any
    soft_variance  : (K, s)
    bounds         : the bound after each step
    converged      : whether the bound settled
    """

    log_evidence: float
    z_mean: np.ndarray
    z_covariance: np.ndarray
    noise_mean: tuple[np.ndarray, ...]
    noise_variance: tuple[np.ndarray, ...]
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
    most_steps: int = MAX_STEPS,
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
    most_steps : number of bounds at most; leaps that are taken back do not count.
    """
    readings, sided = model.readings, _sided(model, one_sided)
    noise = first_noise(model.white, readings, soft_start, sided) if start is None else start
    mixture = soft_start
    if soft is not None and mixture is None:
        joint = JointPosterior.of(model.white, readings.spread(noise.variance), None, sided)
        mixture = soft.expect(joint.soft_mean, joint.soft_variance)
    point = _Point.at(model, noise, mixture, sided)
    bounds, squares, converged = [point.bound], [point.square], False
    while not converged and len(bounds) < most_steps:
        if soft is not None:
            mixture = soft.expect(point.joint.soft_mean, point.joint.soft_variance)
        far = extrapolated(squares, readings.inferred)
        ahead = None
        if far is not None:
            squares.clear()
            ahead = _leap(model, updated_noise(readings, point.noise, far), mixture, sided)
        if ahead is None or not ahead.bound >= point.bound:
            ahead = _Point.at(model, updated_noise(readings, point.noise, point.square), mixture, sided)
        converged = abs(ahead.bound - point.bound) < SETTLED
        point = ahead
        bounds.append(point.bound)
        squares.append(point.square)
    return _answer(point, tuple(bounds), converged)


def _leap(model: LinearModel, noise: NoiseState, mixture: SoftExpectation | None, sided: np.ndarray) -> "_Point | None":
    """The point at extrapolated sizes of the noise; None where these are so large that nothing can be computed.

    A variance of the noise is a difference: far beyond what the data say of it, rounding makes it negative.
    """
    try:
        ahead = _Point.at(model, noise, mixture, sided)
    except np.linalg.LinAlgError:
        return None
    return ahead if (ahead.square >= 0.0).all() else None


@dataclass(frozen=True, slots=True, eq=False)
class _Point:
    """The Gaussian posterior and the bound [nat] at scales and responsibilities, and E |u_g|^2 (G,) of each group."""

    noise: NoiseState
    mixture: SoftExpectation | None
    joint: JointPosterior
    bound: float
    square: np.ndarray

    @classmethod
    def at(cls, model: LinearModel, noise: NoiseState, mixture: SoftExpectation | None, sided: np.ndarray) -> "_Point":
        joint = JointPosterior.of(model.white, model.readings.spread(noise.variance), mixture, sided)
        square = [mean**2 + variance for mean, variance in zip(joint.noise_mean, joint.noise_variance, strict=True)]
        bound = _bound(model.readings, joint.parameters, noise, mixture)
        return cls(noise, mixture, joint, bound, model.readings.sums(square))


def bound_at(
    model: LinearModel,
    noise: NoiseState,
    soft: SoftExpectation | None = None,
    one_sided: np.ndarray | None = None,
) -> float:
    """Lower bound of the log evidence at given scales and responsibilities of soft rows [nat]: `fit` without steps."""
    rows, readings = model.white, model.readings
    marginal = Marginal.of(rows, readings.spread(noise.variance), soft)
    return _bound(readings, ParameterPosterior.of(marginal, rows.rows, _sided(model, one_sided)), noise, soft)


def _sided(model: LinearModel, one_sided: np.ndarray | None) -> np.ndarray:
    """Positions of one-sided parameters."""
    if one_sided is not None and len(one_sided) != model.parameters:
        raise ValueError(f"one_sided needs one entry for each of {model.parameters} parameters, got {len(one_sided)}")
    return np.flatnonzero(np.zeros(model.parameters, bool) if one_sided is None else one_sided)


def _bound(
    readings: GroupedReadings, parameters: ParameterPosterior, noise: NoiseState, mixture: SoftExpectation | None
) -> float:
    constant = 0.0 if mixture is None else mixture.constant
    return parameters.log_evidence + mixture_bound(readings, noise) + constant


def _answer(point: _Point, bounds: tuple[float, ...], converged: bool) -> Fit:
    joint = point.joint
    return Fit(
        bounds[-1],
        joint.parameters.mean,
        joint.parameters.covariance,
        joint.noise_mean,
        joint.noise_variance,
        point.noise,
        point.mixture,
        joint.soft_mean,
        joint.soft_variance,
        bounds,
        converged,
    )

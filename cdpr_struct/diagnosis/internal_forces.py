"""Does the robot hold the internal forces that the simulation commands?

Measured less simulated tensions are split at each state into internal force, which does no work on the platform, and
the rest, which has to balance. Where encoders were read, lengths and forces each say whether a controller follows the
simulation: one that holds lengths has its encoders at the simulated ones for some pose nearby, whatever the robot is
really like; one that holds forces has the simulated tensions. The robot holds other internal forces only if neither is
so, in more states than a fifth that are left out: those that contradict most.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.diagnosis.sensor_sigmas import NoiseOfKind
from cdpr_struct.hypotheses.causes.internal_force import PRIOR
from cdpr_struct.hypotheses.detectable import NAMED
from cdpr_struct.hypotheses.drift import ENCODERS, Drift
from cdpr_struct.hypotheses.hypothesis import PRICE, SCALES
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.observation.motion import moving
from cdpr_struct.observation.readings import cell_reading, true_tension
from cdpr_struct.observation.rest import at_states
from cdpr_struct.residuals.commanded_lengths import SIGMA, aligned, commanded_at, null_space
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

_LEAST = 3  # states: of fewer, one that is left out leaves nothing to confirm
_LEFT_OUT = 0.2  # share of the states that contradict the simulation most, which alone are no finding
_MODEL = 0.02  # of the mean tension: what straight cables and those that hang differ in their internal force
_MEANT, _TURNS = 1e-4, 8  # m, rad: so well is the commanded pose found, in so many steps at most


@dataclass(frozen=True, slots=True, eq=False)
class ForceSplit:
    """Measured less simulated tensions of K static states, those of them that were read in every cable.

    state (K,) which of the campaign's;  off (K, m) [N];  internal (K, m) the part of it that is internal force [N]
    """

    state: np.ndarray
    off: np.ndarray
    internal: np.ndarray

    @property
    def rms(self) -> np.ndarray:
        """(K,) root mean square over the cables [N]."""
        return np.sqrt((self.off**2).mean(axis=1))

    @property
    def internal_rms(self) -> np.ndarray:
        """(K,) that of the internal force [N]."""
        return np.sqrt((self.internal**2).mean(axis=1))

    @property
    def share(self) -> np.ndarray:
        """(K,) of the square, 0 to 1, that is internal force; the rest has to balance."""
        return self.internal_rms**2 / np.maximum(self.rms**2, 1e-300)


@dataclass(frozen=True, slots=True, eq=False)
class InternalForces:
    """Where forces and simulation part, and whether more than lengths and tolerances explain.

    gain : log evidence of other internal forces than the simulation commands [nat], None where nothing says so
    size : their rms over the states [N]
    """

    split: ForceSplit
    gain: float | None
    size: float

    @property
    def found(self) -> bool:
        """Whether the robot holds other internal forces, beside everything else."""
        return self.gain is not None and self.gain > NAMED

    @property
    def probability(self) -> float:
        """Of that."""
        return 0.0 if self.gain is None else float(1.0 / (1.0 + np.exp(PRICE - self.gain)))

    @property
    def p(self) -> float:
        """Bound on the chance of so much evidence if nothing were wrong: one over the Bayes factor (Markov)."""
        return 1.0 if self.gain is None else min(1.0, float(np.exp(-self.gain)))


def internal_forces(
    data: Recorded, where: Layout, found: Judged, noise: Sequence[NoiseOfKind]
) -> InternalForces | None:
    """Of a campaign and the fit that is believed; None without tensions of a redundant robot."""
    split = force_split(data)
    if split is None:
        return None
    factor = {one.kind: max(1.0, one.factor) for one in noise}
    lengths, state = _by_lengths(_without_drift(data, found), factor.get("length", 1.0))
    if len(state) < _LEAST:
        return InternalForces(split, None, 0.0)
    forces = _by_forces(data, where, found, state, factor.get("tension", 1.0))
    gain = min(lengths.gain, forces.gain)
    return InternalForces(split, gain, float(np.sqrt((forces.value**2).sum(axis=1).mean())))


def force_split(data: Recorded) -> ForceSplit | None:
    """None where no state at rest with all tensions has internal force."""
    states, campaign = data.campaign.states, data.campaign
    index = np.flatnonzero(states.static & np.isfinite(states.tension).all(axis=1) & ~moving(data.known.rate))
    if data.cables <= 6 or not len(index):
        return None
    off = states.tension[index] - simulated_tensions(data)[index]
    place, turn = data.readings.position[index], data.readings.rotation[index]
    null = np.array([null_space(campaign.robot, *pose) for pose in zip(place, turn, strict=True)])
    return ForceSplit(index, off, (null @ (np.swapaxes(null, 1, 2) @ off[..., None]))[..., 0])


def simulated_tensions(data: Recorded) -> np.ndarray:
    """(S, m) what load cells would read of the simulation's tension distribution [N]."""
    return cell_reading(data.arrays, _distribution(data).tensions, data.known.approach, data.known.wrap)


def _distribution(data: Recorded) -> InverseSolution:
    """The simulation's tension distribution at the poses of all states."""
    there, readings, bound = at_states(data.arrays, data.known), data.readings, data.campaign.lower_bound
    return inverse(there, readings.position, readings.rotation, data.known.model, lower_bound=bound, allow_unheld=True)


@dataclass(frozen=True, slots=True, eq=False)
class _Deviation:
    """Internal force (K, q) beyond what a controller would hold [N], and its covariance (K, q, q)."""

    value: np.ndarray
    covariance: np.ndarray

    @property
    def gain(self) -> float:
        """Log evidence against none [nat]: the same in every state, or in each its own, without the worst states."""
        each = np.einsum("ki,kij,kj->k", self.value, np.linalg.inv(self.covariance), self.value)
        kept = np.argsort(each)[: len(each) - int(np.ceil(_LEFT_OUT * len(each)))]
        value, covariance = self.value[kept], self.covariance[kept]
        logs = [f(value, covariance, (scale * PRIOR) ** 2) for scale in SCALES for f in (_own, _same)]
        return float(logsumexp(logs) - np.log(len(logs)))


def _own(value: np.ndarray, covariance: np.ndarray, variance: float) -> float:
    """Log evidence of a force of each state's own against none."""
    wider = covariance + variance * np.eye(value.shape[1])
    return _density(value, wider) - _density(value, covariance)


def _same(value: np.ndarray, covariance: np.ndarray, variance: float) -> float:
    """Log evidence of the same force everywhere against none."""
    sure = np.linalg.inv(covariance)
    gram, score = sure.sum(axis=0), np.einsum("kij,kj->i", sure, value)
    whole = np.eye(len(gram)) + variance * gram
    return 0.5 * float(score @ np.linalg.solve(whole, variance * score) - np.linalg.slogdet(whole)[1])


def _density(value: np.ndarray, covariance: np.ndarray) -> float:
    """Sum of the logs of Gaussian densities, constants left out."""
    square = np.einsum("ki,kij,kj->", value, np.linalg.inv(covariance), value)
    return -0.5 * float(square + np.linalg.slogdet(covariance)[1].sum())


def _without_drift(data: Recorded, found: Judged) -> Recorded:
    """The campaign with the lengths that its encoders would have read without their drift."""
    drift, zeros = found.hypothesis.drift, found.drifted(data)
    if not isinstance(drift, Drift) or zeros is None or drift.sensor != ENCODERS:
        return data
    return replace(data, readings=replace(data.readings, length=data.readings.length + zeros))


def _by_lengths(data: Recorded, factor: float) -> tuple[_Deviation, np.ndarray]:
    """What the encoders' lengths are off the simulated ones, about the pose that they mean; and in which states."""
    campaign, m = data.campaign, data.cables
    place, turn = data.readings.position, data.readings.rotation
    read = np.isfinite(campaign.states.length).all(axis=1)
    for _ in range(_TURNS):
        sent = commanded_at(campaign, place, turn, read)
        index = np.flatnonzero(sent.known)
        off = data.readings.length[index] - sent.lengths[index]
        slope = sent.slope[index]
        step = (np.linalg.pinv(slope) @ off[..., None])[..., 0] if len(index) else np.zeros((0, 6))
        if np.abs(step).max(initial=0.0) < _MEANT:
            break
        place, turn = _moved(place, turn, index, step)
    else:
        return _none(data), np.zeros(0, dtype=int)
    sigma = np.hypot(factor * data.sigma[index, 6 + m :], SIGMA)
    rest_of = np.linalg.qr(slope, mode="complete")[0][..., 6:] if len(index) else np.zeros((0, m, m - 6))
    inward = np.linalg.inv(np.swapaxes(rest_of, 1, 2) @ sent.internal[index])
    map_ = inward @ np.swapaxes(rest_of, 1, 2)
    return _Deviation((map_ @ off[..., None])[..., 0], (map_ * sigma[:, None] ** 2) @ np.swapaxes(map_, 1, 2)), index


def _none(data: Recorded) -> _Deviation:
    q = data.cables - 6
    return _Deviation(np.zeros((0, q)), np.zeros((0, q, q)))


def _moved(place: np.ndarray, turn: np.ndarray, index: np.ndarray, step: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Poses with those of some states moved by (k, 6) [m, rad] in world axes."""
    place, turn = place.copy(), turn.copy()
    place[index] += step[:, :3]
    turn[index] = rotation_from_vector(step[:, 3:]) @ turn[index]
    return place, turn


def _by_forces(data: Recorded, where: Layout, found: Judged, state: np.ndarray, factor: float) -> _Deviation:
    """What the believed tensions are off the simulated ones, along directions that mean the same everywhere."""
    point, m, robot = found.likeliest(data, where), data.cables, data.campaign.robot
    held = true_tension(at_states(point.robot(data), data.known), point.readings(data), data.known)
    place, turn = data.readings.position, data.readings.rotation
    null = [null_space(robot, place[k], turn[k]) for k in state]
    basis = np.array([aligned(own, null[0]) for own in null])
    said = _distribution(data).tensions
    off = np.broadcast_to(held, said.shape)[state] - said[state]
    tolerances = data.campaign.tolerances
    share = np.hypot(tolerances.load_cell_gain, _MODEL) * said[state]
    variance = (factor * data.sigma[state, 6 : 6 + m]) ** 2 + share**2 + tolerances.load_cell_bias_N**2
    map_ = np.swapaxes(basis, 1, 2) / m
    return _Deviation((map_ @ off[..., None])[..., 0], (map_ * variance[:, None]) @ np.swapaxes(map_, 1, 2))

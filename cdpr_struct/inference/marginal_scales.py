"""Where to begin: which scale does each group of readings ask for, its own error integrated out?

The bound has many local maxima, as an outlier that is believed to be good drags its neighbours along. Here the
probability of each factor kappa_g follows from the marginal likelihood of the data with the scale of group g alone
changed (as in expectation propagation), rather than from the expected error at its present scale; tau from the
product of these likelihoods. Repeated for all groups together, this raises no bound, but ends near a high maximum.
"""

import numpy as np

from cdpr_struct.inference.joint_posterior import JointPosterior
from cdpr_struct.inference.scale_mixture import KAPPA, PSEUDO_COUNTS, GroupedReadings, NoiseState, log_density_tau
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows

# Rounds at most, and the change of a probability at which they stop.
MAX_ROUNDS = 10
SETTLED = 0.01
# Factors tau on the stated sigmas of a kind that are compared [-]: 1/4 to 8 in steps of half an octave.
TAU = 2.0 ** np.linspace(-2.0, 3.0, 11)


def first_noise(
    rows: WhiteRows, readings: GroupedReadings, soft: SoftExpectation | None, one_sided: np.ndarray
) -> NoiseState:
    """A state of the noise to begin `fit` with, from stated sigmas on."""
    state, kind = NoiseState.stated(readings.groups), readings.groups.kind
    every = np.arange(len(kind))
    for _ in range(MAX_ROUNDS):
        joint = JointPosterior.of(rows, readings.spread(state.variance), soft, one_sided)
        weight = np.log(PSEUDO_COUNTS + readings.members @ state.responsibility)[kind]
        logit = weight[:, None] + scale_likelihood(readings, state, joint, TAU[:, None] * KAPPA)  # (G, tau, kappa)
        peak = logit.max(axis=2, keepdims=True)
        share = np.exp(logit - peak)
        total = share.sum(axis=2)
        best = (readings.members @ (peak[..., 0] + np.log(total)) + log_density_tau(TAU)).argmax(axis=1)
        chosen = every, best[kind]
        responsibility = share[chosen] / total[chosen][:, None]
        change = np.abs(responsibility - state.responsibility)[readings.inferred].max(initial=0.0)
        settled = change < SETTLED and np.array_equal(state.tau, TAU[best])
        state = NoiseState.of(readings.groups, responsibility, TAU[best])
        if settled:
            break
    return state


def scale_likelihood(
    readings: GroupedReadings, state: NoiseState, joint: JointPosterior, scales: np.ndarray
) -> np.ndarray:
    """ln of the data's density with one group at each scale (...), the others at their present variance, (G, ...).

    Relative to the present scale. Correlation between blocks of a group that lies in several is left out.
    """
    root = readings.spread(1.0 / np.sqrt(state.variance))
    parts = [_principal(joint, i, index, root[i]) for i, index in enumerate(readings.index)]
    value, along, owner = (np.concatenate([part[j].ravel() for part in parts]) for j in range(3))
    prior = np.append(state.variance, (1.0, 1.0))[owner]
    precision = prior / scales.reshape(-1, 1) ** 2  # relative to the present one
    shrunk = 1.0 + value * (precision - 1.0)
    gain = 0.5 * (np.log(precision / shrunk) - along * (precision - 1.0) / shrunk)
    return readings.sums_of(owner, gain).T.reshape(-1, *scales.shape)


def _principal(
    joint: JointPosterior, stack: int, index: np.ndarray, root: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Principal variances of each group in units of its present scale, squares of the mean along them, and whose.

    All (K, q), of one stack. Variances lie between 0 and 1, so a shift by twice the group's place in the block keeps
    the principal axes of different groups apart.
    """
    mean, owner = root * joint.noise_mean[stack], index.copy()
    value, along = root**2 * joint.noise_variance[stack], mean**2
    same = (owner[:, :, None] == owner[:, None]) & (owner >= 0)[:, None]
    shared = np.flatnonzero((same.sum(axis=2) > 1).any(axis=0))
    if len(shared):
        scale = root[:, shared]
        scaled = joint.covariance(stack, shared) * scale[:, :, None] * scale[:, None]
        same = same[:, shared[:, None], shared] | np.eye(len(shared), dtype=bool)
        covariance = scaled * same
        np.einsum("kii->ki", covariance)[...] += 2.0 * same.argmax(axis=2)
        shifted, vector = np.linalg.eigh(covariance)
        place = np.floor(0.5 * shifted + 0.25).astype(int)
        value[:, shared] = shifted - 2.0 * place
        along[:, shared] = np.einsum("kij,ki->kj", vector, mean[:, shared]) ** 2
        owner[:, shared] = np.take_along_axis(owner[:, shared], place, axis=1)
    return np.clip(value, 0.0, 1.0), along, owner

"""Where to begin: which scale does each group of readings ask for, its own error integrated out?

The bound has many local maxima, as an outlier that is believed to be good drags its neighbours along. Here the
probability of each factor kappa_g follows from the marginal likelihood of the data with the scale of group g alone
changed (as in expectation propagation), rather than from the expected error at its present scale; tau from the
product of these likelihoods. Repeated for all groups together, this raises no bound, but ends near a high maximum.
"""

import numpy as np

from cdpr_struct.inference.joint_posterior import JointPosterior
from cdpr_struct.inference.scale_mixture import KAPPA, PSEUDO_COUNTS, NoiseGroups, NoiseState, log_density_tau
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows

# Rounds at most, and the change of a probability at which they stop.
MAX_ROUNDS = 10
SETTLED = 0.01
# Factors tau on the stated sigmas of a kind that are compared [-]: 1/4 to 8 in steps of half an octave.
TAU = 2.0 ** np.linspace(-2.0, 3.0, 11)


def first_noise(
    rows: WhiteRows, groups: NoiseGroups, soft: SoftExpectation | None, one_sided: np.ndarray
) -> NoiseState:
    """A state of the noise to begin `fit` with, from stated sigmas on."""
    state = NoiseState.stated(groups)
    every = np.arange(len(groups.kind))
    for _ in range(MAX_ROUNDS):
        joint = JointPosterior.of(rows, groups.spread(state.variance), soft, one_sided)
        weight = np.log(PSEUDO_COUNTS + groups.members @ state.responsibility)[groups.kind]
        logit = weight[:, None] + scale_likelihood(groups, state, joint, TAU[:, None] * KAPPA)  # (G, tau, kappa)
        peak = logit.max(axis=2, keepdims=True)
        share = np.exp(logit - peak)
        total = share.sum(axis=2)
        best = (groups.members @ (peak[..., 0] + np.log(total)) + log_density_tau(TAU)).argmax(axis=1)
        chosen = every, best[groups.kind]
        responsibility = share[chosen] / total[chosen][:, None]
        change = np.abs(responsibility - state.responsibility)[groups.inferred].max(initial=0.0)
        settled = change < SETTLED and np.array_equal(state.tau, TAU[best])
        state = NoiseState.of(groups, responsibility, TAU[best])
        if settled:
            break
    return state


def scale_likelihood(groups: NoiseGroups, state: NoiseState, joint: JointPosterior, scales: np.ndarray) -> np.ndarray:
    """ln of the data's density with one group at each scale (...), the others at their present variance, (G, ...).

    Relative to the present scale. Correlation between blocks of a group that lies in several is left out.
    """
    value, along, owner = _principal(groups, joint, groups.spread(1.0 / np.sqrt(state.variance)))
    precision = state.variance[owner] / scales.reshape(-1, 1, 1) ** 2  # of the prior, relative to the present one
    shrunk = 1.0 + value * (precision - 1.0)
    gain = 0.5 * (np.log(precision / shrunk) - along * (precision - 1.0) / shrunk)
    return groups.sums_of(owner, gain).T.reshape(-1, *scales.shape)


def _principal(
    groups: NoiseGroups, joint: JointPosterior, root: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Principal variances of each group in units of its present scale, squares of the mean along them, and whose.

    All (K, q). Variances lie between 0 and 1, so a shift by twice the group's place in the block keeps the principal
    axes of different groups apart.
    """
    scaled = joint.noise_covariance * root[:, :, None] * root[:, None]
    mean, owner = root * joint.noise_mean, groups.index.copy()
    value, along = np.einsum("kii->ki", scaled).copy(), mean**2
    same = owner[:, :, None] == owner[:, None]
    shared = np.flatnonzero((same.sum(axis=2) > 1).any(axis=0))
    if len(shared):
        same = same[:, shared[:, None], shared]
        covariance = scaled[:, shared[:, None], shared] * same
        np.einsum("kii->ki", covariance)[...] += 2.0 * same.argmax(axis=2)
        shifted, vector = np.linalg.eigh(covariance)
        place = np.floor(0.5 * shifted + 0.25).astype(int)
        value[:, shared] = shifted - 2.0 * place
        along[:, shared] = np.einsum("kij,ki->kj", vector, mean[:, shared]) ** 2
        owner[:, shared] = np.take_along_axis(owner[:, shared], place, axis=1)
    return np.clip(value, 0.0, 1.0), along, owner

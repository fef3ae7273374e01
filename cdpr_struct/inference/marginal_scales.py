"""Where to begin: which scale does each group of readings ask for, its own error integrated out?

The bound has many local maxima, as an outlier that is believed to be good drags its neighbours along. Here the
probability of each factor kappa_g follows from the marginal likelihood of the data with the scale of group g alone
changed (as in expectation propagation), rather than from the expected error at its present scale; tau from the
product of these likelihoods. Repeated for all groups together, this raises no bound, but ends near a high maximum.
"""

import numpy as np
from scipy.special import logsumexp

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
        best = (groups.members @ logsumexp(logit, axis=2) + log_density_tau(TAU)).argmax(axis=1)
        logit = logit[every, best[groups.kind]]
        responsibility = np.exp(logit - logsumexp(logit, axis=1, keepdims=True))
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
    # In units of the present scale the posterior covariance of a group lies between 0 and 1. A shift by twice the
    # group's place in the block keeps the eigenvectors of different groups apart.
    root = groups.spread(1.0 / np.sqrt(state.variance))
    same = groups.index[:, :, None] == groups.index[:, None]
    covariance = joint.noise_covariance * same * root[:, :, None] * root[:, None]
    first = same.argmax(axis=2)
    np.einsum("kii->ki", covariance)[...] += 2.0 * first
    value, vector = np.linalg.eigh(covariance)
    place = np.floor(0.5 * value + 0.25).astype(int)
    value = np.clip(value - 2.0 * place, 0.0, 1.0)
    along = np.einsum("kij,ki->kj", vector, root * joint.noise_mean) ** 2
    owner = np.take_along_axis(groups.index, place, axis=1)
    precision = state.variance[owner] / scales.reshape(-1, 1, 1) ** 2  # of the prior, relative to the present one
    shrunk = 1.0 + value * (precision - 1.0)
    gain = 0.5 * (np.log(precision / shrunk) - along * (precision - 1.0) / shrunk)
    return groups.sums_of(owner, gain).T.reshape(-1, *scales.shape)

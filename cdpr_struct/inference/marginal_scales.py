"""Where to begin: which scale does each group of readings ask for, its own error integrated out?

The bound has many local maxima, as an outlier that is believed to be good drags its neighbours along. Here the
probability of each factor kappa_g follows from the marginal likelihood of the data with group g alone at that
factor (as in expectation propagation), rather than from the expected error at the present one. Repeated for all
groups together, this raises no bound, but ends near a high maximum.
"""

import numpy as np

from cdpr_struct.inference.joint_posterior import JointPosterior
from cdpr_struct.inference.scale_mixture import KAPPA, PSEUDO_COUNTS, NoiseGroups, NoiseState
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.inference.white_rows import WhiteRows

# Rounds at most, and the change of a probability at which they stop.
MAX_ROUNDS = 10
SETTLED = 0.01


def first_noise(
    rows: WhiteRows, groups: NoiseGroups, soft: SoftExpectation | None, one_sided: np.ndarray
) -> NoiseState:
    """A state of the noise to begin `fit` with, from stated sigmas on; tau is left at 1."""
    state = NoiseState.stated(groups)
    for _ in range(MAX_ROUNDS):
        joint = JointPosterior.of(rows, groups.spread(state.variance), soft, one_sided)
        counts = PSEUDO_COUNTS + groups.members @ state.responsibility
        logit = np.log(counts)[groups.kind] + scale_likelihood(groups, state, joint)
        responsibility = np.exp(logit - logit.max(axis=1, keepdims=True))
        responsibility /= responsibility.sum(axis=1, keepdims=True)
        change = np.abs(responsibility - state.responsibility)[groups.inferred].max(initial=0.0)
        state = NoiseState.of(groups, responsibility, state.tau)
        if change < SETTLED:
            break
    return state


def scale_likelihood(groups: NoiseGroups, state: NoiseState, joint: JointPosterior) -> np.ndarray:
    """ln of the data's density with one group at each factor, the others at their present variance, (G, 5).

    Up to a constant of each group. Correlation between blocks of a group that lies in several is left out.
    """
    same = groups.index[:, :, None] == groups.index[:, None]
    covariance = joint.noise_covariance * same
    identity = np.eye(covariance.shape[1])
    present = 1.0 / state.variance
    found = np.empty((len(groups.kind), len(KAPPA)))
    for column, kappa in enumerate(KAPPA):
        # p(data | kappa) ~ integral of the posterior of u_g times exp(-more |u_g|^2/2) / kappa^d
        more = groups.spread(1.0 / (kappa * state.tau[groups.kind]) ** 2 - present)
        sign, root = np.sign(more), np.sqrt(np.abs(more))
        matrix = identity + (sign * root)[:, :, None] * covariance * root[:, None]
        mean = root * joint.noise_mean
        misfit = sign * mean * np.linalg.solve(matrix, mean[..., None])[..., 0]
        log_root = np.log(np.einsum("kii->ki", np.linalg.cholesky(matrix)))
        found[:, column] = groups.sums(-log_root - 0.5 * misfit) - groups.size * np.log(kappa)
    return found

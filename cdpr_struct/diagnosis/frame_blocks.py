"""What does each stretch of a recording say of a cause on its own, and does it need that stretch?

Neighbouring frames share errors that no sigma states. If stretches disagree by more than their sigmas, the sigma of the
whole is too small by the same factor (a Birge ratio; Birge, Physical Review 40, 1932).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.block_sums import BlockSums
from cdpr_struct.observation.motion import STILL
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.recorded import Recorded

BLOCKS = 6  # stretches of a recording
_FEWEST = 2  # states of a stretch


@dataclass(frozen=True, slots=True, eq=False)
class FrameBlocks:
    """Of B stretches, what they say of the d numbers of a cause.

    cause : its name;  start, end (B,) : times of a stretch [s]
    estimate (B, d), sigma (B, d) : by a stretch alone, in the cause's unit
    gain (B,) : by how much the log evidence of the cause grows with a stretch [nat]
    chi2_per_dof : of the estimates about their common mean
    """

    cause: str
    start: np.ndarray
    end: np.ndarray
    estimate: np.ndarray
    sigma: np.ndarray
    gain: np.ndarray
    chi2_per_dof: float

    @property
    def dispersion(self) -> float:
        """Factor on variances at which the stretches agree; one where they do as it is."""
        return max(1.0, self.chi2_per_dof)


def stretches(data: Recorded, where: Layout) -> list[np.ndarray]:
    """Blocks of rows of each of `BLOCKS` stretches of a motion, in order of time; none where too few states move."""
    state = _states(where)
    moving = np.flatnonzero(np.abs(data.known.rate[state, :, 0]).max(axis=1, initial=0.0) > STILL)
    if len(moving) < BLOCKS * _FEWEST:
        return []
    time = data.campaign.states.time[state[moving]]
    return list(np.array_split(moving[np.argsort(time, kind="stable")], BLOCKS))


def spans(data: Recorded, where: Layout, some: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Times of the first and the last state (B,) of stretches [s]."""
    time = data.campaign.states.time[_states(where)]
    return np.array([time[own].min() for own in some]), np.array([time[own].max() for own in some])


def numbers_without(found: Judged, some: Sequence[np.ndarray]) -> np.ndarray:
    """(B, t) numbers of a fit as all but one of the stretches say."""
    sums = BlockSums.of(found.model, found.fit.noise, found.fit.soft, found.model.parameters)
    return np.array([np.linalg.solve(*sums.without(own)) for own in some])


def frame_blocks(data: Recorded, where: Layout, found: Judged, part: int) -> FrameBlocks | None:
    """Of one cause of a fit, by its number; None where too few states are frames of a motion."""
    some = stretches(data, where)
    if not some:
        return None
    parts, sizes = found.hypothesis.parts, [len(one.pattern.prior) for one in found.hypothesis.parts]
    first = found.model.parameters - sum(sizes)
    own = first + sum(sizes[:part]) + np.arange(sizes[part])
    sums = BlockSums.of(found.model, found.fit.noise, found.fit.soft, first)
    told = [_estimate(sums, own, stretch) for stretch in some]
    estimate, precision = np.array([z for z, _ in told]), np.array([p for _, p in told])
    off = estimate - np.linalg.solve(precision.sum(axis=0), np.einsum("bij,bj->i", precision, estimate))
    scale = parts[part].scale * parts[part].pattern.prior
    spread = np.sqrt(np.array([np.diagonal(np.linalg.inv(p)) for p in precision]))
    whole = sums.gain(own, np.zeros(0, dtype=int))
    return FrameBlocks(
        parts[part].cause.name, *spans(data, where, some), estimate * scale, spread * scale,
        np.array([whole - sums.gain(own, stretch) for stretch in some]),
        float(np.einsum("bi,bij,bj->", off, precision, off) / ((BLOCKS - 1) * len(own))),
    )  # fmt: skip


def _states(where: Layout) -> np.ndarray:
    """First state of each block of rows; modal constants come after these."""
    return np.concatenate([shelf.states[:, 0] for shelf in where.shelves])


def _estimate(sums: BlockSums, own: np.ndarray, stretch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (d,) by the rows of a stretch alone, without their prior, and their precision (d, d)."""
    covariance = np.linalg.inv(np.eye(sums.gram.shape[1]) + sums.gram[stretch].sum(axis=0))
    mean = covariance @ sums.score[stretch].sum(axis=0)
    posterior = np.linalg.inv(covariance[np.ix_(own, own)])
    precision = posterior - np.eye(len(own))
    floor = np.finfo(float).eps * np.trace(posterior)
    precision += floor * np.eye(len(own))
    return np.linalg.solve(precision, posterior @ mean[own]), precision

"""What does a recording of a motion say beyond single states: its worth, its stretches, its held-out lengths?"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.diagnosis.bend_of_speed import SPEED_SHARE, Bend, bend_of_cause
from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.diagnosis.frame_blocks import FrameBlocks, frame_blocks, numbers_without, spans, stretches
from cdpr_struct.diagnosis.whole_sizes import WholeSize
from cdpr_struct.hypotheses.explain import Explained
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.significant import SIGNIFICANT
from cdpr_struct.measurement.campaign import Campaign

_NONE = (None, None)


@dataclass(frozen=True, slots=True, eq=False)
class Remainder:
    """What no cause explains beside a named one.

    decision : the name, and how sure it is;  law : in words;  causes : that share in it, none of them named
    gain : its log evidence beside the cause [nat]
    size (m,) : rms of what the cause leaves of the lengths, noise among it, by cable [m]
    ahead : log evidence of the cause alone against the best without it, as many frames as they are worth [nat]
    """

    decision: Decision
    law: str
    causes: tuple[str, ...]
    gain: float
    size: np.ndarray
    ahead: float


@dataclass(frozen=True, slots=True, eq=False)
class LengthErrors:
    """Rms (m,) over frames of measured less predicted lengths, by cable [m].

    entered : of the robot as entered;  refitted : its tolerances fitted, no cause;  named : with the causes
    """

    frames: int
    entered: np.ndarray
    refitted: np.ndarray
    named: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """A motion: `frames` that count as `states`, and as how many independent ones they are `worth`.

    blocks : stretches about the cause that acts in motion, None without one that is chosen
    held_out : lengths of each stretch, predicted from the others; None where nothing is chosen
    speed_share, acceleration_share : of the errors of lengths, explained by functions of it that were fitted to other
    stretches: without causes, and with them; None where frames are too few
    remainder : what is wrong beside the named cause, None where nothing is
    p_of_speed : of the share of speed with the causes, if it were by chance
    bend : of the errors that the cause in motion stands for, None without one or with few frames
    """

    frames: int
    states: int
    worth: float
    blocks: FrameBlocks | None
    held_out: LengthErrors | None
    speed_share: tuple[float | None, float | None]
    acceleration_share: tuple[float | None, float | None]
    remainder: Remainder | None
    p_of_speed: float = 1.0
    bend: Bend | None = None

    def widened(self, sizes: Sequence[WholeSize]) -> tuple[WholeSize, ...]:
        """Sizes of causes, that of the cause in motion as sure as its stretches agree."""
        if self.blocks is None:
            return tuple(sizes)
        factor = {self.blocks.cause: self.blocks.dispersion}
        return tuple(replace(s, covariance=s.covariance * factor.get(s.part.cause.name, 1.0)) for s in sizes)

    @property
    def unnamed_motion(self) -> bool:
        """Whether what the causes leave is a function of speed, or what they stand for bends with it: then a law of
        motion is at work that nobody named."""
        share = self.speed_share[1]
        left = share is not None and share > SPEED_SHARE and self.p_of_speed < SIGNIFICANT
        return left or (self.bend is not None and self.bend.matters)

    @property
    def p_of_unnamed(self) -> float:
        """p-value of that."""
        return min(self.p_of_speed, 1.0 if self.bend is None else self.bend.p)


def recording(
    campaign: Campaign, every: AllFrames | None, story: Explained, null: Judged, chosen: Judged,
    beside: Remainder | None,
) -> Recording | None:  # fmt: skip
    """Of a campaign, as it was condensed, with all its frames; None where nothing moves."""
    data, where, frames, states = story.search.data, story.search.where, campaign.frames, len(campaign.states.names)
    if every is None:
        return None if frames is None else Recording(frames.of, states, frames.worth, None, None, _NONE, _NONE, None)
    moving = moving_parts(chosen.hypothesis, [cause.name for cause in story.search.causes])
    blocks = frame_blocks(data, where, chosen, moving[0]) if moving else None
    some, pieces = stretches(data, where), pieces_of(every, story)
    before, after = every.errors(null), every.errors(chosen)
    by_speed = every.share_of_speed(before, pieces), every.share_of_speed(after, pieces)
    by_acceleration = every.share_of_acceleration(before, pieces), every.share_of_acceleration(after, pieces)
    p = 1.0 if chosen is null else every.p_of_speed(after, pieces)
    bend = bend_of_cause(every, chosen, moving[0]) if moving else None
    held_out = _held_out(every, pieces, some, null, chosen) if pieces and chosen is not null else None
    count = len(every.frames) if frames is None else frames.of
    worth = float(count) if frames is None else frames.worth
    return Recording(count, states, worth, blocks, held_out, by_speed, by_acceleration, beside, p, bend)


def moving_parts(hypothesis: Hypothesis, library: Sequence[str]) -> list[int]:
    """Numbers of the causes that act in motion, in the order of the library, whichever was found first: a delay before
    a drift, which is no function of speed."""
    own = [(library.index(p.cause.name), i) for i, p in enumerate(hypothesis.parts) if p.cause.in_motion]
    return [i for _, i in sorted(own)]


def pieces_of(every: AllFrames, story: Explained) -> list[np.ndarray]:
    """Frames of each stretch; none where there are too few."""
    data, where = story.search.data, story.search.where
    some = stretches(data, where)
    return _pieces(every, *spans(data, where, some)) if some else []


def _pieces(every: AllFrames, start: np.ndarray, end: np.ndarray) -> list[np.ndarray]:
    """Frames of each stretch, those between two in the nearer one."""
    which = np.searchsorted(0.5 * (end[:-1] + start[1:]), every.time)
    return [np.flatnonzero(which == k) for k in range(len(start))]


def _held_out(
    every: AllFrames, pieces: Sequence[np.ndarray], some: Sequence[np.ndarray], null: Judged, chosen: Judged
) -> LengthErrors:
    """Each stretch predicted by numbers found in the others, its frames left out too."""
    rows = [every.errors(None)]
    for found in (null, chosen):
        errors = np.full_like(rows[0], np.nan)
        for piece, z in zip(pieces, numbers_without(found, some), strict=True):
            errors[piece] = every.errors(found, z)[piece]
        rows.append(errors)
    return LengthErrors(len(every.frames), *(np.sqrt(np.nanmean(one**2, axis=0)) for one in rows))

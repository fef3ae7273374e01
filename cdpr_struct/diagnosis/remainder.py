"""A cause that shows with speed, and beside it an error that does not: may the cause be named, and what is left told?

Usually what holds a law outside the library is unknown as a whole, since causes may share out the effect of that law.
A cause that shows in proportion to speed has no share in what depends on the place alone: the same places are passed at
other speeds. It is named beside such a remainder where three things hold. Alone it is surer than everything without it,
pairs and laws outside the library among them, by the evidence from which things are named, counted as the stretches of
the recording agree. Every stretch adds evidence for it. And what it leaves is no function of speed, in stretches that
such functions were not fitted to; nor do the errors that it stands for bend with speed.
"""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.diagnosis.bend_of_speed import SPEED_SHARE, bend_of_cause
from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.diagnosis.frame_blocks import frame_blocks
from cdpr_struct.diagnosis.recording import Remainder
from cdpr_struct.hypotheses.detectable import NAMED
from cdpr_struct.hypotheses.explain import Explained
from cdpr_struct.hypotheses.laws import UNKNOWN


def remainder(
    every: AllFrames | None, pieces: Sequence[np.ndarray], found: Sequence[Explained], decision: Decision
) -> Remainder | None:
    """Where the decision is unknown, but a cause in motion may be named beside what is unknown; else None."""
    story = found[0]
    if every is None or decision.status != UNKNOWN or story.correction is not None:
        return None
    both = next((answer for answer in story.answers if UNKNOWN in answer.names), None)
    names = () if both is None else tuple(p.cause.name for p in both.best.hypothesis.parts if p.cause.in_motion)
    alone = next((answer for answer in story.answers if answer.names == names), None)
    if both is None or alone is None or len(names) != 1:
        return None
    data, where = story.search.data, story.search.where
    blocks, errors = frame_blocks(data, where, alone.best, 0), every.errors(alone.best)
    if blocks is None or (blocks.gain <= 0.0).any():
        return None
    ahead = (alone.score - _best_without(found, names[0])) / blocks.dispersion
    share, bend = every.share_of_speed(errors, pieces), bend_of_cause(every, alone.best, 0)
    if ahead < NAMED or share is None or share > SPEED_SHARE or (bend is not None and bend.matters):
        return None
    size = np.sqrt(np.nanmean(errors**2, axis=0))
    sure = 1.0 / (1.0 + float(np.exp(-ahead)))
    law = next(part.pattern.label for part in both.best.hypothesis.parts if part.law is not None)
    others = tuple(name for name in both.names if name not in (UNKNOWN, *names))
    return Remainder(Decision("named", (names,), sure), law, others, both.score - alone.score, size, ahead)


def _best_without(found: Sequence[Explained], name: str) -> float:
    """ln of evidence times prior of the best answer, on any data, that does not have a cause."""
    return max(
        (answer.score + one.price for one in found for answer in one.answers if name not in answer.names),
        default=-np.inf,
    )

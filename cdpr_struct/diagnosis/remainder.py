"""A cause that shows with speed, and beside it an error that does not: may the cause be named, and what is left told?

Usually what holds a law outside the library is unknown as a whole, since causes may share out the effect of that law.
A cause that shows in proportion to speed has no share in what depends on the place alone: along a motion the same places
are passed at other speeds. It is named beside such a remainder where four things hold. Alone it is surer than
everything without it, pairs and laws outside the library among them, by the evidence from which things are named. It
is nearly as much needed as the law: together they are the best of all. Every stretch of the recording adds evidence for
it. And what it leaves is no function of speed, in stretches that such functions were not fitted to.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.diagnosis.frame_blocks import frame_blocks
from cdpr_struct.hypotheses.detectable import NAMED
from cdpr_struct.hypotheses.explain import Explained
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.hypotheses.search import Answer

SPEED_SHARE = 0.1  # of the variance of errors that functions of speed explain: more is a law of motion that nobody named


@dataclass(frozen=True, slots=True, eq=False)
class Remainder:
    """What no cause explains beside a named one.

    decision : the name, and how sure it is;  law : in words;  gain : its log evidence beside the cause [nat]
    size (m,) : rms of what the law does to the lengths, by cable [m]
    ahead : log evidence of the cause alone against the best without it, as many frames as they are worth [nat]
    """

    decision: Decision
    law: str
    gain: float
    size: np.ndarray
    ahead: float


def remainder(
    every: AllFrames | None, pieces: Sequence[np.ndarray], found: Sequence[Explained], decision: Decision
) -> Remainder | None:
    """Where the decision is unknown, but a cause in motion may be named beside what is unknown; else None."""
    story = found[0]
    if every is None or decision.status != UNKNOWN or story.correction is not None:
        return None
    both = story.answers[0]
    names = tuple(name for name in both.names if name != UNKNOWN)
    alone = next((answer for answer in story.answers if answer.names == names), None)
    if alone is None or len(names) != 1 or len(both.names) != 2:
        return None
    if not alone.best.hypothesis.parts[0].cause.in_motion:
        return None
    data, where = story.search.data, story.search.where
    blocks = frame_blocks(data, where, alone.best, 0)
    if blocks is None or (blocks.gain <= 0.0).any():
        return None
    ahead = (alone.score - _best_without(found, names[0])) / blocks.dispersion
    share = every.share_of_speed(every.errors(alone.best), pieces)
    if ahead < NAMED or share is None or share > SPEED_SHARE:
        return None
    sure = 1.0 / (1.0 + float(np.exp(-ahead)))
    law, size = _law(both, data.cables)
    return Remainder(Decision("named", (names,), sure), law, both.score - alone.score, size, ahead)


def _best_without(found: Sequence[Explained], name: str) -> float:
    """ln of evidence times prior of the best answer, on any data, that does not have a cause."""
    return max(
        (answer.score + one.price for one in found for answer in one.answers if name not in answer.names),
        default=-np.inf,
    )


def _law(answer: Answer, cables: int) -> tuple[str, np.ndarray]:
    """Words of the law in an answer, and what it does to the lengths (m,) [m]."""
    best = answer.best
    index = next(i for i, part in enumerate(best.hypothesis.parts) if part.law is not None)
    part = best.hypothesis.parts[index]
    columns = part.term.columns
    rows = np.zeros((1, cables)) if columns is None else columns.static[:, 6:] @ best.sizes[index]
    return part.pattern.label, np.asarray(np.sqrt(np.mean((rows - rows.mean(axis=0)) ** 2, axis=0)))

"""One number for all carriers, unless stretches of a recording are sure that each has its own.

Frames share errors that no sigma states, and these favour a number for each cable. The number that is common to all
comes first: each its own is told only if its evidence against that, counted as the stretches agree, is that from which
things are named.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.frame_blocks import frame_blocks
from cdpr_struct.hypotheses.detectable import NAMED
from cdpr_struct.hypotheses.explain import Explained
from cdpr_struct.hypotheses.hypothesis import SCALES, Hypothesis, Part
from cdpr_struct.hypotheses.judge import Judged, judged, settled

ALIKE, EACH = "all alike", "each its own"


def common_first(story: Explained, chosen: Judged) -> Explained:
    """The story with the chosen fit in its common form, where that is nearly as likely; itself where it is not."""
    parts = chosen.hypothesis.parts
    index = next((i for i, p in enumerate(parts) if p.cause.in_motion and _is(p.pattern.label, EACH)), None)
    if index is None:
        return story
    data, where = story.search.data, story.search.where
    blocks = frame_blocks(data, where, chosen, index)
    other = _alike(story, chosen, index)
    if blocks is None or (chosen.score - other.score) / blocks.dispersion >= NAMED:
        return story
    answers = (replace(one, best=other) if one.best is chosen else one for one in story.answers)
    return replace(story, answers=tuple(answers))


def _is(label: str, pattern: str) -> bool:
    """Whether a label is that of a pattern, of whatever law."""
    return label == pattern or label.startswith(f"{pattern}, ")


def _alike(story: Explained, chosen: Judged, index: int) -> Judged:
    """The fit with one number for all carriers in one of its parts, at the likeliest scale."""
    data, where, parts = story.search.data, story.search.where, list(chosen.hypothesis.parts)
    own = parts[index]
    pattern = next(
        one for one in own.cause.patterns(story.search.seen) if one.label == own.pattern.label.replace(EACH, ALIKE, 1)
    )
    middle = float(np.mean(chosen.sizes[index])) * own.scale
    scale = min(SCALES, key=lambda one: abs(np.log(one / max(abs(middle), SCALES[0]))))
    parts[index] = Part(own.cause, pattern, scale)
    found = judged(data, where, Hypothesis(tuple(parts), chosen.hypothesis.drift), noise=chosen.fit.noise)
    return settled(data, where, found)

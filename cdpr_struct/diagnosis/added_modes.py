"""Does an added mode show in every state, or does it hang on one?"""

from dataclasses import replace

import numpy as np

from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import Judged, judged
from cdpr_struct.residuals.layout import Layout, layout
from cdpr_struct.residuals.recorded import Recorded


def least_evidence(data: Recorded, where: Layout, found: Judged) -> float | None:
    """Log evidence [nat] that the added modes of a hypothesis keep without the peaks of the state that they need most.

    Both sides are fitted anew to the others. None without added modes, or with peaks in a single state.
    """
    more, measured = found.hypothesis, data.vibrations
    if not any(part.cause.tuned for part in more.parts) or measured is None or measured.peaks is None:
        return None
    bare = Hypothesis(tuple(part for part in more.parts if not part.cause.tuned), more.drift)
    start, index = found.likeliest(data, where), np.flatnonzero(measured.peaks.count > 0)
    if len(index) < 2:
        return None
    kept = []
    for k in index.tolist():
        rest = replace(data, vibrations=measured.peaks_in(np.setdiff1d(index, [k])))
        there = layout(rest)
        kept.append(judged(rest, there, more, start).log_evidence - judged(rest, there, bare).log_evidence)
    return min(kept)

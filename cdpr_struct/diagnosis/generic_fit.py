"""How much better would a fit predict that asks for no cause: a common EA and a common gain of the load cells?"""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.left_out import left_out
from cdpr_struct.hypotheses.alternatives import offered
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.search import Search

_GENERIC = ("axial_stiffness", "load_cell_gain")


def generic_ratio(search: Search, null: Judged, chosen: Judged) -> float | None:
    """How many times smaller it makes the error of blocks that it was not fitted to, at the chosen fit's noise."""
    causes = [cause for cause in search.causes if cause.name in _GENERIC]
    if not causes:
        return None
    menu = [one for one in offered(search.data, search.where, search.seen, causes, null) if not one.laws]
    own, columns = [], []
    for one in menu:
        alike = next(i for i, pattern in enumerate(one.patterns) if pattern.label == "all alike")
        part = one.part(alike, 1.0)
        own.append(part)
        columns.append([shelf @ part.pattern.basis * part.term.sigma for shelf in one.columns])
    model = null.model.with_columns([np.concatenate(parts, axis=-1) for parts in zip(*columns, strict=True)])
    fit = replace(null.fit, noise=chosen.fit.noise)
    left = left_out(search.data, search.where, replace(null, hypothesis=Hypothesis(tuple(own)), model=model, fit=fit))
    return None if left is None else left.ratio(np.ones(len(left.kind), dtype=bool))

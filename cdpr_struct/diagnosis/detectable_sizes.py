"""The smallest size of each cause that a campaign would show, and which causes it would not tell apart."""

import numpy as np

from cdpr_struct.diagnosis.alternatives import Offered, offered
from cdpr_struct.diagnosis.detectable import noncentrality
from cdpr_struct.diagnosis.hypotheses.cause import Pattern
from cdpr_struct.diagnosis.judge import Judged
from cdpr_struct.diagnosis.search import Search
from cdpr_struct.inference.screening import Screen


def minimum_detectable(search: Search, null: Judged) -> dict[str, dict[str, float | str]]:
    """Per cause the size found with probability 0.8 at a false alarm rate of 0.001; of several numbers their rms."""
    menu = [one for one in offered(search.data, search.where, search.seen, search.causes, null) if not one.laws]
    screen = Screen.of(null.model, null.fit.noise, null.fit.soft)
    table: dict[str, dict[str, float | str]] = {}
    for cause in menu:
        pattern = plainest(cause)
        gram = screen.screened([part @ pattern.basis * pattern.prior for part in cause.columns]).gram
        strength, first = float(np.trace(gram)), pattern.parameters[0]
        size = np.sqrt(noncentrality(len(gram)) / max(strength, 1e-300)) * first.prior
        table[cause.cause.name] = {
            "value": float(np.expm1(size)) if first.ratio else float(size),
            "unit": "relative" if first.ratio else first.unit,
            "pattern": pattern.label or "as a whole",
        }
    return table


def plainest(cause: Offered) -> Pattern:
    """All alike if there is such a pattern, else that of the most numbers."""
    alike = [pattern for pattern in cause.patterns if pattern.label == "all alike"]
    return (alike or [max(cause.patterns, key=lambda pattern: len(pattern.parameters))])[0]

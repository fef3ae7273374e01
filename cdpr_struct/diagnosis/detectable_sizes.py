"""The smallest size of each cause that a campaign would show."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.hypotheses.alternatives import of_pattern, offered
from cdpr_struct.hypotheses.causes.cause import ALIKE_IN, Pattern
from cdpr_struct.hypotheses.detectable import noncentrality
from cdpr_struct.hypotheses.hypothesis import SCALES
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.inference.screening import Screen

Size = dict[str, float | str]
"""Name of a cause's first parameter, value, unit and pattern."""


def detectable_sizes(search: Search, null: Judged) -> tuple[dict[str, Size], dict[str, list[Size]]]:
    """Size of each cause of the library found in four of five campaigns of these measurements, if nothing else is
    wrong: in its plainest pattern, and in each of its patterns.

    Causes and patterns that would show only beyond the largest size that is considered are left out.
    """
    screen = Screen.of(null.model, null.fit.noise, null.fit.soft)
    plain: dict[str, Size] = {}
    every: dict[str, list[Size]] = {}
    for one in offered(search.data, search.where, search.seen, search.causes, null):
        if one.laws:
            continue
        said, name = screen.screened(one.columns), one.cause.name
        grams = [of_pattern(pattern, said.gram, said.score)[0] for pattern in one.patterns]
        first = one.patterns.index(plainest(one.patterns))
        if _shows(grams[first]):
            plain[name] = smallest(one.patterns[first], grams[first])
        shown = [smallest(p, gram) for p, gram in zip(one.patterns, grams, strict=True) if _shows(gram)]
        if shown and not one.cause.tuned:
            every[name] = shown
    return plain, every


def _shows(gram: np.ndarray) -> bool:
    """Whether a pattern of gram (d, d) would be found at the largest size that is considered."""
    return bool(np.trace(gram) * SCALES[-1] ** 2 > noncentrality(len(gram)))


def smallest(pattern: Pattern, gram: np.ndarray) -> dict[str, float | str]:
    """Size of a random pattern of this kind that is found, from gram (d, d) by one prior sigma of its parameters."""
    strength, first = float(np.trace(gram)), pattern.parameters[0]
    size = np.sqrt(noncentrality(len(gram)) / max(strength, 1e-300)) * first.prior
    shown = np.expm1(size) if first.ratio else size**2 if first.squared else size
    return {
        "value": float(shown),
        "unit": "relative" if first.ratio else first.unit,
        "pattern": pattern.label or "as a whole",
    }


def plainest(patterns: Sequence[Pattern]) -> Pattern:
    """All alike if there is such a pattern, else that of the most numbers."""
    alike = [p for p in patterns if p.label == "all alike" or p.label.startswith(ALIKE_IN)]
    return (alike or [max(patterns, key=lambda pattern: len(pattern.parameters))])[0]

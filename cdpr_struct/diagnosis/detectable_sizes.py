"""The smallest size of each cause that a campaign would show."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.hypotheses.alternatives import Offered, of_pattern, offered
from cdpr_struct.hypotheses.causes.cause import ALIKE_IN, Pattern
from cdpr_struct.hypotheses.detectable import noncentrality
from cdpr_struct.hypotheses.hypothesis import SCALES
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.search import Search
from cdpr_struct.inference.screening import Screen


def minimum_detectable(search: Search, null: Judged) -> dict[str, dict[str, float | str]]:
    """Per cause the size found with probability 0.8 at a false alarm rate of 0.001; of several numbers their rms.

    Causes that would show only beyond the largest size that is considered are left out.
    """
    menu, screen = _menu(search, null)
    table: dict[str, dict[str, float | str]] = {}
    for cause in menu:
        pattern = plainest(cause.patterns)
        gram = screen.screened([part @ pattern.basis * pattern.prior for part in cause.columns]).gram
        if _shows(gram):
            table[cause.cause.name] = smallest(pattern, gram)
    return table


def detectable_by_pattern(search: Search, null: Judged) -> dict[str, list[dict[str, float | str]]]:
    """The same for every pattern of every cause that would show."""
    menu, screen = _menu(search, null)
    table: dict[str, list[dict[str, float | str]]] = {}
    for cause in menu:
        said = screen.screened(cause.columns)
        grams = [(p, of_pattern(p, said.gram, said.score)[0]) for p in cause.patterns]
        shown = [(p, g) for p, g in grams if _shows(g)]
        if shown and not cause.cause.tuned:
            table[cause.cause.name] = [smallest(p, g) for p, g in shown]
    return table


def _menu(search: Search, null: Judged) -> tuple[list[Offered], Screen]:
    """The causes of the library beside nothing wrong, and what their columns add there."""
    menu = [one for one in offered(search.data, search.where, search.seen, search.causes, null) if not one.laws]
    return menu, Screen.of(null.model, null.fit.noise, null.fit.soft)


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

"""Is an optimum the best there is, and where else to begin where none was found?

Cost and balance are sums over the cables, so with the multipliers y of an optimum the Lagrangian is a sum, too: of
phi(T_i) - y . wrench_i, a function of the cable's own chord tension alone. No tensions within the bounds cost less than
the sum of its least values. An optimum at which every cable has its least value is therefore the best of all. A cable
with its weight can have two minima, one slack at its bound and one taut, where its function bends down in between. Such
cables are looked at, and where the other minimum is deeper the search begins there.
"""

import numpy as np

from cdpr_struct.statics.distribution_problem import PATIENT, USUAL, DistributionProblem, Optimum, Tangent

_LOOKED_AT = 24  # chord tensions from floor to ceiling
_DEEPER = 1e-9  # of the cost
_ROUNDS = 3  # cables that change places, one after the other


def bettered(problem: DistributionProblem, optimum: Optimum, tangent: Tangent) -> bool:
    """Whether a search from the deeper minima of cables that bend down ends at better optima, which are put in place.

    tangent : at the optimum
    """
    items, found_better = np.flatnonzero(optimum.found), False
    there = tangent.take(items)
    for _ in range(_ROUNDS):
        start = _deeper(problem.take(items), optimum.take(items), there)
        deeper = np.isfinite(start[:, 0])
        items, there = items[deeper], there.take(deeper)
        if not items.size:
            break
        part = problem.take(items)
        other = part.search(start[deeper])
        after = part.tangent(other.chord_tension)
        better = other.found & (after.value < there.value)
        items, there = items[better], after.take(better)
        optimum.replaced(items, other.take(better))
        found_better = found_better or bool(better.any())
    return found_better


def searched_elsewhere(problem: DistributionProblem, optimum: Optimum, items: np.ndarray, near: np.ndarray) -> Optimum:
    """The optimum with some poses, `items` (n,), searched again: from chord tensions `near` (n, m) [N] that balance,
    from the least norm as `inverse` has it, then with patience, and from the poses beside them that are found."""
    optimum = optimum.replaced(items, problem.take(items).search(near))
    lost = items[~optimum.found[items]]
    if lost.size:
        start = problem.take(lost).holding.solve()[0]
        for effort in (USUAL, PATIENT):
            open_ = ~optimum.found[lost]
            if open_.any():
                found = problem.take(lost[open_]).search(start[open_], None, effort)
                optimum = optimum.replaced(lost[open_], found)
    lost = items[~optimum.found[items]]
    while lost.size:
        last = len(optimum.found) - 1
        beside = np.where(optimum.found[np.maximum(lost - 1, 0)], np.maximum(lost - 1, 0), np.minimum(lost + 1, last))
        begun = optimum.found[beside]
        found = problem.take(lost[begun]).search(optimum.chord_tension[beside[begun]], None, PATIENT)
        optimum = optimum.replaced(lost[begun][found.found], found.take(found.found))
        if not found.found.any():
            break
        lost = lost[~optimum.found[lost]]
    return optimum


def _deeper(problem: DistributionProblem, optimum: Optimum, tangent: Tangent) -> np.ndarray:
    """(k, m) chord tensions with cables in deeper minima of their own; nan where there are none."""
    tension = optimum.chord_tension
    start = np.full(tension.shape, np.nan)
    bends_down = problem.curvature(tangent, optimum.multiplier) < 0.0
    items = np.flatnonzero(bends_down.any(axis=1))
    if not items.size:
        return start
    part, dual = problem.take(items), optimum.multiplier[items]
    here = part.own_terms(tension[items], dual)
    ceiling = np.minimum(part.ceiling, np.maximum(4.0 * part.floor, 4.0 * tension[items].max(axis=1, keepdims=True)))
    least, at = np.zeros_like(here), tension[items]
    for share in np.linspace(0.0, 1.0, _LOOKED_AT):
        other = part.floor ** (1.0 - share) * ceiling**share
        gain = np.where(bends_down[items], part.own_terms(other, dual) - here, 0.0)
        at, least = np.where(gain < least, other, at), np.minimum(gain, least)
    gains = least.min(axis=1) < -_DEEPER * np.abs(here).sum(axis=1)
    start[items[gains]] = at[gains]
    return start

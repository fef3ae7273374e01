"""Is an optimum the best there is, and where else to begin where none was found?

Cost and balance are sums over the cables, so with the multipliers y of an optimum the Lagrangian is a sum, too: of
phi(T_i) - y . wrench_i, a function of the cable's own chord tension alone. No tensions within the bounds cost less than
the sum of its least values. An optimum at which every cable has its least value is therefore the best of all. A cable
with its weight can have two minima, one slack at its bound and one taut, where its function bends down in between. Such
cables are looked at, and where the other minimum is deeper the search begins there.
"""

import numpy as np

from cdpr_struct.statics.distribution_problem import PATIENT, USUAL, DistributionProblem, Optimum

_LOOKED_AT = 24  # chord tensions from floor to ceiling
_DEEPER = 1e-9  # of the cost
_ROUNDS = 3  # cables that change places, one after the other


def best_of_minima(problem: DistributionProblem, optimum: Optimum) -> Optimum:
    """The optimum, searched again from the deeper minimum of cables that bend down, and kept if it is better."""
    items = np.flatnonzero(optimum.found)
    for _ in range(_ROUNDS):
        part = problem.take(items)
        start = _deeper(part, optimum.take(items))
        items, start = items[np.isfinite(start[:, 0])], start[np.isfinite(start[:, 0])]
        if not items.size:
            break
        other = problem.take(items).search(start)
        better = other.found & (_cost(problem.take(items), other) < _cost(problem.take(items), optimum.take(items)))
        items, other = items[better], other.take(better)
        optimum = optimum.replaced(items, other)
    return optimum


def searched_elsewhere(problem: DistributionProblem, optimum: Optimum, items: np.ndarray, near: np.ndarray) -> Optimum:
    """The optimum with some poses, `items` (n,), searched again: from chord tensions `near` (n, m) [N] that balance,
    from the least norm as `inverse` has it, then with patience, and from the poses beside them that are found."""
    optimum = optimum.replaced(items, problem.take(items).search(near))
    for effort in (USUAL, PATIENT):
        lost = items[~optimum.found[items]]
        if lost.size:
            part = problem.take(lost)
            optimum = optimum.replaced(lost, part.search(part.holding.solve()[0], None, effort))
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


def _deeper(problem: DistributionProblem, optimum: Optimum) -> np.ndarray:
    """(k, m) chord tensions with one cable in a deeper minimum of its own; nan where there is none."""
    tension = optimum.chord_tension.copy()
    start = np.full(tension.shape, np.nan)
    bends_down = problem.curvature(problem.tangent(tension), optimum.multiplier) < 0.0
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


def _cost(problem: DistributionProblem, optimum: Optimum) -> np.ndarray:
    return problem.tangent(optimum.chord_tension).value

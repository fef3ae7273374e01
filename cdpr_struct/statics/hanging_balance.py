"""Chord tensions and free angles changed together by the least that balances a hanging platform to rounding.

Where cables act alike, tensions of least norm leave a little of a direction in which they cannot pull: 1e-8 of the load
where the search for the orientation ends. The orientation can make up for it.
"""

import numpy as np

from cdpr_struct.statics.hanging_search import HangingProblem, Hung

_ROUNDS = 3
_BALANCED = 1e-11  # of load and tensions
_DIFFERENCE = 1e-6  # [rad]
_RANK = 1e-9  # relative


def balanced_together(problem: HangingProblem, ends: Hung) -> Hung:
    """The same orientations, changed where something is left; an item keeps what left less."""
    left = _left(problem, ends)
    items = np.flatnonzero(ends.found & (left > _BALANCED))
    for _ in range(_ROUNDS):
        if not items.size:
            break
        part, before = problem.take(items), ends.take(items)
        tried = _changed(part, before)
        after = _left(part, tried)
        better = tried.found & (after < left[items])
        ends.replaced(items[better], tried.take(better))
        left[items[better]] = after[better]
        items = items[better & (after > _BALANCED)]
    return ends


def _left(problem: HangingProblem, ends: Hung) -> np.ndarray:
    """(k,) wrench left over, over load and tensions."""
    holding = problem.holding(ends.angles, ends.rotation)
    wrench = holding.linearised(ends.tension)[1]
    return np.asarray(np.linalg.norm(wrench, axis=1) / (np.linalg.norm(holding.load[:, :3], axis=1) + _pulls(ends)))


def _pulls(ends: Hung) -> np.ndarray:
    return np.asarray(ends.tension.sum(axis=1))


def _changed(problem: HangingProblem, ends: Hung) -> Hung:
    """One step of least norm in tensions, over their sum, and angles."""
    rate, wrench = problem.holding(ends.angles, ends.rotation).linearised(ends.tension)
    free, size = np.flatnonzero(problem.free), _pulls(ends)[:, None]
    turns = []
    for axis in free:
        shift = np.zeros_like(ends.angles)
        shift[:, axis] = _DIFFERENCE
        there = problem.reoriented(ends, shift)
        turns.append((problem.holding(*there).linearised(ends.tension)[1] - wrench) / _DIFFERENCE)
    rates = np.concatenate([rate * size[..., None], np.stack(turns, axis=-1)], axis=-1)
    step = -(np.linalg.pinv(rates, rcond=_RANK) @ wrench[..., None])[..., 0]
    count, turn = ends.tension.shape[1], np.zeros_like(ends.angles)
    turn[:, free] = step[:, count:]
    return problem.measured(*problem.reoriented(ends, turn), ends.tension + size * step[:, :count])

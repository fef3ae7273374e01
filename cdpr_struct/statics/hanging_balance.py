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
    items = np.flatnonzero(ends.found & (ends.left > _BALANCED))
    for _ in range(_ROUNDS):
        if not items.size:
            break
        tried = _changed(problem.take(items), ends.take(items))
        better = tried.found & (tried.left < ends.left[items])
        ends.replaced(items[better], tried.take(better))
        items = items[better & (tried.left > _BALANCED)]
    return ends


def _changed(problem: HangingProblem, ends: Hung) -> Hung:
    """One step of least norm in tensions, over their sum, and angles."""
    rate, wrench = problem.holding(ends.angles, ends.rotation).linearised(ends.tension)
    free, size = np.flatnonzero(problem.free), ends.tension.sum(axis=1)[:, None]
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
    there = problem.reoriented(ends, turn)
    return problem.measured(problem.holding(*there), *there, ends.tension + size * step[:, :count])

"""What is the lowest natural frequency of hanging cables whose ends are both held?

The equation of motion is (D u')' + mu omega^2 u = 0 with D = EA t t^T + G (1 - t t^T), t the tangent, T the tension and
G = T / (1 + T / EA). Since G < EA, D - G is nowhere negative: no frequency in the plane lies below the lowest out of
it, which is that of the string (G u')' + mu omega^2 u = 0.

Where the frame end gives way, it may be held more firmly out of the plane than in it. Then the first functions across
the cable in both directions are kept, all else is condensed at a shift, and the lowest eigenvalue of what is left is
the next shift, until the interval that it encloses is narrow (`condensed_robot.py`).
"""

import numpy as np

from cdpr_struct.dynamics.cables_of_poses import HangingCables, pieces
from cdpr_struct.dynamics.condensed_cables import condensed, quietly
from cdpr_struct.dynamics.frame_springs import FrameSprings, softened
from cdpr_struct.dynamics.lowest_eigenvalue import lowest_eigenvalue
from cdpr_struct.dynamics.string_functions import string_functions

_STEPS = 6
_ROUGH = 5  # order of the first step
_PROVED = 1e-10  # relative, of the squared frequency: width of the interval that a shift encloses it in


def lowest_clamped(cables: HangingCables, order: int) -> np.ndarray:
    """Lowest squared frequencies (m, n) [rad^2/s^2], by polynomials up to degree `order`; nan where the frame end gives
    way so much that it is not known to be the lowest."""
    if cables.frame is None:
        return _out_of_plane(cables, order)
    return _on_springs(cables, order, cables.frame)


def _out_of_plane(cables: HangingCables, order: int) -> np.ndarray:
    """From above; nan where it is not proved that no other lies below, as may be where the string's first function is
    far from the mode."""
    functions = string_functions(order)
    across = cables.out_of_plane(functions.nodes)
    blocks = (functions.pairs @ across.reshape(len(across), -1)).reshape((-1, *cables.length.shape))
    turned = np.r_[1 : functions.bubbles, 0]
    whole = blocks[functions.pair[np.ix_(turned, turned)]]
    squared, proved = lowest_eigenvalue(whole)
    return np.where(proved, squared / cables.per_squared, np.nan)


@quietly
def _on_springs(cables: HangingCables, order: int, frame: FrameSprings) -> np.ndarray:
    across = 0.5 * cables.length / (frame.give_across * cables.tension)
    squared = cables.tension * softened(across, order, 0) / cables.per_squared
    found, todo = np.full(squared.shape, np.nan), np.arange(squared.shape[1])
    for count in range(_STEPS):
        functions = string_functions(order if count else _ROUGH, True)
        for own in pieces(todo):
            condensed_here = condensed(cables.take(own), squared[:, own], functions, 1)
            step = np.min([_smallest(part.leads_own[0]) for part in condensed_here.parts], axis=0)
            left = condensed_here.of_cables - squared[:, own]
            squared[:, own] += step
            known = (
                (count > 0)
                & (left > 0.0)
                & (left + step > 0.0)
                & (step**2 <= _PROVED * squared[:, own] * (left + step))
            )
            found[:, own] = np.where(known, squared[:, own], np.nan)
        todo = todo[~np.isfinite(found[:, todo]).all(axis=0)]
        if not todo.size:
            break
    return found


def _smallest(block: np.ndarray) -> np.ndarray:
    """Smallest eigenvalue (...) of symmetric matrices (1, 1, ...) or (2, 2, ...)."""
    if len(block) == 1:
        return np.asarray(block[0, 0])
    mean, half = 0.5 * (block[0, 0] + block[1, 1]), 0.5 * (block[0, 0] - block[1, 1])
    return np.asarray(mean - np.hypot(half, block[0, 1]))

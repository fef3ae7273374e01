"""Which mode of the robot is its platform's, at very many poses?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.batched_modes import PROVED, REACH, Batch
from cdpr_struct.dynamics.cables_of_poses import pieces
from cdpr_struct.dynamics.condensed_cables import HIGHEST_TERM, condensed
from cdpr_struct.dynamics.condensed_robot import Pencil, pencil
from cdpr_struct.dynamics.corrected_ritz import corrected, least_below, most_below
from cdpr_struct.dynamics.mode_shapes import condensed_shapes, shape_size

_ATTEMPTS = ((1, 2.4), (2, 4.5), (3, 8.0), (6, np.inf), (8, np.inf))
"""Leads, and below which ratio of the squared massless frequency to the lowest string's they are tried."""
_LARGEST = 300  # order of an eigenproblem from which on the general solver is as fast
_WINDOW = 8
HARMONICS = 4  # of each cable, in the mode's shape
_PAST = 1.05  # the shift towards the platform's mode, over the squared massless frequency
_SEEN = 0.85  # of the eliminated motions' lowest squared frequency: so far modes are taken for known


@dataclass(frozen=True, slots=True, eq=False)
class PlatformMode:
    """The mode most like a motion of the platform, at n poses.

    squared : (n,) its squared frequency, nan where it is not proved
    share   : (n,) of that motion that it holds, by kinetic energy [-]; the rest is in other modes
    first   : (n,) about the squared first frequency of all modes, nan where even that is not known
    shape   : (n, d) see `mode_shapes`; nan where the mode is not proved
    """

    squared: np.ndarray
    share: np.ndarray
    first: np.ndarray
    shape: np.ndarray


def platform_mode(batch: Batch, massless: np.ndarray, momentum: np.ndarray, among: int) -> PlatformMode:
    """The mode, `among` so many first ones, whose platform motion is most like a wanted one.

    massless : (n,) squared frequency near which it is to be expected
    momentum : (n, 6) platform mass times that motion, of unit modal mass
    """
    n = len(massless)
    found, share, first = (np.full(n, np.nan) for _ in range(3))
    shape = np.full((n, shape_size(len(batch.strings), HARMONICS)), np.nan)
    ratio = massless / batch.lowest_string
    for leads, most in _ATTEMPTS:
        if 6 + 2 * leads * len(batch.strings) > _LARGEST:
            break
        todo = np.flatnonzero(~np.isfinite(found) & (ratio < most))
        for own in pieces(todo):
            wanted = massless[own], momentum[own]
            best = _most_alike(batch.take(own), wanted, leads, among)
            found[own], share[own], first[own], shape[own] = best.squared, best.share, best.first, best.shape
    return PlatformMode(found, share, first, shape)


def _most_alike(batch: Batch, wanted: tuple[np.ndarray, np.ndarray], leads: int, among: int) -> PlatformMode:
    massless, momentum = wanted
    string = batch.lowest_string
    shift = np.minimum(_PAST * massless, REACH * (leads + 1) ** 2 * string)
    functions = batch.functions(max(batch.order, 2 * leads + 5))
    own = condensed(batch.cables, shift, functions, leads, HIGHEST_TERM)
    small = pencil(batch.platform, own, shift)
    d, vectors = small.modes
    chosen, sure = _window(small, (d, vectors), momentum, among)
    values, shapes = np.take_along_axis(d, chosen, axis=1), np.take_along_axis(vectors, chosen[:, None], axis=2)
    squared, motion, turned = corrected(batch.platform, own, small, values, shapes)
    alike = np.einsum("ni,nis->ns", momentum, motion) ** 2
    best = alike.argmax(axis=1)[:, None]
    rank = np.take_along_axis(chosen, best, axis=1)[:, 0]
    found = np.take_along_axis(squared, best, axis=1)[:, 0]
    above = least_below(batch.platform, own, shift, found * (1.0 + 2.0 * PROVED)) > rank
    below = most_below(batch.platform, own, shift, found * (1.0 - 2.0 * PROVED)) <= rank
    proved = sure & above & below
    share = np.take_along_axis(alike, best, axis=1)[:, 0]
    first = np.where(shift < own.lowest, squared[:, 0], np.nan)
    turned, moved = (np.take_along_axis(part, best[:, None], axis=2) for part in (turned, motion))
    shape = condensed_shapes(batch.platform, moved, shapes[:, 6:] @ turned, functions, HARMONICS)[:, 0]
    found, share = (np.where(proved, values, np.nan) for values in (found, share))
    return PlatformMode(found, share, first, np.where(proved[:, None], shape, np.nan))


def _window(
    small: Pencil, modes: tuple[np.ndarray, np.ndarray], momentum: np.ndarray, among: int
) -> tuple[np.ndarray, np.ndarray]:
    """The first mode and those around the most alike one (n, s), and where no other can be more alike (n,): all that
    count lie within the shift's reach, or those beyond it have less in common with the motion altogether."""
    d, vectors = modes
    alike = small.shares(vectors, momentum)
    known = (small.shift[:, None] + d < _SEEN * small.lowest[:, None]) & (np.arange(d.shape[1]) < among)
    best = np.where(known, alike, -1.0).argmax(axis=1)
    row = np.arange(len(best))
    rest = np.where(known, 0.0, alike).sum(axis=1)
    size = min(_WINDOW, d.shape[1]) - 1
    start = np.clip(best - size // 2, 1, d.shape[1] - size)
    chosen = np.concatenate([np.zeros((len(best), 1), dtype=int), start[:, None] + np.arange(size)], axis=1)
    sure = (known.sum(axis=1) >= among) | (alike[row, best] > rest)
    return chosen, known[row, best] & sure

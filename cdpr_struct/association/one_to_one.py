"""Peaks and modes one to one: a mode leaves at most one peak in a list, and a peak comes from at most one mode.

    ln L = sum_j ln c_j + sum_mu ln(1 - P_mu) - lambda + ln sum over partial matchings of prod o_j,mu
    o_j,mu = P_mu N_j,mu / ((1 - P_mu) c_j)

The sum is taken by belief propagation, or exactly where the connected blocks of a list are small.
"""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cdpr_struct.association.belief_propagation import NEGLIGIBLE, bethe_matching
from cdpr_struct.association.detection import Clutter
from cdpr_struct.association.matching import Matching
from cdpr_struct.association.peaks import PeakLists
from cdpr_struct.association.subset_sum import subset_matching

LARGEST_EXACT = 12
"""Peaks or modes, whichever are fewer, of the largest block summed exactly: 4096 subsets, about 20 ms."""


def one_to_one_matching(
    density: np.ndarray,
    detection: np.ndarray,
    clutter: Clutter,
    peaks: PeakLists,
    slots: np.ndarray,
    exact: bool = False,
) -> Matching:
    """Assignment of the peaks of L lists.

    density (L, J, M) : density of a peak in ln f under each mode [-], 0 where the pair is excluded
    detection (L, M) : probability that the mode leaves a peak in the list [-]
    slots (L, M) : neighbouring modes, see `belief_propagation.neighbours`
    exact : sum exactly in blocks of up to LARGEST_EXACT peaks or modes
    """
    odds = density * (detection / (1.0 - detection))[:, None, :] / clutter.density[:, :, None]
    pair, log_sum = exact_sums(odds, slots) if exact else bethe_matching(odds, slots)
    alone = np.where(peaks.present, np.log(clutter.density), 0.0).sum(axis=1)
    return Matching(pair, alone + np.log1p(-detection).sum(axis=1) - clutter.expected + log_sum)


def exact_sums(odds: np.ndarray, slots: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Probability (L, J, M) of each pair and ln (L,) of the sum, block by block; propagation for blocks too large."""
    pair, log_sum = np.zeros(odds.shape), np.zeros(len(odds))
    for row, table in enumerate(odds):
        for peaks, modes in _blocks(table):
            block = np.ix_(peaks, modes)
            if min(len(peaks), len(modes)) <= LARGEST_EXACT:
                pair[row][block], log_block = subset_matching(table[block])
            else:
                together = np.unique(slots[row, modes] // 2, return_inverse=True)[1]
                found, logs = bethe_matching(table[block][None], (2 * together + slots[row, modes] % 2)[None])
                pair[row][block], log_block = found[0], float(logs[0])
            log_sum[row] += log_block
    return pair, log_sum


def _blocks(odds: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Peaks and modes of every connected block of a table (J, M) of odds."""
    peaks, modes = odds.shape
    peak, mode = np.nonzero(odds > NEGLIGIBLE)
    graph = coo_array((np.ones(len(peak)), (peak, peaks + mode)), shape=(peaks + modes, peaks + modes))
    label = connected_components(graph, directed=False)[1]
    return [
        (np.flatnonzero(label[:peaks] == name), np.flatnonzero(label[peaks:] == name))
        for name in np.unique(label[peak])
    ]

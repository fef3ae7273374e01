"""Peaks as a Poisson process: every mode and the clutter emit peaks independently of each other.

    ln L = sum_j ln(c_j + sum_mu P_mu N_j,mu) - sum_mu P_mu - lambda

A mode may emit two peaks, and a mode that stays silent costs P_mu instead of -ln(1 - P_mu); in exchange the sum over
all assignments is closed.
"""

import numpy as np

from cdpr_struct.association.detection import Clutter
from cdpr_struct.association.matching import Matching
from cdpr_struct.association.peaks import PeakLists


def poisson_matching(density: np.ndarray, detection: np.ndarray, clutter: Clutter, peaks: PeakLists) -> Matching:
    """Assignment of the peaks of L lists.

    density (L, J, M) : density of a peak in ln f under each mode [-], 0 where the pair is excluded
    detection (L, M) : probability that the mode leaves a peak in the list [-]
    """
    pair = density * detection[:, None, :]
    intensity = pair.sum(axis=2) + clutter.density
    pair /= intensity[:, :, None]
    logs = np.where(peaks.present, np.log(intensity), 0.0).sum(axis=1)
    return Matching(pair, logs - detection.sum(axis=1) - clutter.expected)

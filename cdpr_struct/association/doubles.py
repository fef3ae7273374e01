"""Modes so close that a picker sees one peak: how many peaks do they leave?"""

import numpy as np

MERGED_WITHIN = 0.01
"""Distance in ln f [-] within which two modes tend to be picked as one peak: the width of a peak of half a percent of
damping, 2 zeta."""


def detection_of_doubles(
    ln_frequency: np.ndarray, detection: np.ndarray, merged_within: float = MERGED_WITHIN
) -> np.ndarray:
    """Detection probabilities (L, M) lowered for close neighbours; ln_frequency [ln Hz] of the same shape.

    Two modes that coincide leave one peak with probability 1 - (1 - P1)(1 - P2), so each is detected with half the
    product less, P1 - P1 P2 / 2. With distance this fades as exp(-(distance / merged_within)^2 / 2).

    The modes stay two: the merged peak lies between them, and the scales of the peak's error allow for that. One row
    that stands for both loses what tells them apart, and is wrong once they part.
    """
    distance = (ln_frequency[:, :, None] - ln_frequency[:, None, :]) / merged_within
    lost = 0.5 * np.exp(-0.5 * distance**2) * detection[:, None, :]
    lost[:, np.arange(detection.shape[1]), np.arange(detection.shape[1])] = 0.0
    return detection * np.prod(1.0 - lost, axis=2)

"""Modes that the model predicts, and which peaks each of them may have caused."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.peaks import UNLABELLED, PeakLists


@dataclass(frozen=True, slots=True, eq=False)
class PredictedModes:
    """Modes of K states, padded to M, and how likely each of them leaves a peak in each of L lists.

    ln_frequency (K, M) : at the point of linearisation [ln Hz]; padding: any finite number
    detection (L, M) : probability of a peak in the list [-], in [0, 1); 0 for padding and outside the list's band
    cable, order (K, M) int : cable and number of its mode, UNLABELLED for modes of the robot
    """

    ln_frequency: np.ndarray
    detection: np.ndarray
    cable: np.ndarray
    order: np.ndarray

    def __post_init__(self) -> None:
        if not np.isfinite(self.ln_frequency).all():
            raise ValueError("PredictedModes.ln_frequency must be finite; pad with 0 and detection 0")
        if not ((self.detection >= 0.0) & (self.detection < 1.0)).all():
            raise ValueError("PredictedModes.detection must be a probability in [0, 1)")
        for name in ("cable", "order"):
            if getattr(self, name).shape != self.ln_frequency.shape:
                raise ValueError(f"PredictedModes.{name} must have the shape {self.ln_frequency.shape}")


def robot_modes(ln_frequency: np.ndarray, detection: np.ndarray) -> PredictedModes:
    """Modes without labels, one list per state: ln_frequency and detection (K, M)."""
    ln_frequency = np.asarray(ln_frequency, float)
    none = np.full(ln_frequency.shape, UNLABELLED)
    return PredictedModes(ln_frequency, np.asarray(detection, float), none, none)


def allowed_pairs(peaks: PeakLists, modes: PredictedModes) -> np.ndarray:
    """(L, J, M) bool: pairs of an existing peak and a detectable mode that no label forbids."""
    pair = peaks.present[:, :, None] & (modes.detection > 0.0)[:, None, :]
    for name in ("cable", "order"):
        said, have = getattr(peaks, name)[:, :, None], getattr(modes, name)[peaks.state][:, None, :]
        pair = pair & ((said == UNLABELLED) | (said == have))
    return pair

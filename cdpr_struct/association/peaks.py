"""Lists of measured peaks as padded arrays."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

KINDS = ("robot", "cable")
"""Kinds of list: picked from a sensor on the platform, or on a cable. Each kind has its own noise."""
UNLABELLED = -1


@dataclass(frozen=True, slots=True, eq=False)
class PeakList:
    """One picked list: the peaks of one sensor in one state of the robot.

    frequency (J,) [Hz] ; sd (J,) of ln frequency [-], as stated by whoever picked the peaks
    band : lowest and highest frequency [Hz] that was searched for peaks
    state : index of the state ; kind : index into KINDS
    cable, order (J,) : cable and number of its mode if a label says so, else UNLABELLED
    """

    frequency: np.ndarray
    sd: np.ndarray
    band: tuple[float, float]
    state: int = 0
    kind: int = 0
    cable: np.ndarray | None = None
    order: np.ndarray | None = None

    def __post_init__(self) -> None:
        frequency, sd, (low, high) = np.asarray(self.frequency, float), np.asarray(self.sd, float), self.band
        if not 0.0 < low < high:
            raise ValueError(f"PeakList.band must rise from a positive frequency, got {self.band!r}")
        if frequency.ndim != 1 or not ((frequency >= low) & (frequency <= high)).all():
            raise ValueError(f"PeakList.frequency must lie in the band {self.band!r} Hz, got {self.frequency!r}")
        if sd.shape != frequency.shape or not (sd > 0.0).all():
            raise ValueError(f"PeakList.sd must be positive, one per peak, got {self.sd!r}")
        if not 0 <= self.kind < len(KINDS):
            raise ValueError(f"PeakList.kind must be an index into {KINDS}, got {self.kind!r}")
        object.__setattr__(self, "frequency", frequency)
        object.__setattr__(self, "sd", sd)


@dataclass(frozen=True, slots=True, eq=False)
class PeakLists:
    """L lists of up to J peaks, padded.

    ln_frequency, sd (L, J) : ln of Hz and its sd [-]; padding has ln_frequency 0 and sd 1
    present (L, J) bool : peaks that exist
    cable, order (L, J) int : labels, UNLABELLED where there is none
    band (L, 2) : ln of the lowest and highest frequency searched [ln Hz]
    state, kind (L,) int : the state a list belongs to, and its index into KINDS
    """

    ln_frequency: np.ndarray
    sd: np.ndarray
    present: np.ndarray
    cable: np.ndarray
    order: np.ndarray
    band: np.ndarray
    state: np.ndarray
    kind: np.ndarray

    def __post_init__(self) -> None:
        for name in self.__slots__:
            getattr(self, name).setflags(write=False)

    @property
    def bandwidth(self) -> np.ndarray:
        """(L,) width of the band in ln f [-]."""
        return self.band[:, 1] - self.band[:, 0]

    @property
    def count(self) -> np.ndarray:
        """(L,) number of peaks."""
        return self.present.sum(axis=1)


def padded(lists: Sequence[PeakList]) -> PeakLists:
    """Lists of unequal length as one set of arrays, in the order given."""
    width = max((len(item.frequency) for item in lists), default=0)
    shape = (len(lists), width)
    ln_frequency, sd, present = np.zeros(shape), np.ones(shape), np.zeros(shape, bool)
    cable, order = np.full(shape, UNLABELLED), np.full(shape, UNLABELLED)
    for row, item in enumerate(lists):
        here = (row, slice(len(item.frequency)))
        ln_frequency[here], sd[here], present[here] = np.log(item.frequency), item.sd, True
        cable[here] = UNLABELLED if item.cable is None else item.cable
        order[here] = UNLABELLED if item.order is None else item.order
    band = np.log(np.array([item.band for item in lists], float).reshape(-1, 2))
    state, kind = (np.array([getattr(item, name) for item in lists], int) for name in ("state", "kind"))
    return PeakLists(ln_frequency, sd, present, cable, order, band, state, kind)

"""What is kept of a recording whose frames were condensed: how fast things moved, how much each state stands for."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Of S states that were chosen among the frames of motions; what they stand for is known from all frames.

    rate (S, m, 2) : derivatives of the encoders' lengths [m/s, m/s^2], acceleration (S,) : of the platform [m/s^2]; 0
    in states at rest
    count (S,) : frames that each state stands for, itself among them; 1 of states that are no frames
    worth : number of independent frames that hold as much as all
    """

    rate: np.ndarray
    acceleration: np.ndarray
    count: np.ndarray
    worth: float

    @property
    def of(self) -> int:
        """Number of frames, states at rest among them."""
        return int(self.count.sum())

    def scaled(self, factor: float) -> "Frames":
        """With lengths in another unit."""
        return replace(self, rate=self.rate * factor)

    def in_order(self, cables: np.ndarray) -> "Frames":
        """With the encoders of the cables in another order (m,)."""
        return replace(self, rate=self.rate[:, cables])

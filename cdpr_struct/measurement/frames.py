"""What is kept of a recording whose frames were condensed: how fast things moved, how much each state stands for."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Of S states that were chosen among the frames of motions; what they stand for is known from all frames.

    rate, pull (S, m, 2) : derivatives of lengths [m/s, m/s^2] and of tensions [N/s, N/s^2] as they were read
    inertial (S, 6) : acceleration of the platform's origin [m/s^2], angular acceleration [rad/s^2], world axes
    acceleration (S,) : of it what is not known [m/s^2];  all four 0 in states at rest
    count (S,) : frames that each state stands for, itself among them; 1 of states that are no frames
    worth : number of independent frames that hold as much as all
    """

    rate: np.ndarray
    pull: np.ndarray
    inertial: np.ndarray
    acceleration: np.ndarray
    count: np.ndarray
    worth: float

    @property
    def of(self) -> int:
        """Number of frames, states at rest among them."""
        return int(self.count.sum())

    def scaled(self, what: str, factor: float | np.ndarray) -> "Frames":
        """With lengths, tensions or positions in another unit, one factor or one a cable (m,) or axis (3,)."""
        if what == "length":
            return replace(self, rate=self.rate * _each(factor))
        if what == "tension":
            return replace(self, pull=self.pull * _each(factor))
        if what == "position":
            return replace(self, inertial=self.inertial * np.append(np.ones(3) * factor, np.ones(3)))
        return self

    def in_order(self, what: str, cables: np.ndarray) -> "Frames":
        """With the encoders, or the load cells, of the cables in another order (m,)."""
        if what == "length":
            return replace(self, rate=self.rate[:, cables])
        return replace(self, pull=self.pull[:, cables])

    def in_axes(self, axes: np.ndarray) -> "Frames":
        """With poses in another frame: position = axes @ written, (3, 3); a mirrored one turns the other way."""
        turned = np.linalg.det(axes) * self.inertial[:, 3:] @ axes.T
        return replace(self, inertial=np.concatenate([self.inertial[:, :3] @ axes.T, turned], axis=1))


def _each(factor: float | np.ndarray) -> np.ndarray:
    return np.asarray(factor)[..., None]

"""Rows whose reading is a mixture, such as peaks that may belong to any mode: what does `fit` ask of them?"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class SoftExpectation:
    """A mixture at fixed responsibilities: one Gaussian pseudo-reading per soft row, and a constant.

    Its share of the bound is  constant - sum precision/2 E[(value - prediction)^2].

    value     : (K, s) relative to the linearisation point, in the unit of the prediction
    precision : (K, s) zero drops the row
    constant  : everything else in the bound [nat]: normalisers, entropy of the responsibilities, missed detections
    """

    value: np.ndarray
    precision: np.ndarray
    constant: float

    def __post_init__(self) -> None:
        if self.value.shape != self.precision.shape or self.value.ndim != 2:
            raise ValueError(f"value {self.value.shape} and precision {self.precision.shape} must both be (K, s)")
        if not ((self.precision >= 0.0).all() and np.isfinite(self.precision).all() and np.isfinite(self.value).all()):
            raise ValueError("SoftExpectation needs finite values and finite precisions that are not negative")

    @classmethod
    def none(cls, blocks: int, rows: int) -> "SoftExpectation":
        """No row is read."""
        return cls(np.zeros((blocks, rows)), np.zeros((blocks, rows)), 0.0)


class SoftRows(Protocol):
    """Readings that are a mixture given the prediction of each soft row."""

    def expect(self, mean: np.ndarray, variance: np.ndarray) -> SoftExpectation:
        """Best responsibilities where predictions have this mean and variance, both (K, s).

        The bound of `fit` never falls if the answer maximises constant - sum precision/2 ((value - mean)^2 + variance)
        over the responsibilities.
        """
        ...

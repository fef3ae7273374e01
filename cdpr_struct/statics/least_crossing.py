"""By how much must bounds give way at least, so that a platform is balanced? A linear program at one pose.

    minimise  sum_i (a_i + b_i)   subject to   J t = target,   low_i - b_i <= t_i <= high_i + a_i,   a, b >= 0.

A sum of absolute values is least where few of them are not zero: the answer names the cables that are in the way.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

_LATER = 1e-6  # how much dearer each next cable is: of cables alike by symmetry the first one is named


@dataclass(frozen=True, slots=True, eq=False)
class LeastCrossing:
    """above, below : (m,) how far tensions must lie beyond their bounds [N]."""

    above: np.ndarray
    below: np.ndarray

    @property
    def cable(self) -> int:
        """The cable whose bound gives way most, from 0; of equal ones the first."""
        amounts = np.maximum(self.above, self.below)
        return int(np.flatnonzero(amounts >= (1.0 - _LATER) * amounts.max())[0])

    @property
    def amount(self) -> float:
        """By how much [N]."""
        return float(max(self.above[self.cable], self.below[self.cable]))

    @property
    def is_low(self) -> bool:
        """Whether it is the lower bound."""
        return bool(self.below[self.cable] >= self.above[self.cable])

    def said(self, low: np.ndarray, high: np.ndarray, lower: str = "the lower", upper: str = "the upper") -> str:
        """The worst cable and its bound, of (m,) [N], as a sentence's end."""
        cable, amount = self.cable, self.amount
        bound = float((low if self.is_low else high)[cable])
        side, sign = (f"below {lower}", -1.0) if self.is_low else (f"above {upper}", 1.0)
        need = f"{bound + sign * amount:.4g} N, {amount:.4g} N {side} bound {bound:.4g} N"
        return f"cable {cable + 1} would need {need}"


def least_crossing(matrix: np.ndarray, target: np.ndarray, low: np.ndarray, high: np.ndarray) -> LeastCrossing | None:
    """Bounds that are in the way; None if no tensions balance, whatever the bounds.

    matrix, target : (n, m), (n,) of the balance;  low, high : (m,) bounds on t [N]
    """
    m = matrix.shape[1]
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    spanned = values > 1e-9 * values[0]  # equations that rounding alone would make contradict each other are left out
    balance, wanted = values[spanned, None] * right[spanned], left.T[spanned] @ target
    ones = 1.0 + _LATER * np.arange(m)
    prices = np.concatenate([np.zeros(m), ones, ones])
    limits = [*zip(low, high, strict=True), *[(0.0, None)] * (2 * m)]
    found = linprog(prices, A_eq=np.concatenate([balance, balance, -balance], axis=1), b_eq=wanted, bounds=limits)
    return None if found.x is None else LeastCrossing(found.x[m : 2 * m], found.x[2 * m :])

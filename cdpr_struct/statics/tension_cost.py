"""What a tension distribution minimises: a sum over the cables of a convex function of the tension, chosen by name.

    sum_i phi(T_i),   T_i the tension of cable i at the platform.

A sum over cables has a diagonal second derivative, which the solver of `tension_distribution` lives on.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

Derivatives = tuple[np.ndarray, np.ndarray, np.ndarray]
"""phi, phi', phi'' of each cable (k, m)."""


class TensionCost(Protocol):
    """One cost.

    interior : it grows without limit towards the bounds, so that the solver has to stay off them
    """

    @property
    def name(self) -> str: ...

    @property
    def interior(self) -> bool: ...

    def terms(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray, unit: np.ndarray) -> Derivatives:
        """Terms [N^2, N, -] at tensions (k, m) [N] within bounds (k, m) [N]; unit (k, 1) [N] is their size."""

    def total(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(...) the number to report for tensions (..., m)."""


@dataclass(frozen=True, slots=True, eq=False)
class EuclideanNorm:
    """Euclidean norm of the tensions, weighted if wanted: sqrt(sum w_i T_i^2) [N]; section 5.1.3 has w = 1.

    weights : (m,) > 0, or None
    """

    weights: np.ndarray | None = None
    interior: bool = False

    def __post_init__(self) -> None:
        if self.weights is not None and not ((self.weights > 0.0) & np.isfinite(self.weights)).all():
            raise ValueError(f"weights must be positive, got {self.weights.tolist()}")

    @property
    def name(self) -> str:
        return "norm" if self.weights is None else "weighted-norm"

    def terms(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray, unit: np.ndarray) -> Derivatives:
        w = np.ones(tension.shape) if self.weights is None else np.broadcast_to(self.weights, tension.shape)
        return 0.5 * w * tension**2, w * tension, w

    def total(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        w = 1.0 if self.weights is None else self.weights
        return np.sqrt((w * tension**2).sum(axis=-1))


@dataclass(frozen=True, slots=True)
class PowerNorm:
    """p-norm of the tensions (sum T_i^p)^(1/p) [N]: the larger p, the more it is the largest tension that counts."""

    power: float
    interior: bool = False

    def __post_init__(self) -> None:
        if not 1.1 <= self.power <= 6.0:
            raise ValueError(f"power must be from 1.1 to 6, got {self.power!r}")

    @property
    def name(self) -> str:
        return "p-norm"

    def terms(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray, unit: np.ndarray) -> Derivatives:
        p = self.power
        share = np.maximum(tension / unit, 1e-9)
        return unit**2 * share**p / p, unit * share ** (p - 1.0), (p - 1.0) * share ** (p - 2.0)

    def total(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        unit = tension.max(axis=-1, keepdims=True)
        total: np.ndarray = unit[..., 0] * ((tension / unit) ** self.power).sum(axis=-1) ** (1.0 / self.power)
        return total


@dataclass(frozen=True, slots=True)
class Middle:
    """Distance of the tensions from the middle of their bounds [N]."""

    name: str = "middle"
    interior: bool = False

    def terms(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray, unit: np.ndarray) -> Derivatives:
        off = tension - 0.5 * (low + high)
        return 0.5 * off**2, off, np.ones_like(off)

    def total(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        return np.linalg.norm(tension - 0.5 * (low + high), axis=-1)


@dataclass(frozen=True, slots=True)
class Centre:
    """Analytic centre of the feasible set: the largest product of the distances to all bounds.

    Its total is the geometric mean of the distances' inverses [1/N].
    """

    name: str = "centre"
    interior: bool = True

    def terms(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray, unit: np.ndarray) -> Derivatives:
        above, below = tension - low, high - tension
        value = -np.log(np.maximum(above, 1e-300) / unit) - np.log(np.maximum(below, 1e-300) / unit)
        slope, curvature = 1.0 / below - 1.0 / above, 1.0 / above**2 + 1.0 / below**2
        return unit**2 * value, unit**2 * slope, unit**2 * curvature

    def total(self, tension: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        gaps = np.concatenate([tension - low, high - tension], axis=-1)
        return np.exp(-np.log(np.maximum(gaps, 1e-300)).mean(axis=-1))

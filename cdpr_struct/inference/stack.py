"""Blocks of one size, stacked: which errors and parameters make which residual?

r_k = A_k u_k + X_k z + e_k,    z ~ N(0, I),    e_k ~ N(0, diag(floor^2)),    u: see `scale_mixture`
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.inference.scale_mixture import PADDING, UNIT


@dataclass(frozen=True, slots=True, eq=False)
class Stack:
    """Residuals of K blocks of n rows, in any unit, the same throughout a row.

    r      : (K, n) residual at the linearisation point; ignored in soft rows
    A      : (K, n, q) change of the residual per stated sigma of each reading
    X      : (K, n, t) change of the residual per prior sigma of each parameter z
    floor  : (K, n) standard deviation of the model itself; may be 0 where A A' has full rank; ignored in soft rows
    index  : (K, q) group of each reading, which may lie in other stacks too; UNIT for a variance of one
    soft   : (s,) positions of the soft rows, the same in each block; their prediction is A u + X z

    Blocks smaller than others of their stack are padded: rows of r = 0, A = X = 0, floor = 1; readings of A = 0 and
    index PADDING.
    """

    r: np.ndarray
    A: np.ndarray
    X: np.ndarray
    floor: np.ndarray
    index: np.ndarray
    soft: np.ndarray

    def __post_init__(self) -> None:
        for name in ("r", "A", "X", "floor"):
            value = np.array(getattr(self, name), dtype=float)
            if not np.isfinite(value).all():
                raise ValueError(f"Stack.{name} must be finite")
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        for name in ("index", "soft"):
            whole = np.array(getattr(self, name), dtype=int)
            whole.setflags(write=False)
            object.__setattr__(self, name, whole)
        self._check()

    def _check(self) -> None:
        shape = self.r.shape
        if len(shape) != 2 or self.index.ndim != 2 or self.A.shape != (*shape, self.index.shape[1]):
            raise ValueError(f"r {shape}, A {self.A.shape} and index {self.index.shape} do not fit together")
        if self.X.shape[:-1] != shape or self.X.ndim != 3 or self.floor.shape != shape or len(self.index) != shape[0]:
            raise ValueError(
                f"X {self.X.shape}, floor {self.floor.shape}, index {self.index.shape} do not fit r {shape}"
            )
        if (self.floor < 0.0).any():
            raise ValueError("Stack.floor must not be negative")
        if self.soft.ndim != 1 or len(set(self.soft.tolist())) < len(self.soft):
            raise ValueError(f"Stack.soft must be a list of different rows, got {self.soft.tolist()}")
        if len(self.soft) and not (self.soft.min() >= 0 and self.soft.max() < shape[1]):
            raise ValueError(f"Stack.soft must lie within 0 and {shape[1] - 1}, got {self.soft.tolist()}")
        if np.any(self.A.swapaxes(1, 2)[self.index == PADDING]):
            raise ValueError(f"Stack.A must be zero for readings of index {PADDING}")

    @property
    def hard(self) -> np.ndarray:
        """(n,) rows that are read directly."""
        return ~np.isin(np.arange(self.r.shape[1]), self.soft)

    def with_columns(self, more: np.ndarray) -> "Stack":
        """The same data with more parameters, columns (K, n, d) per prior sigma, behind the present ones."""
        return replace(self, X=np.concatenate((self.X, more), axis=2))

    def with_noise(self, more: np.ndarray) -> "Stack":
        """The same data with more noise, columns (K, n, e) of variance one, behind the present readings."""
        index = np.full((len(self.index), more.shape[2]), UNIT)
        return replace(self, A=np.concatenate((self.A, more), axis=2), index=np.hstack((self.index, index)))

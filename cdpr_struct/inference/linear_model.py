"""A campaign, linearised: which errors and parameters make which residual?

    r_k = A_k u_k + X_k z + e_k,    z ~ N(0, I),    e_k ~ N(0, diag(floor^2)),    u: see `scale_mixture`

Blocks k (states of the robot) share z only, and the scales of u. All blocks are padded to common sizes.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.inference.scale_mixture import NoiseGroups


@dataclass(frozen=True, slots=True, eq=False)
class LinearModel:
    """Residuals of K blocks of n rows, in any unit, the same throughout a row.

    r      : (K, n) residual at the linearisation point; ignored in soft rows
    A      : (K, n, q) change of the residual per stated sigma of each reading
    X      : (K, n, t) change of the residual per prior sigma of each parameter z
    floor  : (K, n) standard deviation of the model itself; may be 0 where A A' has full rank; ignored in soft rows
    groups : scales of the readings' noise, index (K, q)
    soft   : (s,) positions of the soft rows, the same in each block; their prediction is A u + X z

    Padding rows have r = 0, A = X = 0, floor = 1; padding readings have index -1 and A = 0.
    """

    r: np.ndarray
    A: np.ndarray
    X: np.ndarray
    floor: np.ndarray
    groups: NoiseGroups
    soft: np.ndarray

    def __post_init__(self) -> None:
        for name in ("r", "A", "X", "floor"):
            value = np.array(getattr(self, name), dtype=float)
            if not np.isfinite(value).all():
                raise ValueError(f"LinearModel.{name} must be finite")
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        soft = np.array(self.soft, dtype=int)
        soft.setflags(write=False)
        object.__setattr__(self, "soft", soft)
        self._check()

    def _check(self) -> None:
        shape, readings = self.r.shape, self.groups.index.shape[1]
        if len(shape) != 2 or self.A.shape != (*shape, readings) or self.groups.index.shape[0] != shape[0]:
            raise ValueError(f"r {shape}, A {self.A.shape} and index {self.groups.index.shape} do not fit together")
        if self.X.shape[:-1] != shape or self.X.ndim != 3 or self.floor.shape != shape:
            raise ValueError(f"X {self.X.shape} and floor {self.floor.shape} do not fit r {shape}")
        if (self.floor < 0.0).any():
            raise ValueError("LinearModel.floor must not be negative")
        if self.soft.ndim != 1 or len(set(self.soft.tolist())) < len(self.soft):
            raise ValueError(f"LinearModel.soft must be a list of different rows, got {self.soft.tolist()}")
        if len(self.soft) and not (self.soft.min() >= 0 and self.soft.max() < shape[1]):
            raise ValueError(f"LinearModel.soft must lie within 0 and {shape[1] - 1}, got {self.soft.tolist()}")
        if np.any(self.A.swapaxes(1, 2)[self.groups.index < 0]):
            raise ValueError("LinearModel.A must be zero for readings of index -1")

    @property
    def parameters(self) -> int:
        """Number t of parameters z."""
        return self.X.shape[2]

    @property
    def hard(self) -> np.ndarray:
        """(n,) rows that are read directly."""
        return ~np.isin(np.arange(self.r.shape[1]), self.soft)

    def with_columns(self, more: np.ndarray) -> "LinearModel":
        """The same data with more parameters, columns (K, n, d) per prior sigma, behind the present ones."""
        return replace(self, X=np.concatenate((self.X, more), axis=2))

    def with_residual(self, r: np.ndarray) -> "LinearModel":
        """The same model of other data, (K, n)."""
        return replace(self, r=r)

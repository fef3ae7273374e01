"""How are rows of any unit made comparable? By the noise that their stated sigmas give them.

Hard rows are multiplied by the inverse Cholesky factor of A A' + diag(floor^2), readings of index UNIT left out. The
evidence of the white rows does not depend on which equivalent residual was chosen, so points of linearisation compare.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dtrtri

from cdpr_struct.inference.scale_mixture import UNIT
from cdpr_struct.inference.stack import Stack


@dataclass(frozen=True, slots=True, eq=False)
class WhiteStack:
    """Rows of a stack; hard ones white at the stated sigmas, soft ones as they are.

    whitening : (K, n, n) lower triangular, identity for soft rows
    r, A, X   : (K, n), (K, n, q), (K, n, t); r is zero in soft rows
    noise     : (K, n, n) covariance of the model floor; identity for soft rows
    soft      : (s,) soft rows
    rows      : number of hard rows without padding
    """

    whitening: np.ndarray
    r: np.ndarray
    A: np.ndarray
    X: np.ndarray
    noise: np.ndarray
    soft: np.ndarray
    rows: int

    @classmethod
    def of(cls, stack: Stack) -> "WhiteStack":
        """Raises ValueError if hard rows of a block have no independent noise."""
        hard = stack.hard
        floor = np.where(hard, stack.floor, 1.0)
        noise = np.zeros((*floor.shape, floor.shape[1]))
        np.einsum("kii->ki", noise)[...] = floor**2
        read = stack.A * hard[:, None] * (stack.index != UNIT)[:, None]
        try:
            factor = np.linalg.cholesky(read @ read.swapaxes(1, 2) + noise)
        except np.linalg.LinAlgError as error:
            message = "hard rows of a block have no independent noise: give Stack.floor a positive value there"
            raise ValueError(message) from error
        whitening = inverse_factor(factor)
        empty = (stack.r == 0.0) & (stack.floor == 1.0) & ~stack.A.any(axis=2) & ~stack.X.any(axis=2)
        return cls(
            whitening,
            (whitening @ (stack.r * hard)[..., None])[..., 0],
            whitening @ stack.A,
            whitening @ stack.X,
            (whitening * floor[:, None] ** 2) @ whitening.swapaxes(1, 2),
            stack.soft,
            int((hard & ~empty).sum()),
        )


@dataclass(frozen=True, slots=True, eq=False)
class WhiteRows:
    """White rows of all stacks.

    parts : where the rows of each stack stand among those of all blocks
    """

    stacks: tuple[WhiteStack, ...]
    parts: tuple[slice, ...]

    @classmethod
    def of(cls, stacks: Sequence[Stack]) -> "WhiteRows":
        """Raises ValueError if hard rows of a block have no independent noise."""
        ends = np.cumsum([0, *(stack.r.size for stack in stacks)]).tolist()
        white = tuple(WhiteStack.of(stack) for stack in stacks)
        return cls(white, tuple(map(slice, ends[:-1], ends[1:])))

    @property
    def count(self) -> int:
        """Number of rows of all blocks, soft ones and padding included."""
        return self.parts[-1].stop

    @property
    def rows(self) -> int:
        """Number of hard rows without padding."""
        return sum(stack.rows for stack in self.stacks)

    @property
    def parameters(self) -> int:
        """Number t of parameters."""
        return self.stacks[0].X.shape[2]


def inverse_factor(factor: np.ndarray) -> np.ndarray:
    """Inverses of lower triangular matrices (K, n, n)."""
    found = np.empty_like(factor)
    for k, one in enumerate(factor):
        found[k] = dtrtri(one.T)[0].T
    return found

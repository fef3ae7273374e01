"""How are rows of any unit made comparable? By the noise that their stated sigmas give them.

Hard rows are multiplied by the inverse Cholesky factor of A A' + diag(floor^2). The evidence of the white rows does
not depend on which equivalent residual was chosen, so points of linearisation compare.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.linear_model import LinearModel


@dataclass(frozen=True, slots=True, eq=False)
class WhiteRows:
    """Rows of a linear model; hard ones white at the stated sigmas, soft ones as they are.

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
    def of(cls, model: LinearModel) -> "WhiteRows":
        """Raises ValueError if hard rows of a block have no independent noise."""
        hard = model.hard
        floor = np.where(hard, model.floor, 1.0)
        noise = np.zeros((*floor.shape, floor.shape[1]))
        np.einsum("kii->ki", noise)[...] = floor**2
        read = model.A * hard[:, None]
        try:
            factor = np.linalg.cholesky(read @ read.swapaxes(1, 2) + noise)
        except np.linalg.LinAlgError as error:
            message = "hard rows of a block have no independent noise: give LinearModel.floor a positive value there"
            raise ValueError(message) from error
        whitening = np.linalg.inv(factor)
        empty = (model.r == 0.0) & (model.floor == 1.0) & ~model.A.any(axis=2) & ~model.X.any(axis=2)
        return cls(
            whitening,
            (whitening @ (model.r * hard)[..., None])[..., 0],
            whitening @ model.A,
            whitening @ model.X,
            whitening @ noise @ whitening.swapaxes(1, 2),
            model.soft,
            int((hard & ~empty).sum()),
        )

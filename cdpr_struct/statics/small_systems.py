"""Small symmetric systems at very many poses: matrices lie as (i, j, ...) arrays whose last axes are the batch.

Eliminating with operations on long vectors costs a fraction of one LAPACK call a matrix.
"""

import numpy as np


def cholesky(matrix: np.ndarray) -> np.ndarray:
    """Lower factor (i, j, ...) of symmetric matrices, of which the lower triangle is read; nan where one is not
    positive definite. The factor's upper triangle is zero."""
    lower = np.zeros_like(matrix)
    for j in range(len(matrix)):
        left = lower[j, :j]
        pivot = matrix[j, j] - (left * left).sum(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            lower[j, j] = np.sqrt(np.where(pivot > 0.0, pivot, np.nan))
            for i in range(j + 1, len(matrix)):
                lower[i, j] = (matrix[i, j] - (lower[i, :j] * left).sum(axis=0)) / lower[j, j]
    return lower


def forward(lower: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution x (i, ...) of L x = b; b may have axes between i and the batch's."""
    solved = np.array(right)
    extra = (1,) * (solved.ndim - lower.ndim + 1)
    for i in range(len(solved)):
        for j in range(i):
            solved[i] -= lower[i, j].reshape(extra + lower.shape[2:]) * solved[j]
        solved[i] /= lower[i, i].reshape(extra + lower.shape[2:])
    return solved


def backward(lower: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution x (i, ...) of L^T x = b."""
    solved = np.array(right)
    extra = (1,) * (solved.ndim - lower.ndim + 1)
    for i in reversed(range(len(solved))):
        for j in range(i + 1, len(solved)):
            solved[i] -= lower[j, i].reshape(extra + lower.shape[2:]) * solved[j]
        solved[i] /= lower[i, i].reshape(extra + lower.shape[2:])
    return solved


def solve_positive(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution x (i, n) of A x = b, A symmetric and positive definite (i, j, n), b (i, n); nan where it is not.

    Read is the lower triangle. In few calls, none of which adds up along an axis: an item's digits do not depend on
    the others.
    """
    left, last = np.concatenate([matrix, right[None]]), len(matrix)
    every = np.arange(last)
    with np.errstate(all="ignore"):
        for k in range(last):
            row = left[k + 1 :, k]
            share = row / left[k, k]
            left[k + 1 :, k + 1 :] -= share[:, None] * row[:-1]
            row[:] = share
        solved = np.where((left[every, every] > 0.0).all(axis=0), left[last], np.nan)
        for k in range(last - 1, 0, -1):
            solved[:k] -= left[k, :k] * solved[k]
    return solved


def eliminate(matrix: np.ndarray, count: int) -> list[np.ndarray]:
    """Eliminate the first `count` unknowns of symmetric matrices (i, j, ...), of which the upper triangle is read.

    Pivots and Schur complement stay in the upper triangle of `matrix`; returned are the rows of the unit triangular
    factor behind each pivot.
    """
    shares = []
    for k in range(count):
        row = matrix[k, k + 1 :]
        share = row / matrix[k, k]
        for i in range(len(row)):
            matrix[k + 1 + i, k + 1 + i :] -= share[i] * row[i:]
        shares.append(share)
    return shares


def substituted_back(shares: list[np.ndarray], right: np.ndarray) -> np.ndarray:
    """Solution x (i, r, ...) of L^T x = right, which is used up."""
    for k in reversed(range(len(right))):
        for i in range(k + 1, len(right)):
            right[k] -= shares[k][i - k - 1] * right[i]
    return right

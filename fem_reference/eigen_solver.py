"""Lowest eigenpairs of K v = omega^2 M v, large and sparse or small."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from cdpr_struct.fem_reference.errors import UnstableEquilibriumError


def lowest_eigenpairs(stiffness: csc_array, mass: csc_array, count: int, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """Lowest `count` eigenvalues omega^2 (k,) [rad^2/s^2], ascending, and M-normalised vectors (dofs, k).

    Shift-invert Lanczos about `shift` [rad^2/s^2], which is negative and small beside the eigenvalues of
    interest; small problems are solved densely. The unknowns must come in an order that keeps the factors
    sparse (a band, or a band with a border at the end).

    Raises
    ------
    ValueError : count below 1 or above the number of unknowns.
    UnstableEquilibriumError : an eigenvalue is negative beyond the shift.
    """
    dofs = stiffness.shape[0]
    if not 1 <= count <= dofs:
        raise ValueError(f"count must be between 1 and the {dofs} unknowns of the mesh, got {count!r}")
    solve = _inverted_dense if dofs <= max(90, 3 * count) else _shift_invert
    values, vectors = solve(stiffness, mass, count, shift)
    order = np.argsort(values)
    if values[order[0]] < shift:
        raise UnstableEquilibriumError(float(values[order[0]]))
    return values[order], vectors[:, order]


def _inverted_dense(stiffness: csc_array, mass: csc_array, count: int, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """M v = nu (K - shift M) v for the largest nu: exact where it matters, at the low frequencies."""
    matrix, inertia = stiffness.toarray(), mass.toarray()
    last = len(matrix) - 1
    try:
        nu, vectors = scipy.linalg.eigh(inertia, matrix - shift * inertia, subset_by_index=(last + 1 - count, last))
    except np.linalg.LinAlgError:
        lowest = scipy.linalg.eigh(matrix, inertia, eigvals_only=True, subset_by_index=(0, 0))
        raise UnstableEquilibriumError(float(lowest[0])) from None
    return shift + 1.0 / nu, vectors / np.sqrt(nu)


def _shift_invert(stiffness: csc_array, mass: csc_array, count: int, shift: float) -> tuple[np.ndarray, np.ndarray]:
    factors = splu(
        csc_array(stiffness - shift * mass),
        permc_spec="NATURAL",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    inverse = LinearOperator(stiffness.shape, matvec=factors.solve, dtype=float)
    first = np.random.default_rng(20).standard_normal(stiffness.shape[0])
    return eigsh(
        stiffness,
        k=count,
        M=mass,
        sigma=shift,
        which="LM",
        OPinv=inverse,
        v0=first,
        ncv=min(stiffness.shape[0], max(2 * count + 20, 30)),
    )


def frequencies_hz(eigenvalues: np.ndarray) -> np.ndarray:
    """Frequencies [Hz] of eigenvalues omega^2 [rad^2/s^2]; round-off below zero becomes zero."""
    return np.sqrt(np.maximum(eigenvalues, 0.0)) / (2.0 * np.pi)

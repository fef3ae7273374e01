"""Sparse matrices of cables from their element matrices."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csc_array


def chain_matrix(element_matrices: np.ndarray) -> csc_array:
    """Assemble chains of elements, start nodes held.

    Parameters
    ----------
    element_matrices : (m, n, 6, 6), m cables of n elements each, in order from start to end.

    Returns
    -------
    (3 m n, 3 m n) sparse; cable by cable, nodes 1 ... n (the last one is the end), x y z.
    """
    cables, elements = element_matrices.shape[:2]
    first_dof = 3 * (np.arange(elements) - 1)[None, :] + 3 * elements * np.arange(cables)[:, None]
    dofs = first_dof[..., None] + np.arange(6)
    held = (np.arange(elements)[:, None] == 0) & (np.arange(6) < 3)
    free = np.broadcast_to(~held, dofs.shape)
    keep = free[..., :, None] & free[..., None, :]
    rows = np.broadcast_to(dofs[..., :, None], keep.shape)[keep]
    columns = np.broadcast_to(dofs[..., None, :], keep.shape)[keep]
    size = 3 * cables * elements
    return csc_array(coo_array((element_matrices[keep], (rows, columns)), shape=(size, size)))

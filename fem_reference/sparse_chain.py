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


class BorderedChains:
    """Assembles chains whose interior nodes come first and six unknowns of a common body last.

    The pattern is made once for m chains of n bars, each between a held start and the body; the order is that
    of `node_motion`. Meant for matrices that are made anew at every step.
    """

    def __init__(self, cables: int, elements: int) -> None:
        interior = 3 * np.arange(cables * (elements - 1)).reshape(cables, elements - 1)
        body = np.full((cables, 1), 3 * interior.size)
        pairs = [(interior, interior, 3, 3), (interior[:, :-1], interior[:, 1:], 3, 3)]
        pairs += [(interior[:, 1:], interior[:, :-1], 3, 3)]
        pairs += [(interior[:, -1:], body, 3, 6), (body, interior[:, -1:], 6, 3), (body[:1], body[:1], 6, 6)]
        rows, columns = [], []
        for first, second, height, width in pairs:
            row = first[..., None, None] + np.arange(height)[:, None] + np.zeros((height, width), dtype=int)
            rows.append(row.ravel())
            column = second[..., None, None] + np.arange(width) + np.zeros((height, width), dtype=int)
            columns.append(column.ravel())
        self._places = (np.concatenate(rows), np.concatenate(columns))
        self._size = 3 * interior.size + 6

    def assembled(self, bars: np.ndarray, ends: np.ndarray, lumps: np.ndarray, body: np.ndarray) -> csc_array:
        """Sum of bars (m, n, 3, 3), lumps (m,) on every interior node and the body's own (6, 6).

        ends : (m, 3, 6) motion of the last node of each chain per motion of the body.
        """
        diagonal = bars[:, :-1] + bars[:, 1:] + lumps[:, None, None, None] * np.eye(3)
        between, last = -bars[:, 1:-1], bars[:, -1]
        swapped = np.swapaxes(ends, -1, -2)
        corner = body + (swapped @ last @ ends).sum(axis=0)
        blocks = [diagonal, between, between, -last @ ends, -swapped @ last, corner]
        values = np.concatenate([block.ravel() for block in blocks])
        return csc_array(coo_array((values, self._places), shape=(self._size, self._size)))

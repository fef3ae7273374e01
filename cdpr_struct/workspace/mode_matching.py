"""Which mode of a pose has the shape of a mode at another one?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.workspace.shaped_modes import ShapedModes

SURE = 0.8  # likeness from which on a step leads to the same mode for sure
SAME = 0.5  # above it no other mode of the pose can be more alike
DOUBLE = 1e-4  # relative distance of frequencies below which modes are one multiple mode: any mixture is a mode
_PIECE = 65536


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """The most alike modes of e poses.

    mac    : (e,) likeness of the shapes, 0 to 1: squared product of the two, of length one each (modal assurance
             criterion, with the mass as weight)
    number : (e,) of the mode, from 0
    shape  : (e, d) of length one: where frequencies coincide, that mixture of their modes which is most alike
    seen   : (e,) sum of the likenesses of all modes that were computed: far below one, the mode is none of them
    """

    mac: np.ndarray
    number: np.ndarray
    shape: np.ndarray
    seen: np.ndarray


def matched(shape: np.ndarray, modes: ShapedModes) -> Match:
    """The modes most like shapes (e, d) of length one, or like one shape (d,)."""
    theirs = modes.shapes.astype(np.float32)
    product = np.einsum("...d,ekd->ek", shape, theirs, optimize=True) if shape.ndim == 1 else (
        np.matmul(theirs, shape[..., None])[..., 0]
    )  # fmt: skip
    alike = product**2
    number = alike.argmax(axis=1)
    row = np.arange(len(number))
    own = modes.hertz[row, number]
    together = np.abs(modes.hertz - own[:, None]) < DOUBLE * own[:, None]
    together[row, number] = True
    part = np.where(together, product, 0.0)
    mixed = np.matmul(part[:, None, :], theirs)[:, 0]
    size = np.sqrt((mixed**2).sum(axis=1, keepdims=True))
    return Match(
        np.minimum((part**2).sum(axis=1), 1.0), number, mixed / np.where(size > 0.0, size, 1.0), alike.sum(axis=1)
    )


def unlike_neighbours(shapes: np.ndarray, there: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(n,) bool: the shape at some neighbour, there and here, is not half alike.

    shapes     : (n, d) of length one
    there      : (n,) bool, poses that have a shape
    neighbours : (n, 6) as `Grid.neighbours`
    """
    marked = np.zeros(len(shapes), dtype=bool)
    for direction in range(0, neighbours.shape[1], 2):
        first = np.flatnonzero((neighbours[:, direction] >= 0) & there)
        first = first[there[neighbours[first, direction]]]
        for start in range(0, first.size, _PIECE):
            a = first[start : start + _PIECE]
            b = neighbours[a, direction]
            product = np.einsum("nd,nd->n", shapes[a].astype(np.float32), shapes[b].astype(np.float32))
            marked[a[product**2 < SAME]] = marked[b[product**2 < SAME]] = True
    return marked


def is_double(hertz: np.ndarray, number: int) -> np.ndarray:
    """(n,) bool: mode `number` coincides with another of hertz (n, k)."""
    own = hertz[:, number, None]
    return np.asarray((np.abs(hertz - own) < DOUBLE * own).sum(axis=1) > 1)

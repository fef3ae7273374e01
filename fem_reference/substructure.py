"""Condense whole cables to their end node, for many frequencies at once, and count what was condensed.

Two neighbouring pieces of a cable share one node; eliminating it leaves one piece with two nodes. Pairing
all pieces at once halves their number each round, so a cable takes log2(n) array operations. The eliminated
3 x 3 blocks are the pivots of a block LDL^T factorisation: by Sylvester's law their negative eigenvalues
count the eigenfrequencies of the clamped cable below the frequency (`CondensedEnds.negative_pivots`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CHUNK_BLOCKS = 200_000  # element matrices held in memory at a time


@dataclass(frozen=True, eq=False)
class Pieces:
    """Symmetric pieces [[first, between], [between^T, last]], each block (..., pieces, 3, 3) [N/m]."""

    first: np.ndarray
    between: np.ndarray
    last: np.ndarray

    @classmethod
    def of(cls, element_matrices: np.ndarray) -> Pieces:
        """Cut element matrices (..., n, 6, 6) into their blocks."""
        return cls(element_matrices[..., :3, :3], element_matrices[..., :3, 3:], element_matrices[..., 3:, 3:])

    def __len__(self) -> int:
        return int(self.first.shape[-3])

    def part(self, pick: slice) -> Pieces:
        """Every piece that the slice picks along the cable."""
        return Pieces(self.first[..., pick, :, :], self.between[..., pick, :, :], self.last[..., pick, :, :])

    def joined(self, other: Pieces) -> Pieces:
        """The pieces of both, one list after the other."""
        pairs = zip((self.first, self.between, self.last), (other.first, other.between, other.last), strict=True)
        return Pieces(*(np.concatenate(pair, axis=-3) for pair in pairs))


def _merged(pieces: Pieces) -> tuple[Pieces, np.ndarray]:
    """Merge pieces 0-1, 2-3, ...; an odd one stays. Also returns the eliminated blocks (..., pairs, 3, 3)."""
    paired = 2 * (len(pieces) // 2)
    left, right = pieces.part(slice(0, paired, 2)), pieces.part(slice(1, paired, 2))
    pivots = left.last + right.first
    to_left, to_right = np.swapaxes(left.between, -1, -2), right.between
    solved = np.linalg.solve(pivots, np.concatenate([to_left, to_right], axis=-1))
    by_left, by_right = solved[..., :3], solved[..., 3:]
    merged = Pieces(
        left.first - left.between @ by_left,
        -left.between @ by_right,
        right.last - np.swapaxes(to_right, -1, -2) @ by_right,
    )
    return (merged if paired == len(pieces) else merged.joined(pieces.part(slice(paired, None)))), pivots


def condensed_ends(element_matrices: np.ndarray) -> np.ndarray:
    """Condense chains of elements (..., n, 6, 6) [N/m], start held, to their end node: (..., 3, 3) [N/m].

    Real or complex; the elements of a chain are in order from start to end. Includes what the last element
    itself puts on the end node, such as half of its lumped mass.
    """
    pieces = Pieces.of(element_matrices)
    while len(pieces) > 1:
        pieces, _ = _merged(pieces)
    last = pieces.last[..., 0, :, :]
    return 0.5 * (last + np.swapaxes(last, -1, -2))


def condensed_both_ends(element_matrices: np.ndarray) -> tuple[Pieces, np.ndarray]:
    """Chains of elements (..., n, 6, 6), both end nodes free, as one piece; and the negative pivots (...) of each.

    Real or complex; the pivots of complex chains are not counted (zero).
    """
    pieces = Pieces.of(element_matrices)
    negative = np.zeros(element_matrices.shape[:-3], dtype=int)
    while len(pieces) > 1:
        pieces, pivots = _merged(pieces)
        if not np.iscomplexobj(pivots):
            pivots = 0.5 * (pivots + np.swapaxes(pivots, -1, -2))
            negative += (np.linalg.eigvalsh(pivots) < 0.0).sum(axis=(-1, -2))
    return pieces, negative


def condensed_and_counted(element_matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """As `condensed_ends` for real matrices; also the number (...) of negative pivots of each chain."""
    pieces = Pieces.of(element_matrices)
    negative = np.zeros(element_matrices.shape[:-3], dtype=int)
    while len(pieces) > 1:
        pieces, pivots = _merged(pieces)
        pivots = 0.5 * (pivots + np.swapaxes(pivots, -1, -2))
        negative += (np.linalg.eigvalsh(pivots) < 0.0).sum(axis=(-1, -2))
    last = pieces.last[..., 0, :, :]
    return 0.5 * (last + np.swapaxes(last, -1, -2)), negative


def dynamic_ends(stiffness: np.ndarray, mass: np.ndarray, omega_squared: np.ndarray) -> np.ndarray:
    """End dynamic stiffness (w, ..., 3, 3) [N/m] of chains for omega^2 (w,) [rad^2/s^2], real or complex.

    stiffness, mass : (..., n, 6, 6) [N/m], [kg] element matrices; the end matrix is that of K - omega^2 M.
    """
    blocks = int(np.prod(stiffness.shape[:-2]))
    chunk = max(1, CHUNK_BLOCKS // blocks)
    kind = np.result_type(stiffness, omega_squared)
    ends = np.empty((len(omega_squared), *stiffness.shape[:-3], 3, 3), dtype=kind)
    for begin in range(0, len(omega_squared), chunk):
        squares = omega_squared[begin : begin + chunk].reshape((-1,) + (1,) * stiffness.ndim)
        ends[begin : begin + chunk] = condensed_ends(stiffness - squares * mass)
    return ends

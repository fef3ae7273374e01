"""Masts as elastic bodies, with masses at the exits at most: unknowns, their flexibility, and how exits follow them.

A bracket moves all its exits alike, in any direction. An upright is a chain of beam elements (two nodes, cubic
deflection), clamped at its foot: exits follow the node at their height, sideways only.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

ONE_LEVEL = 1e-9  # of the mast's height: exits nearer to each other in height are at one node


@dataclass(frozen=True, eq=False)
class Mast:
    """A mast that gives way.

    cables      : numbers (from 0) of the n cables it carries
    motion      : (n, 3, k) motion of their exits by its k unknowns [-]
    flexibility : (k, k) [m/N], symmetric and positive
    exit_mass   : (n,) [kg], point masses at the exits
    """

    cables: tuple[int, ...]
    motion: np.ndarray
    flexibility: np.ndarray
    exit_mass: np.ndarray

    @property
    def inertia(self) -> np.ndarray:
        """(k, k) mass matrix of its unknowns [kg]."""
        return np.einsum("nak,n,nal->kl", self.motion, self.exit_mass, self.motion)

    def with_part(self, motion: np.ndarray, flexibility: np.ndarray) -> Mast:
        """The same with more unknowns."""
        k, more = len(self.flexibility), len(flexibility)
        whole = np.zeros((k + more, k + more))
        whole[:k, :k], whole[k:, k:] = self.flexibility, flexibility
        return Mast(self.cables, np.concatenate([self.motion, motion], axis=2), whole, self.exit_mass)

    def felt(self, pulls: np.ndarray) -> np.ndarray:
        """Generalised force (k,) of the pulls (m, 3) of all cables."""
        return np.einsum("nak,na->k", self.motion, pulls[list(self.cables)])

    def condensed(self, blocks: np.ndarray) -> np.ndarray:
        """(..., k, k) of blocks (..., m, 3, 3) at the exits of all cables."""
        own = blocks[..., list(self.cables), :, :]
        return np.einsum("nak,...nab,nbl->...kl", self.motion, own, self.motion, optimize=True)


def rigid(cables: tuple[int, ...], exit_mass: np.ndarray) -> Mast:
    """A mast without unknowns; point masses at its exits (n,) [kg]."""
    return Mast(cables, np.zeros((len(cables), 3, 0)), np.zeros((0, 0)), exit_mass)


def carrying_beam(cables: tuple[int, ...], direction: np.ndarray, flexibility: np.ndarray) -> Mast:
    """A beam whose exits (n) all move along one direction (3,); flexibility (n, n) [m/N] between them. No mass."""
    motion = np.eye(len(cables))[:, None, :] * np.asarray(direction, dtype=float)[None, :, None]
    return rigid(cables, np.zeros(len(cables))).with_part(motion, np.asarray(flexibility, dtype=float))


def with_bracket(mast: Mast, compliance: float) -> Mast:
    """Its exits on a bracket of the same compliance [m/N] in all directions."""
    return mast.with_part(np.tile(np.eye(3), (len(mast.cables), 1, 1)), compliance * np.eye(3))


def with_upright(mast: Mast, compliance: float, heights: np.ndarray) -> Mast:
    """Its exits at heights (n,) [m] above the foot of an upright of this compliance [m/N] at the highest of them."""
    top = float(heights.max())
    if not top > 0.0:
        return mast
    levels: list[float] = []
    for height in np.sort(heights[heights > ONE_LEVEL * top]):
        if not levels or height - levels[-1] > ONE_LEVEL * top:
            levels.append(float(height))
    flexibility = beam_flexibility(np.array(levels))
    flexibility *= compliance / flexibility[-1, -1]
    r = len(levels)
    at_level = (np.abs(heights[:, None] - np.array(levels)) <= ONE_LEVEL * top).astype(float)
    motion = np.zeros((len(heights), 3, 2 * r))
    motion[:, 0, :r], motion[:, 1, r:] = at_level, at_level
    both = np.kron(np.eye(2), flexibility)
    return mast.with_part(motion, both)


def beam_flexibility(levels: np.ndarray) -> np.ndarray:
    """(r, r) deflection at each level (r,) > 0, ascending, by a force at each; foot clamped, bending stiffness one."""
    lengths = np.diff(levels, prepend=0.0)
    count = 2 * (len(levels) + 1)
    stiffness = np.zeros((count, count))
    for element, length in enumerate(lengths):
        own = slice(2 * element, 2 * element + 4)
        stiffness[own, own] += _beam_element(float(length))
    free = np.linalg.inv(stiffness[2:, 2:])
    return np.asarray(free[::2, ::2])


def _beam_element(length: float) -> np.ndarray:
    """(4, 4) of deflection and slope at both nodes, bending stiffness one."""
    h = length
    rows = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
    rows += [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    return np.array(rows) / h**3


def unknowns(masts: Iterable[Mast]) -> list[slice]:
    """Where the unknowns of each mast stand among those of all."""
    ends = np.cumsum([0, *(len(mast.flexibility) for mast in masts)])
    return [slice(int(a), int(b)) for a, b in pairwise(ends)]

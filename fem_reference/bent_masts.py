"""Where do masts stand under the pull of their cables, and how do they soften the robot?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cdpr_struct.fem_reference.cable_statics import EPS, CableBatch, ChainState, solve_chains
from cdpr_struct.fem_reference.errors import MastsNotSettledError
from cdpr_struct.fem_reference.masts import Mast, unknowns

MAX_ITERATIONS = 60
MET = 1e-10  # step over the size of the frame up to which masts count as standing still


@dataclass(frozen=True, eq=False)
class BentMasts:
    """Cables in balance with their masts.

    starts : (m, 3) [m], where the cables start;  energy : [J] in the masts;  chains, iterations : of the cables
    """

    starts: np.ndarray
    energy: float
    chains: ChainState
    iterations: int


def bend(
    batch: CableBatch, anchors: np.ndarray, ends: np.ndarray, masts: tuple[Mast, ...], first: np.ndarray | None
) -> BentMasts:
    """Newton on the displacement of each mast: what its flexibility makes of the pulls it feels is where it stands."""
    chains, steps = solve_chains(batch, anchors, ends, first)
    if not masts:
        return BentMasts(anchors, 0.0, chains, steps)
    moved, energy = [np.zeros(len(mast.flexibility)) for mast in masts], 0.0
    for _ in range(MAX_ITERATIONS):
        pulls = chains.tension_vectors[:, 0] + 0.5 * batch.element_weight + batch.lump_weight[:, 0]
        rates = np.linalg.inv(chains.flexibility)
        largest, energy, starts = 0.0, 0.0, anchors.copy()
        for number, mast in enumerate(masts):
            pull = mast.felt(pulls)
            energy += 0.5 * float(pull @ mast.flexibility @ pull)
            miss = mast.flexibility @ pull - moved[number]
            slope = np.eye(len(pull)) + mast.flexibility @ mast.condensed(rates)
            step = np.linalg.solve(slope, miss)
            moved[number] += step
            largest = max(largest, float(np.abs(step).max()))
            starts[list(mast.cables)] += mast.motion @ moved[number]
        chains, more = solve_chains(batch, starts, ends, chains.mid_force)
        steps += more
        size = float(np.abs(anchors).max())
        if largest <= 16.0 * EPS * size:
            break
    if not largest <= MET * size:
        raise MastsNotSettledError(largest, MAX_ITERATIONS)
    return BentMasts(starts, energy, chains, steps)


def softened(
    masts: tuple[Mast, ...],
    ends: np.ndarray,
    starts: np.ndarray,
    between: np.ndarray,
    motion: np.ndarray,
    omega_squared: complex = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (..., 6, 6) at the platform of cables on masts, and the masts' own (..., k, k) before elimination.

    ends, starts, between : (..., m, 3, 3) [N/m] blocks of the condensed cables: end-end, start-start, start-end
    motion : (m, 3, 6) of the cable ends per platform motion
    omega_squared : of the vibration [rad^2/s^2], for the masses on the masts
    """
    platform = np.einsum("mka,...mkl,mlb->...ab", motion, ends, motion, optimize=True)
    places = unknowns(masts)
    count = places[-1].stop
    own = np.zeros((*platform.shape[:-2], count, count), dtype=platform.dtype)
    coupling = np.zeros((*platform.shape[:-2], count, 6), dtype=platform.dtype)
    for mast, rows in zip(masts, places, strict=True):
        carried = list(mast.cables)
        own[..., rows, rows] = mast.condensed(starts) + np.linalg.inv(mast.flexibility) - omega_squared * mast.inertia
        across = between[..., carried, :, :] @ motion[carried]
        coupling[..., rows, :] = np.einsum("nak,...nab->...kb", mast.motion, across)
    return platform - np.swapaxes(coupling, -1, -2) @ np.linalg.solve(own, coupling), own

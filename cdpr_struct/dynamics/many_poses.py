"""The lowest natural frequencies at very many poses, every one in its bracket: quickly where that is proved, and else
by the certified modes of one pose after the other. A few poses are faster one after the other in any case."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.batched_modes import Batch, fits, lowest_modes
from cdpr_struct.dynamics.certified_modes import certified_modes, quickly_certified
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import stability_at

_CHUNK = 256
_FEW = 5  # poses that are faster one after the other


@dataclass(frozen=True, slots=True, eq=False)
class FrequenciesOfPoses:
    """The first k natural frequencies at n poses, multiplicities repeated; nan where the platform is not
    stable; zero, first, where it is free to move.

    hertz         : (n, k) ascending
    bracket_hertz : (n, k, 2) intervals that hold them. Quick ones are proved for the cables as polynomials see them:
                    these frequencies lie less than 2e-7 above the catenary's (of up to five poses, 1e-9)
    quick         : (n,) bool, without the certified modes of that pose
    """

    hertz: np.ndarray
    bracket_hertz: np.ndarray
    quick: np.ndarray


def lowest_frequencies(point: OperatingPoint, count: int) -> FrequenciesOfPoses:
    """First `count` undamped natural frequencies at a flat batch (n) of poses, exact catenaries."""
    n = len(point.position)
    bracket = np.full((n, count, 2), np.nan)
    held = stability_at(point)
    stable = np.flatnonzero(~held.unstable)
    fast = stable[fits(poses_of(point, stable)) & (held.neutral[stable] == 0)]
    if fast.size > _FEW:
        bracket[fast] = _of_batch(poses_of(point, fast), count)
    else:
        for i in fast:
            found = quickly_certified(poses_of(point, int(i)), count)
            bracket[i] = np.nan if found is None else found.bracket_hertz
    quick = np.isfinite(bracket).all(axis=(1, 2))
    for i in stable[~quick[stable]]:
        bracket[i] = certified_modes(poses_of(point, int(i)), "exact", count).frequencies.bracket_hertz
    upper = quick & (fast.size > _FEW)
    return FrequenciesOfPoses(np.where(upper[:, None], bracket[..., 1], bracket.mean(axis=-1)), bracket, quick)


def _of_batch(point: OperatingPoint, count: int) -> np.ndarray:
    """Brackets (n, k, 2) [Hz] of poses that fit; nan where not proved."""
    bracket = np.full((len(point.position), count, 2), np.nan)
    for start in range(0, len(bracket), _CHUNK):
        own = np.arange(start, min(start + _CHUNK, len(bracket)))
        batch = Batch.of(poses_of(point, own))
        for group in batch.groups:
            found = lowest_modes(batch.take(group), count)
            bracket[own[group]] = np.sqrt(np.stack([found.low, found.squared], axis=-1)) / (2.0 * np.pi)
    return bracket


def poses_of(point: OperatingPoint, index: "np.ndarray | int") -> OperatingPoint:
    """Some poses of a flat batch, or one; all of them as they are."""
    if np.size(index) == len(point.position) and np.ndim(index):
        return point
    return OperatingPoint(point.robot, point.position[index], point.rotation[index], point.cables.at(index))

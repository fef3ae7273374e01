"""Modes of a pencil corrected for what lies beyond its first order in d, and counted.

A mode v of the pencil with d_i belongs to the motion (v, X v) of kept and eliminated freedoms. The trial motions
(v, X v + d_i Y v + d_i^2 Z v) of a few modes make an eigenproblem of that size, whose values are again upper bounds;
near doubles stay together in it. A count proves them: with the remainder of the series in d bounded by the eliminated
block's lowest frequency lambda_c, no more frequencies lie below lambda than

    D - d N - d^2 C^T Y - ... - d^5 g / (g - d) Z^T Z,   d = lambda - sigma,   g = lambda_c - sigma,

has negative eigenvalues; leads are eliminated cable by cable, so this is a 6 x 6 matrix a pose.
"""

import numpy as np

from cdpr_struct.dynamics.condensed_cables import CondensedCables, Terms, quietly
from cdpr_struct.dynamics.condensed_robot import Pencil, Platform
from cdpr_struct.statics.small_systems import backward

_FARTHEST = 0.7  # of lambda_c - sigma: no trial motion is followed further than that


@quietly
def corrected(
    platform: Platform, cables: CondensedCables, own: Pencil, d: np.ndarray, vectors: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Squared frequencies (n, s), ascending, their platform motions (n, 6, s) of unit modal mass, and what (n, s, s)
    turns the pencil's modes into them: its columns.

    cables : with terms up to the fifth power
    d, vectors : (n, s), (n, k, s) of some modes of the pencil
    """
    platform_motion = backward(own.lower, np.moveaxis(vectors[:, :6], 0, -1))
    terms = _in_modes(platform, cables, platform_motion, vectors)
    far = _FARTHEST * np.maximum(own.lowest - own.shift, 0.0)[:, None]
    stiffness, mass = _trial(d, np.clip(d, -far, far), terms)
    inverse = np.linalg.inv(np.linalg.cholesky(_positive(mass)))
    values, turn = np.linalg.eigh(inverse @ stiffness @ np.swapaxes(inverse, 1, 2))
    turned = np.swapaxes(inverse, 1, 2) @ turn
    return own.shift[:, None] + values, np.moveaxis(platform_motion, -1, 0) @ turned, turned


def _in_modes(platform: Platform, cables: CondensedCables, motion: np.ndarray, vectors: np.ndarray) -> list[np.ndarray]:
    """(n, s, s) of C^T Y, Y^T Y, ... between modes whose platform moves by (6, s, n)."""
    s, n = motion.shape[1:]
    m = platform.motion.shape[2]
    ends = np.stack([_end_motion(axis, motion) for axis in platform.motion])
    leads = np.moveaxis(vectors[:, 6:].reshape(n, -1, m, s), (1, 3, 2, 0), (0, 1, 2, 3))
    starts = np.cumsum([0, *(part.leads for part in cables.parts)])
    kept = [
        np.concatenate([leads[start : start + part.leads], ends[list(part.axes)]])
        for start, part in zip(starts, cables.parts, strict=False)
    ]
    whole = _rows(kept)
    found = []
    for power in range(2, len(cables.parts[0].of_power)):
        parts = [_times(t.of_power[power], v) for t, v in zip(cables.parts, kept, strict=True)]
        found.append(np.swapaxes(whole, 1, 2) @ _rows(parts))
    return found


def _end_motion(axis: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(s, m, n) of cable ends along one axis (6, m, n)."""
    return np.asarray(sum(axis[i] * motion[i][:, None] for i in range(6)))


def _times(term: np.ndarray, modes: np.ndarray) -> np.ndarray:
    """(r, s, m, n) of (r, r, m, n) and (r, s, m, n)."""
    return np.stack([sum(term[i, j] * modes[j] for j in range(len(modes))) for i in range(len(modes))])


def _rows(parts: list[np.ndarray]) -> np.ndarray:
    """(n, rows, s) of parts (r, s, m, n)."""
    both = np.concatenate(parts)
    r, s, m, n = both.shape
    return np.ascontiguousarray(np.moveaxis(both, (3, 0, 2, 1), (0, 1, 2, 3))).reshape(n, r * m, s)


def _trial(d: np.ndarray, reach: np.ndarray, terms: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness less sigma times mass, and mass (n, s, s), between trial motions with `reach` (n, s) for d in them."""
    row, column = reach[:, :, None], reach[:, None, :]
    one, both, cross = np.eye(d.shape[1]), row * column, row * column * (row + column)
    two, three, four, five = terms
    stiffness = one * d[:, :, None] + both * two + cross * three + both**2 * four
    mass = one + (row + column) * two + (both + row**2 + column**2) * three + cross * four + both**2 * five
    return stiffness, mass


def _positive(mass: np.ndarray) -> np.ndarray:
    """The masses, and the unit matrix where rounding has left none; counts then refuse what comes of it."""
    lowest = np.linalg.eigvalsh(mass)[:, 0] if np.isfinite(mass).all() else np.full(len(mass), -1.0)
    good = lowest > 1e-12
    return np.where(good[:, None, None], mass, np.eye(mass.shape[1]))


def most_below(platform: Platform, cables: CondensedCables, shift: np.ndarray, squared: np.ndarray) -> np.ndarray:
    """(n,) no more than so many squared frequencies lie below `squared` (n,); a large number where none is proved."""
    gap, left = cables.lowest - shift, cables.lowest - squared
    sure = (gap > 0.0) & (left > 0.0)
    negative, counted = _negative(
        platform, cables, shift, squared, np.where(sure, gap / np.where(sure, left, 1.0), 1.0)
    )
    return np.where(sure & counted, negative, np.iinfo(int).max)


def least_below(platform: Platform, cables: CondensedCables, shift: np.ndarray, squared: np.ndarray) -> np.ndarray:
    """(n,) no fewer than so many squared frequencies lie below `squared` (n,): the series' remainder left out."""
    sure = np.maximum(shift, squared) < cables.lowest
    negative, counted = _negative(platform, cables, shift, squared, np.ones_like(shift))
    return np.where(sure & counted, negative, 0)


@quietly
def _negative(
    platform: Platform, cables: CondensedCables, shift: np.ndarray, squared: np.ndarray, last: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Negative eigenvalues (n,) at `squared`, the last term times `last`, and whether they are numbers at all (n,)."""
    d, count = squared - shift, len(cables.parts[0].of_power)
    powers = [np.ones_like(d)] + [-(d**k) for k in range(1, count)]
    powers[-1] = powers[-1] * last
    negative, ends = np.zeros(len(d), dtype=int), []
    for terms in cables.parts:
        of_leads, end = _without_leads(terms, powers)
        negative += of_leads
        ends.append((terms.axes, end))
    whole = np.moveaxis(platform.of_ends(ends) + platform.held - squared * platform.mass, -1, 0)
    counted = np.isfinite(whole).all(axis=(1, 2))
    own = np.linalg.eigvalsh(np.where(counted[:, None, None], whole, np.eye(6)))
    return negative + (own < 0.0).sum(axis=1), counted


def _without_leads(terms: Terms, powers: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Negative pivots (n,) of the leads, and the ends' block (e, e, m, n) that is left without them."""
    matrix = sum(factor * term for factor, term in zip(powers, terms.of_power, strict=True))
    matrix = np.array(matrix)
    negative = np.zeros(matrix.shape[-1], dtype=int)
    for k in range(terms.leads):
        negative += (matrix[k, k] < 0.0).sum(axis=0)
        share = matrix[k, k + 1 :] / matrix[k, k]
        matrix[k + 1 :, k + 1 :] -= share[:, None] * matrix[k, k + 1 :]
    return negative, matrix[terms.leads :, terms.leads :]

"""Lowest frequencies of the robot at one pose, each with its proof, in few calls.

A mode v of the pencil about a frequency shift belongs to the motion (v, X v) of kept and eliminated freedoms. Trial
motions (v, X v + d A^-1 C v + d^2 A^-2 C v + d^3 A^-3 C v) of the lowest modes make an eigenproblem of their number,
with errors of the eighth power of d / g; counts just below and above each value prove it.

It takes poses at which no cable sags much (w L / T below 0.6) of robots that `condensed_pose` knows.
"""

import numpy as np

from cdpr_struct.dynamics.condensed_pose import HIGHEST_TERM, CondensedPose, Pose, condensed_pose, knows
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly

_MOST_SAGGING = 0.6  # w L / T
_ATTEMPTS = 3
_SPARE = 4  # trial motions beyond those asked for
_LOW, _HIGH = 0.7, 0.3  # shares of the first and of the last squared frequency in the shift
_FEWEST_LEADS, _LEADS = 2, 1.4  # at least, and for each half wave of the lowest string at the last frequency
_POLYNOMIALS, _SAGGING = 7.0, 10.0  # beyond two for each half wave, and for each w L / T
_NEUTRAL = 1e-6  # of the lowest string's squared frequency: below it the general solver tells zero from small
_FARTHEST = 0.7  # of the reach: no trial motion is followed further than that
_POWER = HIGHEST_TERM // 2


def quick_frequencies(
    point: OperatingPoint, count: int, precision: float, assembly: Assembly = "consistent"
) -> np.ndarray | None:
    """First `count` omega (k,) [rad/s] at one pose, exact catenaries; None where a count does not enclose every one
    within the relative `precision` to both sides.

    The count is that of the cables as polynomials see them; that differs by less than 1e-9 from the catenaries.
    """
    if not knows(point):
        return None
    pose = Pose.of(point, assembly)
    sag, lowest = float(pose.cables.sag_ratio.max()), float(pose.strings.min())
    if not sag < _MOST_SAGGING:
        return None
    first, top = lowest, _expected_highest(pose.strings, count)
    leads = _FEWEST_LEADS
    for _ in range(_ATTEMPTS):
        half_waves = np.sqrt(top / lowest)
        leads = max(leads, int(np.ceil(_LEADS * half_waves)))
        order = int(np.ceil(2.0 * half_waves + _POLYNOMIALS + _SAGGING * sag))
        condensed = condensed_pose(pose, _LOW * first + _HIGH * top, order, leads)
        leads += 1 + leads // 4
        if condensed is None or condensed.motions < count + _SPARE:
            continue
        squared = _upper_bounds(condensed, count)
        if not squared[0] > _NEUTRAL * lowest:
            return None
        low, high = (squared * (1.0 + sign * precision) ** 2 for sign in (-1.0, 1.0))
        if condensed.encloses(low, high).all() and np.sqrt(squared[-1] / lowest) <= half_waves + 0.5:
            return np.sqrt(squared)
        first, top = float(squared[0]), float(squared[-1])
    return None


def _expected_highest(strings: np.ndarray, count: int) -> float:
    """The squared frequency of that number among the harmonics of strings (m,), two planes each."""
    harmonics = np.outer(np.arange(1, count + 1) ** 2, np.repeat(strings, 2))
    return float(np.sort(harmonics.ravel())[count - 1])


def _upper_bounds(condensed: CondensedPose, count: int) -> np.ndarray:
    """(count,) squared frequencies, ascending."""
    at_shift, unit = condensed.pencil()
    turn = np.linalg.inv(np.linalg.cholesky(unit))
    d, vectors = np.linalg.eigh(turn @ at_shift @ turn.T)
    chosen = slice(count + _SPARE)
    terms = condensed.between(turn.T @ vectors[:, chosen])
    stiffness, mass = _trial(d[chosen], _FARTHEST * condensed.reach, terms)
    turn = np.linalg.inv(np.linalg.cholesky(mass))
    squared: np.ndarray = condensed.shift + np.linalg.eigvalsh(turn @ stiffness @ turn.T)[:count]
    return squared


def _trial(d: np.ndarray, farthest: float, terms: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness about the shift and mass (s, s) of the trial motions of modes d (s,), terms (6, s, s) between them.

    The product d_i^a d_j^b has T_(a + b) in the stiffness, a and b at least 1, and T_(a + b + 1) in the mass.
    """
    steps = np.minimum(d, farthest) ** np.arange(_POWER + 1)[:, None]
    stiffness, mass = np.diag(d), np.eye(len(d))
    for k in range(1, 2 * _POWER + 1):
        part = steps[max(k - _POWER, 0) : k + 1]
        mass += (part.T @ part[::-1]) * terms[k - 1]
        if k > 1:
            part = steps[max(k - _POWER, 1) : k]
            stiffness += (part.T @ part[::-1]) * terms[k - 2]
    return stiffness, mass

"""Is it certain that no tensions within the bounds hold a pose? A wrench that separates them from the load proves it.

At a fixed pose the force of cable i on the platform is tau u - V e: the chord tension along the chord, and the share
V of its load, which is weight and drag of wind, w per length, against e. Let y be a wrench. If the largest powers of
all cables along y, each at its own best chord tension, and the load's together stay below zero, nothing balances
(Farkas). V is enclosed on intervals of tau, where the unstrained length L and g = coth q - 1/q both fall:

    V = w (z g(q) + L) / 2,   L^2 = z^2 + (x sinh(q) / q)^2,   q = w chord / (2 tau),   L of an elastic cable up to
    1 + tau / EA shorter.

The wrench that straight cables with half of their weight leave unbalanced is tried as y.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.batch_items import BatchItems
from cdpr_struct.statics.cable_models import SaggingModel
from cdpr_struct.statics.catenary_length import solve_length
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.minimum_norm import QuadraticPrograms, least_violation
from cdpr_struct.statics.pulley import pulley_exit, straight_exit

FAR = 1e4  # times load and lower bounds: no tension beyond is considered where there is no upper bound
LARGEST_STRAIN = 0.05  # nor one that strains a cable more
_INTERVALS = 12  # of the chord tension, up to where a cable is taut
_TAUTER = 6  # from there on
_TAUT = 30.0  # times the slackest chord tension considered
_ROUNDS = 8  # of linearising around sagging cables, where straight ones prove nothing
_NEAR = 1e-3  # of the load: an unbalance that a careful search is worth
_MARGIN = 1e-3  # of the unbalanced wrench: by how much at least the sum must stay below zero


@dataclass(frozen=True, slots=True, eq=False)
class _Chords(BatchItems):
    """Straight cables: pull (k, m, 3) unit vector, chord and rise (k, m) [m], load per length (k, m) [N/m] and the unit
    vector against it (k, m, 3); load is weight and drag of wind, rise is along that vector."""

    pull: np.ndarray
    chord: np.ndarray
    rise: np.ndarray
    weight: np.ndarray
    up: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Separation:
    """Flat batch (k).

    proven  : (k,) bool, no tensions balance
    near    : (k,) bool, tensions were found that nearly balance
    tension : (k, m) chord tensions that leave about the least wrench [N]
    """

    proven: np.ndarray
    near: np.ndarray
    tension: np.ndarray


def separation(problem: HoldingProblem) -> Separation:
    """For which poses (k) it is certain that no tensions within the bounds hold them."""
    chords = _chords(problem)
    low, high = _chord_bounds(problem, chords)
    tension, left = _least_unbalance(problem, chords, low, high)
    proven, near = _separates(problem, chords, left, low, high), np.zeros(len(tension), dtype=bool)
    open_ = np.flatnonzero(~proven)
    for _ in range(_ROUNDS):
        if not open_.size:
            break
        part, bounds = problem.take(open_), (low[open_], high[open_])
        tension[open_], left = _relinearised(part, tension[open_], *bounds)
        proven[open_] = _separates(part, chords.take(open_), left, *bounds)
        size = np.linalg.norm(part.load / part.unit, axis=1)
        near[open_] = np.linalg.norm(left, axis=1) <= _NEAR * size
        open_ = open_[~proven[open_]]
    return Separation(proven, near, tension)


def _separates(
    problem: HoldingProblem, chords: "_Chords", left: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """(k,) bool: the unbalance (k, 6) separates."""
    size = np.linalg.norm(left, axis=1)
    along = -left / np.maximum(size, 1e-300)[:, None]
    load = (along * problem.load / problem.unit).sum(axis=1)
    reach = _largest_powers(problem, chords, along, low, high).sum(axis=1) + load
    enough = size > 1e-8 * np.linalg.norm(problem.load / problem.unit, axis=1)
    turned = problem.arrays.has_cable_drag and problem.arrays.has_pulleys  # the drag at another exit has no bound here
    return np.asarray((reach < -_MARGIN * size) & enough) & (not (turned or problem.arrays.has_lumps))


def _relinearised(
    problem: HoldingProblem, tension: np.ndarray, low: np.ndarray, high: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The same for sagging cables around chord tensions (k, m)."""
    matrix, wrench = problem.linearised(tension)
    load = np.linalg.norm(problem.load / problem.unit, axis=1, keepdims=True)
    least = np.maximum(low - tension, -0.6 * tension)
    most = np.maximum(np.minimum(high - tension, 2.0 * tension + load), least)
    ones = np.ones_like(tension)
    step, left = least_violation(QuadraticPrograms(ones, 0.0 * ones, matrix, -wrench, least, most))
    return tension + step, -left


def _chords(problem: HoldingProblem) -> _Chords:
    arrays = problem.arrays
    offset = problem.arms.points - arrays.frame_anchors
    if arrays.has_pulleys:
        direction = straight_exit(offset, arrays.pulley_axis, arrays.pulley_radius)
        offset = offset - pulley_exit(direction, arrays.pulley_axis, arrays.pulley_radius).point
    chord = np.linalg.norm(offset, axis=-1)
    load, up = arrays.cable_load(offset)
    weight = np.broadcast_to(load if isinstance(problem.model, SaggingModel) else np.zeros(1), chord.shape)
    return _Chords(-offset / chord[..., None], chord, (offset * up).sum(axis=-1), weight, up)


def _chord_bounds(problem: HoldingProblem, chords: _Chords) -> tuple[np.ndarray, np.ndarray]:
    """Chord tensions (k, m) [N] outside of which no cable is within its bounds.

    The tension at the platform falls and then rises with the chord tension: a lower bound excludes all that is slacker
    only if the slackest cable pulls less.
    """
    load = np.linalg.norm(problem.load / problem.unit, axis=1)[:, None]
    least = problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    least = np.maximum(least, 1e-9 * (1.0 + load))
    low, high = least, problem.high
    if (problem.low > 0.0).any():
        slackest = problem.model.hold(problem.arrays, problem.arms.points, least).states.tension_at_platform
        asked = _taut_tension(problem, chords, problem.low)
        low = np.where(slackest < problem.low, np.maximum(asked, least), least)
    far = np.minimum(FAR * (load + low.max(axis=1)[:, None]), LARGEST_STRAIN * problem.arrays.axial_stiffness)
    far = np.maximum(far, 2.0 * low)
    if np.isfinite(high).any():
        top = _taut_tension(problem, chords, np.where(np.isfinite(high), high, 0.0))
        far = np.where(np.isfinite(high), np.maximum(top * (1.0 + 1e-9), low), far)
    return low, far


def _taut_tension(problem: HoldingProblem, chords: _Chords, force: np.ndarray) -> np.ndarray:
    """(k, m) chord tension at which each cable pulls with `force` (k, m) at the platform, on its taut side [N]."""
    if not chords.weight.any():
        return force
    span = np.sqrt(np.maximum(chords.chord**2 - chords.rise**2, 0.0))
    asked = np.maximum(force, 1e-6 * chords.weight * chords.chord + 1e-300)
    return solve_length(span, chords.rise, asked, problem.arrays.axial_stiffness, chords.weight).chord_tension


def _least_unbalance(
    problem: HoldingProblem, chords: _Chords, low: np.ndarray, high: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Tensions (k, m) of straight cables with half of their weight, and the scaled wrench (k, 6) that they leave."""
    matrix = np.concatenate([chords.pull, np.cross(problem.arms.arms, chords.pull)], axis=-1) / problem.unit[:, None]
    hanging = -0.5 * (chords.weight * chords.chord)[..., None] * chords.up
    hung = np.concatenate([hanging, np.cross(problem.arms.arms, hanging)], axis=-1).sum(axis=1) + problem.load
    ones, target = np.ones_like(low), -hung / problem.unit
    programs = QuadraticPrograms(ones, 0.0 * ones, np.swapaxes(matrix, -1, -2), target, low, high)
    tension, left = least_violation(programs)
    return tension, -left


def _largest_powers(
    problem: HoldingProblem, chords: _Chords, along: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """(k, m) upper bounds of the power of each cable between its bounds of chord tension."""
    scaled, lever = along / problem.unit, problem.arms.arms
    share = scaled[:, None, :3] + np.cross(scaled[:, None, 3:], lever)  # of a force at the anchor
    straight, up = (chords.pull * share).sum(axis=-1), (chords.up * share).sum(axis=-1)
    taut = np.clip(_TAUT * low, low, high)
    near, far = (np.linspace(0.0, 1.0, count + 1).reshape((-1, 1, 1)) for count in (_INTERVALS, _TAUTER))
    places = np.concatenate([low * (taut / low) ** near, taut * (high / taut) ** far[1:]])
    least, most = _weight_shares(chords, places, problem.arrays.axial_stiffness)
    pulled = np.maximum(straight * places[:-1], straight * places[1:])
    moved = problem.arrays.pulley_radius / chords.chord * most.max(axis=0) * np.linalg.norm(share, axis=-1)
    return np.asarray((pulled + np.maximum(-up * least, -up * most)).max(axis=0) + moved)


def _weight_shares(chords: _Chords, places: np.ndarray, stiff: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and most of V (n, k, m) [N] on the intervals between chord tensions (n + 1, k, m)."""
    q = 0.5 * chords.weight * chords.chord / places
    safe = np.maximum(q, 1e-3)
    bend = np.where(q < 1e-3, q / 3.0, 1.0 / np.tanh(safe) - 1.0 / safe)
    spread = np.where(q < 1e-3, 1.0 + q**2 / 6.0, np.sinh(safe) / safe)
    span = np.sqrt(np.maximum(chords.chord**2 - chords.rise**2, 0.0))
    longest = np.hypot(chords.rise, span * spread)
    shortest = longest / (1.0 + places / stiff)
    slack, taut = chords.rise * bend[:-1], chords.rise * bend[1:]
    least = 0.5 * chords.weight * (np.minimum(slack, taut) + shortest[1:])
    most = 0.5 * chords.weight * (np.maximum(slack, taut) + longest[:-1])
    return np.maximum(least, 0.0), most

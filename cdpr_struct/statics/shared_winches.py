"""What do winches that wind several cables each say when the platform is at a position, and how is it turned there?

A winch pays out equal lengths on all of its cables. At given lengths the whole pose follows from balance, so w winches
set w of its six coordinates at most. Sought is what they say where the kept coordinates (the position, and the angles
that are not free) are those asked for: Newton on the balanced platform, w unknowns a pose. With more winches than kept
coordinates the tensions are those of least norm within their bounds, by quadratic programs on the way.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.winches import Winches
from cdpr_struct.statics.batch_items import BatchItems
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.equilibrium import platform_radius, rotation_from_vector
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward
from cdpr_struct.statics.free_orientation import FreeOrientation, free_orientation
from cdpr_struct.statics.hanging_search import turning_axes
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.locked_balance import LockedBalance
from cdpr_struct.statics.minimum_norm import QuadraticPrograms, solve_programs
from cdpr_struct.statics.neutral_freedoms import stability
from cdpr_struct.statics.pose_error import reference_lengths

_ROUNDS = 60
_LONGEST = 0.05  # of the mean length: of one step of a winch
_NEAR = 2e-3  # of the mean length: so near, a step is kept even if it leads away
_LEAST_EASE = 0.02  # of a step towards tensions of least norm
_SHORTEST = 1e-3  # of a cable on the way [m]
_DIFFERENCE = 1e-3  # of the cables' mean stretch: of a winch, for derivatives
_CLOSE = 1e-8  # of a position [m], or of a turn as an arc: what counts as reached
_SETTLED, _ENOUGH = 1e-7, 1e-5  # of the largest tension: changes sought on the way to the least norm, and accepted
_WITHIN = 1e-7  # of the largest tension: what counts as within the bounds


@dataclass(frozen=True, slots=True, eq=False)
class WoundRest:
    """Platforms of a flat batch (k) at rest on winches that are shared.

    hung : orientation, cables, and which are found: at rest where asked, tensions within their bounds
    said : (k, w) what the winches say [m];  miss : (k,) largest distance from the kept coordinates, turns as arcs [m]
    """

    hung: FreeOrientation
    said: np.ndarray
    miss: np.ndarray


def wound_rest(
    robot: Robot,
    position: npt.ArrayLike,
    angles: npt.ArrayLike,
    free: npt.ArrayLike,
    model: str | CableModel = "sagging",
) -> WoundRest:
    """Where platforms rest whose winches set their position, under the robot's load.

    Parameters
    ----------
    robot : with home lengths of the cables that share winches
    position, angles : (k, 3) [m]; (3,) or (k, 3) rx, ry, rz [rad], those that are kept, and where the search begins
    free : (3,) bool, which of rx, ry, rz follow from balance
    """
    place, arrays, chosen = np.asarray(position, dtype=float), RobotArrays.of(robot), np.asarray(free, dtype=bool)
    turned = np.array(np.broadcast_to(np.asarray(angles, dtype=float), place.shape))
    search = _Search(arrays, robot.winches, cable_model(model), place, turned, chosen)
    ends, settled = _searched(search, search.begun(robot.home))
    now = search.rest(ends.said, ends.position, ends.rotation)
    pull = now.tensions
    margin = _WITHIN * pull.max(axis=1, keepdims=True)
    inside = ((pull >= arrays.force_min - margin) & (pull <= arrays.force_max + margin)).all(axis=1)
    found, angles_found = settled & inside & now.converged, angles_from_rotation(now.rotation)
    none = np.zeros(place.shape)
    hung = FreeOrientation(angles_found, now.rotation, found, none, now.cables, now.residual_wrench)
    return WoundRest(hung, ends.said, ends.size)


def resting_orientation(robot: Robot, position: np.ndarray, angles: np.ndarray, free: npt.ArrayLike) -> FreeOrientation:
    """Orientations of platforms whose free angles are not held: hanging freely, or on winches that are shared.

    Arguments as for `wound_rest`.
    """
    if robot.shared_winches:
        return wound_rest(robot, position, angles, free).hung
    return free_orientation(robot, position, angles, free)


@dataclass(frozen=True, slots=True, eq=False)
class _Wound(BatchItems):
    """Balanced platforms (k): what winches say (k, w), pose (k, 3), (k, 3, 3), tensions (k, m), distances from the c
    kept coordinates (k, c), turns as arcs [m], and whether the balance was found (k,)."""

    said: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray
    miss: np.ndarray
    balanced: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """(k,) the largest of the distances."""
        return np.asarray(np.abs(self.miss).max(axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class _Search:
    """Positions and angles that are asked for, (k, 3) each [m], [rad], of which the `free` (3,) are not kept."""

    arrays: RobotArrays
    winches: Winches
    model: CableModel
    position: np.ndarray
    angles: np.ndarray
    free: np.ndarray

    @property
    def kept(self) -> np.ndarray:
        """(c,) which of x, y, z, rx, ry, rz are kept, those of a guide left out."""
        return np.flatnonzero(np.append(np.ones(3), ~self.free) * self.arrays.free)

    def take(self, index: np.ndarray) -> "_Search":
        return replace(self, position=self.position[index], angles=self.angles[index])

    def rest(self, said: np.ndarray, position: np.ndarray, rotation: np.ndarray) -> ForwardSolution:
        return forward(self.arrays, self.lengths(said), position, rotation, self.model)

    def lengths(self, said: np.ndarray) -> np.ndarray:
        """(k, m) of the cables; on the way, too, there is some of each [m]."""
        return np.maximum(self.winches.lengths(said), _SHORTEST)

    def begun(self, home: Pose | None) -> _Wound:
        """Balance where the winches have paid out since home what straight cables ask for; those whose home is not
        known begin at the lengths that hold the poses with a winch for each cable."""
        rotation = rotation_from_angles(*np.moveaxis(self.angles, -1, 0))
        straight = reference_lengths(self.arrays, self.position, rotation)
        known = np.zeros(straight.shape[-1]) if home is None else self.winches.lengths(self.winches.home)
        lengths = straight
        if home is not None:
            lengths = known + straight - reference_lengths(self.arrays, home.position, home.rotation)
        if not known.all():
            held = inverse(self.arrays, self.position, rotation, self.model, allow_unheld=True)
            own = np.where(held.held[:, None], np.minimum(held.lengths, straight), straight)
            lengths = np.where(known > 0.0, lengths, own)
        return self.at(self.winches.said(lengths), self.position, rotation)

    def at(self, said: np.ndarray, position: np.ndarray, rotation: np.ndarray) -> _Wound:
        """Balance where the winches say `said` (k, w), sought from poses."""
        found = self.rest(said, position, rotation)
        turn, _ = self._turned(found.rotation)
        arcs = platform_radius(self.arrays) * turn
        miss = np.concatenate([found.position - self.position, arcs], axis=1)[:, self.kept]
        return _Wound(said, found.position, found.rotation, found.tensions, miss, found.converged)

    def ways(self, ends: _Wound) -> "_Ways":
        """Where to go from there."""
        moves, pulls = self._rates(ends)
        _, rows = self._turned(ends.rotation)
        turns = platform_radius(self.arrays) * rows @ moves[:, 3:]
        reach = np.concatenate([moves[:, :3], turns], axis=1)[:, self.kept]
        nearer = -(np.linalg.pinv(reach, rcond=1e-9) @ ends.miss[..., None])[..., 0]
        idle = np.zeros_like(nearer)
        if self.winches.count > len(self.kept):
            idle = self._of_least_norm(ends.tension, pulls, reach, nearer)
        changed = np.abs((pulls @ idle[..., None])[..., 0]).max(axis=1)
        return _Ways(nearer, idle, changed / np.maximum(ends.tension.max(axis=1), 1e-300), moves)

    def _of_least_norm(self, tension: np.ndarray, pulls: np.ndarray, reach: np.ndarray, step: np.ndarray) -> np.ndarray:
        """(k, w) what is to be added to steps that reach the kept coordinates, so that the tensions are of least norm
        within their bounds; pulls (k, m, w) and reach (k, c, w) are their changes by the winches."""
        (k, m), kept = tension.shape, reach.shape[1]
        idle = np.swapaxes(np.linalg.svd(reach, full_matrices=True)[2][:, kept:], 1, 2)
        change = pulls @ idle
        others = np.swapaxes(np.linalg.svd(change, full_matrices=True)[0][:, :, change.shape[2] :], 1, 2)
        start = tension + (pulls @ step[..., None])[..., 0]
        low, high = (np.broadcast_to(bound, (k, m)) for bound in (self.arrays.force_min, self.arrays.force_max))
        ones, target = np.ones((k, m)), np.einsum("knm,km->kn", others, start)
        best, _ = solve_programs(QuadraticPrograms(ones, 0.0 * ones, others, target, low, high), careful=True)
        along = np.linalg.pinv(change, rcond=1e-9) @ (best - start)[..., None]
        return np.asarray((idle @ along)[..., 0])

    def _turned(self, rotation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Turns (k, 3) from the angles asked for [rad], and their change (k, 3, 3) by turns about the world axes: of
        each angle, or about the world axes if none is free."""
        if not self.free.any():
            wanted = rotation_from_angles(*np.moveaxis(self.angles, -1, 0))
            turn = Rotation.from_matrix(rotation @ np.swapaxes(wanted, -1, -2)).as_rotvec()
            return turn, np.broadcast_to(np.eye(3), rotation.shape)
        angles = angles_from_rotation(rotation)
        turn = (angles - self.angles + np.pi) % (2.0 * np.pi) - np.pi
        return turn, np.linalg.pinv(np.swapaxes(turning_axes(angles), -1, -2), rcond=1e-9)

    def _rates(self, ends: _Wound) -> tuple[np.ndarray, np.ndarray]:
        """Changes of balanced platforms (k, 6, w) and of their tensions (k, m, w) by what the winches say, per m."""
        seen, k = self.model.seen(self.arrays), len(ends.said)
        load = np.zeros((k, 6))

        def balance(said: np.ndarray) -> LockedBalance:
            return LockedBalance(seen, seen.paid_out(self.lengths(said)), load, self.model)

        here, place, turn = balance(ends.said), ends.position, ends.rotation
        tangent = here.evaluate(place, turn).tangent
        tangent = tangent + stability(seen, turn, tangent).holding  # neutral freedoms stay where they are
        stretch = here.states(place, turn).elongation.mean(axis=1)
        step = (_DIFFERENCE * np.maximum(stretch, 1e-9))[:, None]
        moves, pulls = [], []
        for winch in np.eye(self.winches.count):
            more, less = balance(ends.said + step * winch), balance(ends.said - step * winch)
            push = more.evaluate(place, turn).wrench - less.evaluate(place, turn).wrench
            move = np.linalg.solve(tangent, 0.5 * push[..., None])[..., 0]
            ahead, back = (
                side.states(place + way[:, :3], rotation_from_vector(way[:, 3:]) @ turn).tension_at_platform
                for side, way in ((more, move), (less, -move))
            )
            moves.append(move / step)
            pulls.append(0.5 * (ahead - back) / step)
        return np.stack(moves, axis=-1), np.stack(pulls, axis=-1)


@dataclass(frozen=True, slots=True, eq=False)
class _Ways:
    """Steps (k, w) of the winches [m]: to the kept coordinates, and those that leave them alone on the way to tensions
    of least norm; the change of tension (k,) by the latter over the largest, and the motions (k, 6, w) per m."""

    nearer: np.ndarray
    idle: np.ndarray
    change: np.ndarray
    moves: np.ndarray


def _searched(search: _Search, ends: _Wound) -> tuple[_Wound, np.ndarray]:
    """Where Newton on what the winches say ends, and where (k,) it has settled; steps that lead away are cut down.

    The steps towards tensions of least norm know nothing of their second derivatives, so they may be too long and swing
    to and fro: how two that follow each other compare says which share of them to take.
    """
    shape, items = ends.said.shape, np.arange(len(ends.said))
    share, ease, settled = np.ones(shape[0]), np.ones(shape[0]), np.zeros(shape[0], dtype=bool)
    before, taken = np.zeros(shape), np.ones(shape[0])
    for _ in range(_ROUNDS):
        here, part = ends.take(items), search.take(items)
        ways = part.ways(here)
        settled[items] = (here.size <= _CLOSE) & (ways.change <= _ENOUGH)
        ease[items] = _eased(ease[items], before[items], ways.idle, taken[items])
        step = ways.nearer + ease[items, None] * ways.idle
        reach = part.lengths(here.said).mean(axis=1)
        part_taken = share[items] * np.minimum(1.0, _LONGEST * reach / np.maximum(np.abs(step).max(axis=1), 1e-300))
        step = part_taken[:, None] * step
        move = (ways.moves @ step[..., None])[..., 0]
        turned = rotation_from_vector(move[:, 3:]) @ here.rotation
        tried = part.at(here.said + step, here.position + move[:, :3], turned)
        nearer = (tried.size < here.size) | (tried.size <= np.maximum(0.5 * np.abs(step).max(axis=1), _NEAR * reach))
        better = tried.balanced & nearer
        ends.replaced(items[better], tried.take(better))
        before[items], taken[items] = np.where(better[:, None], ways.idle, 0.0), part_taken * ease[items]
        share[items] = np.where(better, np.minimum(1.0, 2.0 * share[items]), 0.25 * share[items])
        there = (here.size <= 0.01 * _CLOSE) & (ways.change <= _SETTLED)
        items = items[~there & (share[items] > 1e-4)]
        if not items.size:
            break
    return ends, settled


def _eased(ease: np.ndarray, before: np.ndarray, idle: np.ndarray, taken: np.ndarray) -> np.ndarray:
    """(k,) share of the idle steps (k, w) to take, when the shares `taken` (k,) of those `before` have led here."""
    size = (before**2).sum(axis=1)
    left = (before * idle).sum(axis=1) / np.where(size > 0.0, size, 1.0)
    best = np.clip(taken / np.maximum(1.0 - left, taken), _LEAST_EASE, np.minimum(1.5 * ease, 1.0))
    return np.where(size > 0.0, best, ease)

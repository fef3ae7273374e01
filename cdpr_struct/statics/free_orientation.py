"""Which orientation does a platform take at a given position if some of its angles are left free?

The tensions are those of least norm that balance the forces and the moments about the angles that are kept: the cables
do nothing to turn the platform about the others. The free angles are where these tensions leave no moment about them.
Newton on the free angles of all poses at once; its derivatives are differences. Poses it does not reach from the given
angles are begun again from the nearest one that it reached. If all three angles are free, the steps are turns about the
world axes: angles have poses at which two of their axes meet (ry = 90 deg), turns have none.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.batch_items import BatchItems
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import (
    PlatformArms,
    cable_wrench,
    load_wrench,
    platform_radius,
    rotation_from_vector,
)
from cdpr_struct.statics.guides import free_part
from cdpr_struct.statics.holding_tensions import HoldingProblem, allowed_unbalance
from cdpr_struct.statics.lost_cables import lost

ANGLES = ("rx", "ry", "rz")
_ITERATIONS = 25
_DIFFERENCE = 1e-6  # [rad]
_LARGEST_TURN = 0.2  # of one step [rad]
_BALANCED = 1e-11  # moment over arms times tensions
_ALIGNED = 1e-9  # by so much an axis of a free angle may differ from one about which a guide lets the platform turn
_WITHIN = 1e-8  # of load and tensions: what counts as balanced and within the bounds
_TILT = 0.3  # [rad], of starts beside the angles given
_NEXT = 3  # rounds of starts from neighbours


@dataclass(frozen=True, slots=True, eq=False)
class FreeOrientation:
    """Orientations of a flat batch (k).

    angles : (k, 3) rx, ry, rz [rad];  rotation : (k, 3, 3) platform to world
    found  : (k,) bool, no moment is left about the free angles, and tensions balance the rest within their bounds
    cables : `CableStates` (k, m) there;  wrench : (k, 6) that is left unbalanced [N, N m]
    moment : (k, 3) about the free angles, 0 about the others, over arms times tensions; about the world axes if all
        are free
    """

    angles: np.ndarray
    rotation: np.ndarray
    found: np.ndarray
    moment: np.ndarray
    cables: CableStates
    wrench: np.ndarray


def free_orientation(
    robot: Robot | RobotArrays,
    position: npt.ArrayLike,
    angles: npt.ArrayLike,
    free: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    model: str | CableModel = "sagging",
) -> FreeOrientation:
    """Orientations at which the platform hangs freely, tensions within the robot's force limits.

    Parameters
    ----------
    position, angles : (k, 3) [m]; (3,) or (k, 3) rx, ry, rz [rad], where the search begins and the angles that are kept
    free : (3,) bool, which of rx, ry, rz are free
    external_wrench : (6,) or (k, 6) on the platform about its origin beside its weight, world axes [N, N m]
    """
    place = np.asarray(position, dtype=float)
    arrays, k = RobotArrays.of(robot).flattened((len(place),)), len(place)
    wrench = np.zeros(6) if external_wrench is None else np.asarray(external_wrench, dtype=float)
    low, high = (np.broadcast_to(f, (k, arrays.cable_count)) for f in (arrays.force_min, arrays.force_max))
    chosen = np.asarray(free, dtype=bool)
    problem = HangingProblem(arrays, cable_model(model), place, np.broadcast_to(wrench, (k, 6)), (low, high), chosen)
    return hang_freely(problem, np.array(np.broadcast_to(np.asarray(angles, dtype=float), (k, 3))))


def names_of(free: Sequence[bool] | np.ndarray) -> list[str]:
    """Names of the free angles, (3,) bool."""
    return [name for name, chosen in zip(ANGLES, free, strict=True) if chosen]


def left_free(
    free: npt.ArrayLike,
    cables: int,
    guided: npt.ArrayLike = (0,) * 6,
    named: tuple[str, str] = ("cable", "cables"),
) -> np.ndarray:
    """(3,) bool: the angles that are free if those of `free` (3,) are asked for: as many as the cables cannot hold too.

    guided : (6,) bool, what a guide holds of x, y, z, rx, ry, rz
    named : one and several of what holds the platform: winches, where these are fewer

    Raises
    ------
    ValueError : too few cables to place the platform.
    """
    chosen, held = np.array(free, dtype=bool), np.asarray(guided, dtype=bool)
    missing = 6 - int(held.sum()) - cables - int(chosen.sum())
    others = np.flatnonzero(~chosen & ~held[3:])
    if missing > len(others):
        many = f"{cables} {named[cables > 1]}"
        raise ValueError(f"{many} cannot place this platform; at least {cables + missing - len(others)} are needed")
    chosen[others[: max(missing, 0)]] = True
    return chosen


def turn_with_guide(free: np.ndarray, angles: np.ndarray, guided: npt.ArrayLike) -> bool:
    """Whether a guide, (6,) bool, allows changes of the free angles, (3,) bool, at rx, ry, rz (..., 3) [rad]: any if it
    leaves the rotations alone, else one about the only world axis that is left."""
    held = np.asarray(guided, dtype=bool)[3:]
    if not held.any():
        return True
    allowed = held.sum() == 2 and not (held & free).any()
    return bool(allowed and np.abs(turning_axes(angles)[..., free, :] @ np.eye(3)[:, held]).max() <= _ALIGNED)


@dataclass(frozen=True, slots=True, eq=False)
class HangingProblem:
    """Positions (k, 3) [m], load (k, 6) [N, N m] beside the weight, bounds (k, m) [N]; free : (3,) bool."""

    arrays: RobotArrays
    model: CableModel
    position: np.ndarray
    wrench: np.ndarray
    bounds: tuple[np.ndarray, np.ndarray]
    free: np.ndarray

    def take(self, index: np.ndarray) -> "HangingProblem":
        low, high = self.bounds
        arrays = self.arrays.take(index)
        return HangingProblem(
            arrays, self.model, self.position[index], self.wrench[index], (low[index], high[index]), self.free
        )

    def at(self, angles: np.ndarray, tension: np.ndarray | None = None) -> "_Hung":
        """Moments at angles (k, 3) [rad]; the search for the tensions begins at `tension` (k, m) [N]."""
        return self.hung(angles, rotation_from_angles(*np.moveaxis(angles, -1, 0)), tension)

    def turned(self, ends: "_Hung", step: np.ndarray) -> "_Hung":
        """Moments once the free angles have changed by steps (k, 3) [rad], or about the world axes if all are free."""
        if not self.free.all():
            return self.at(ends.angles + step, ends.tension)
        rotation = rotation_from_vector(step) @ ends.rotation
        return self.hung(angles_from_rotation(rotation), rotation, ends.tension)

    def hung(self, angles: np.ndarray, rotation: np.ndarray, tension: np.ndarray | None) -> "_Hung":
        """Moments at angles (k, 3) [rad] and their rotations (k, 3, 3)."""
        axes = np.broadcast_to(np.eye(3), rotation.shape) if self.free.all() else turning_axes(angles)
        problem = HoldingProblem.at(self.arrays, self.model, (self.position, rotation), self.wrench, self.bounds)
        problem = replace(problem, kept=_kept(axes, self.free))
        tension = problem.solve(tension)[0]
        states = self.model.hold(problem.arrays, problem.arms.points, tension).states
        left = cable_wrench(states, problem.arms) + problem.load
        pulls = np.linalg.norm(problem.load[:, :3], axis=1) + states.tension_at_platform.sum(axis=1)
        about = np.where(self.free, np.einsum("kij,kj->ki", axes, left[:, 3:]), 0.0)
        unbalanced = np.linalg.norm(problem.balanced(left / problem.unit), axis=1)
        carried = (unbalanced <= allowed_unbalance(self.arrays, _WITHIN, pulls)) & ~lost(states).any(axis=1)
        return _Hung(angles, rotation, tension, about / (platform_radius(self.arrays) * pulls)[:, None], carried)


@dataclass(frozen=True, slots=True, eq=False)
class _Hung(BatchItems):
    """angles (k, 3) [rad], rotations (k, 3, 3), chord tensions (k, m) [N], moments (k, 3) about the free angles over
    arms times tensions, and whether the tensions balance all else (k,)."""

    angles: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray
    moment: np.ndarray
    carried: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """(k,) largest moment."""
        return np.asarray(np.abs(self.moment).max(axis=1))

    @property
    def found(self) -> np.ndarray:
        """(k,) bool: carried, with no moment left."""
        return np.asarray(self.carried & (self.size <= _BALANCED))


def hang_freely(problem: HangingProblem, angles: np.ndarray) -> FreeOrientation:
    """Free angles found from given ones (k, 3) [rad], or else from level ones; the others stay."""
    ends = _newton(problem, problem.at(angles))
    level = np.where(problem.free, 0.0, angles)
    lost = np.flatnonzero(~ends.found & (level != angles).any(axis=1))
    if lost.size:
        _begun_again(problem, ends, lost, level[lost])
    if len(angles) == 1:
        _tilted_starts(problem, ends, angles)
    for _ in range(_NEXT):
        lost, reached = np.flatnonzero(~ends.found), np.flatnonzero(ends.found)
        if not lost.size or not reached.size:
            break
        apart = np.linalg.norm(problem.position[lost, None] - problem.position[None, reached], axis=-1)
        near = ends.take(reached[apart.argmin(axis=1)])
        _begun_again(problem, ends, lost, np.where(problem.free, near.angles, angles[lost]), near.tension)
    return _checked(problem, ends)


def _begun_again(
    problem: HangingProblem, ends: _Hung, lost: np.ndarray, angles: np.ndarray, tension: np.ndarray | None = None
) -> None:
    """Newton once more for some items from other angles (n, 3) [rad]; takes what is better, in place."""
    part = problem.take(lost)
    again = _newton(part, part.at(angles, tension))
    as_good, before = again.carried == ends.carried[lost], ends.size[lost]
    better = np.where(as_good, again.size < before, again.carried)
    ends.replaced(lost[better], again.take(better))


def _tilted_starts(problem: HangingProblem, ends: _Hung, angles: np.ndarray) -> None:
    """A single pose, which has no neighbours, begun again from beside its angles (1, 3), where tensions carry it."""
    for shift in _TILT * np.concatenate([np.eye(3), -np.eye(3)])[np.tile(problem.free, 2)]:
        if not ends.found[0] and problem.at(angles + shift).carried[0]:
            _begun_again(problem, ends, np.zeros(1, dtype=int), angles + shift)


def _checked(problem: HangingProblem, ends: _Hung) -> FreeOrientation:
    """Where the search ends, and whether the tensions there balance the rest within their bounds."""
    arrays, (low, high) = problem.arrays, problem.bounds
    arms = PlatformArms.at(arrays, problem.position, ends.rotation)
    cables = problem.model.hold(arrays, arms.points, ends.tension).states
    wrench = free_part(cable_wrench(cables, arms) + load_wrench(arrays, arms) + problem.wrench, arrays)
    pull = cables.tension_at_platform
    size = np.linalg.norm(problem.wrench[:, :3], axis=1) + arrays.mass * arrays.gravity + pull.sum(axis=1)
    margin = _WITHIN * size[:, None]
    inside = ((pull >= low - margin) & (pull <= high + margin)).all(axis=1)
    left = np.abs(np.concatenate([wrench[:, :3], wrench[:, 3:] / platform_radius(arrays)], axis=1)).max(axis=1)
    found = (ends.size <= _BALANCED) & inside & (left <= allowed_unbalance(arrays, _WITHIN, size))
    found &= ~lost(cables).any(axis=1)
    return FreeOrientation(ends.angles, ends.rotation, found, ends.moment, cables, wrench)


def _newton(problem: HangingProblem, ends: _Hung) -> _Hung:
    """Where Newton on the free angles ends; a step that does not reduce the moment is cut down."""
    items = np.flatnonzero(ends.size > _BALANCED)
    step, share = np.zeros_like(ends.angles), np.ones(len(ends.angles))
    fresh = items
    for _ in range(_ITERATIONS):
        if not items.size:
            break
        if fresh.size:
            step[fresh] = _step(problem.take(fresh), ends.take(fresh))
        tried = problem.take(items).turned(ends.take(items), share[items, None] * step[items])
        better = tried.size < ends.size[items]
        ends.replaced(items[better], tried.take(better))
        share[items] = np.where(better, 1.0, 0.25 * share[items])
        going = (ends.size[items] > _BALANCED) & (share[items] > 1e-3)
        items, fresh = items[going], items[going & better]
    return ends


def _step(problem: HangingProblem, ends: _Hung) -> np.ndarray:
    """(k, 3) Newton step of the free angles [rad]."""
    free, k = np.flatnonzero(problem.free), len(ends.angles)
    every = np.tile(np.arange(k), len(free))
    shifts = np.repeat(_DIFFERENCE * np.eye(3)[free], k, axis=0)
    there = problem.take(every).turned(ends.take(every), shifts).moment
    rates = np.moveaxis((there.reshape((-1, k, 3)) - ends.moment) / _DIFFERENCE, 0, -1)[:, free]
    step = np.zeros_like(ends.angles)
    step[:, free] = -(np.linalg.pinv(rates, rcond=1e-8) @ ends.moment[:, free, None])[..., 0]
    return within_largest_turn(step)


def within_largest_turn(step: np.ndarray) -> np.ndarray:
    """Steps (k, 3) [rad], shortened where one of their turns is larger than a search may take."""
    return step * np.minimum(1.0, _LARGEST_TURN / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))


def turning_axes(angles: np.ndarray) -> np.ndarray:
    """(..., 3, 3) rows: world axes about which rx, ry and rz (..., 3) [rad] turn the platform."""
    _, ry, rz = np.moveaxis(angles, -1, 0)
    zero, one = np.zeros_like(ry), np.ones_like(ry)
    first = np.stack([np.cos(rz) * np.cos(ry), np.sin(rz) * np.cos(ry), -np.sin(ry)], axis=-1)
    return np.stack(
        [first, np.stack([-np.sin(rz), np.cos(rz), zero], axis=-1), np.stack([zero, zero, one], -1)], axis=-2
    )


def _kept(axes: np.ndarray, free: np.ndarray) -> np.ndarray:
    """(k, 3, 3) projection on the moments that do no work when the free angles change."""
    rows = axes[:, free]
    return np.asarray(np.eye(3) - np.linalg.pinv(rows, rcond=_ALIGNED) @ rows)

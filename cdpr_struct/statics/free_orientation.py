"""Which orientation does a platform take at a given position if some of its angles are left free?

The tensions are those of least norm that balance the forces and the moments about the angles that are kept: the cables
do nothing to turn the platform about the others. The free angles are where these tensions leave no moment about them.
Newton on the free angles of all poses at once; its derivatives are differences. Poses it does not reach from the given
angles are begun again from the nearest one that it reached.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench
from cdpr_struct.statics.holding_tensions import HoldingProblem

ANGLES = ("rx", "ry", "rz")
_ITERATIONS = 25
_DIFFERENCE = 1e-6  # [rad]
_LARGEST_TURN = 0.2  # of one step [rad]
_BALANCED = 1e-11  # moment over arms times tensions
_WITHIN = 1e-8  # of load and tensions: what counts as balanced and within the bounds
_NEXT = 3  # rounds of starts from neighbours


@dataclass(frozen=True, slots=True, eq=False)
class FreeOrientation:
    """Orientations of a flat batch (k).

    angles : (k, 3) rx, ry, rz [rad];  rotation : (k, 3, 3) platform to world
    found  : (k,) bool, no moment is left about the free angles, and tensions balance the rest within their bounds
    cables : `CableStates` (k, m) there;  wrench : (k, 6) that is left unbalanced [N, N m]
    moment : (k, 3) about the free angles, 0 about the others, over arms times tensions
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


def left_free(free: npt.ArrayLike, cables: int) -> np.ndarray:
    """(3,) bool: the angles that are free if those of `free` (3,) are asked for: as many as the cables cannot hold too.

    Raises
    ------
    ValueError : too few cables to place the platform.
    """
    chosen = np.array(free, dtype=bool)
    missing = 6 - cables - int(chosen.sum())
    if cables < 3:
        raise ValueError(f"{cables} cables cannot place a platform; three are needed")
    chosen[np.flatnonzero(~chosen)[: max(missing, 0)]] = True
    return chosen


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

    def hung(self, angles: np.ndarray, tension: np.ndarray | None = None) -> "_Hung":
        """Moments at angles (k, 3) [rad]; the search for the tensions begins at `tension` (k, m) [N]."""
        axes = turning_axes(angles)
        pose = self.position, rotation_from_angles(*np.moveaxis(angles, -1, 0))
        problem = HoldingProblem.at(self.arrays, self.model, pose, self.wrench, self.bounds)
        problem = replace(problem, kept=_kept(axes, self.free))
        tension = problem.solve(tension)[0]
        states = self.model.hold(problem.arrays, problem.arms.points, tension).states
        left = cable_wrench(states, problem.arms) + problem.load
        pulls = np.linalg.norm(problem.load[:, :3], axis=1) + states.tension_at_platform.sum(axis=1)
        about = np.where(self.free, np.einsum("kij,kj->ki", axes, left[:, 3:]), 0.0)
        return _Hung(angles, tension, about / (problem.unit[:, 3] * pulls)[:, None])


@dataclass(frozen=True, slots=True, eq=False)
class _Hung:
    """angles (k, 3) [rad], chord tensions (k, m) [N], moments (k, 3) about the free angles over arms times tensions."""

    angles: np.ndarray
    tension: np.ndarray
    moment: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """(k,) largest moment."""
        return np.asarray(np.abs(self.moment).max(axis=1))

    def take(self, index: np.ndarray) -> "_Hung":
        return _Hung(self.angles[index], self.tension[index], self.moment[index])

    def replaced(self, index: np.ndarray, other: "_Hung") -> None:
        """Takes the items `index` from another; works in place."""
        for name in self.__slots__:
            getattr(self, name)[index] = getattr(other, name)


def hang_freely(problem: HangingProblem, angles: np.ndarray) -> FreeOrientation:
    """Free angles found from given ones (k, 3) [rad]; the others stay."""
    ends = _newton(problem, problem.hung(angles.copy()))
    for _ in range(_NEXT):
        found = ends.size <= _BALANCED
        lost, reached = np.flatnonzero(~found), np.flatnonzero(found)
        if not lost.size or not reached.size:
            break
        apart = np.linalg.norm(problem.position[lost, None] - problem.position[None, reached], axis=-1)
        near = ends.take(reached[apart.argmin(axis=1)])
        part = problem.take(lost)
        again = _newton(part, part.hung(np.where(problem.free, near.angles, angles[lost]), near.tension))
        better = again.size < ends.size[lost]
        ends.replaced(lost[better], again.take(better))
    rotation = rotation_from_angles(*np.moveaxis(ends.angles, -1, 0))
    arrays, (low, high) = problem.arrays, problem.bounds
    arms = PlatformArms.at(arrays, problem.position, rotation)
    cables = problem.model.hold(arrays, arms.points, ends.tension).states
    wrench = cable_wrench(cables, arms) + load_wrench(arrays, arms) + problem.wrench
    pull = cables.tension_at_platform
    size = np.linalg.norm(problem.wrench[:, :3], axis=1) + arrays.mass * arrays.gravity + pull.sum(axis=1)
    margin = _WITHIN * size[:, None]
    inside = ((pull >= low - margin) & (pull <= high + margin)).all(axis=1)
    radius = np.linalg.norm(arms.arms, axis=-1).max(axis=1)[:, None]
    left = np.abs(np.concatenate([wrench[:, :3], wrench[:, 3:] / radius], axis=1)).max(axis=1)
    balanced = left <= _WITHIN * size
    found = (ends.size <= _BALANCED) & inside & balanced
    return FreeOrientation(ends.angles, rotation, found, ends.moment, cables, wrench)


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
        tried = problem.take(items).hung(ends.angles[items] + share[items, None] * step[items], ends.tension[items])
        better = tried.size < ends.size[items]
        ends.replaced(items[better], tried.take(better))
        share[items] = np.where(better, 1.0, 0.25 * share[items])
        going = (ends.size[items] > _BALANCED) & (share[items] > 1e-3)
        items, fresh = items[going], items[going & better]
    return ends


def _step(problem: HangingProblem, ends: _Hung) -> np.ndarray:
    """(k, 3) Newton step of the free angles [rad]."""
    free, k = np.flatnonzero(problem.free), len(ends.angles)
    shifted = np.repeat(ends.angles[None], len(free), axis=0)
    shifted[np.arange(len(free)), :, free] += _DIFFERENCE
    near = np.tile(ends.tension, (len(free), 1))
    there = problem.take(np.tile(np.arange(k), len(free))).hung(shifted.reshape((-1, 3)), near).moment
    rates = np.moveaxis((there.reshape((-1, k, 3)) - ends.moment) / _DIFFERENCE, 0, -1)[:, free]
    step = np.zeros_like(ends.angles)
    step[:, free] = -(np.linalg.pinv(rates, rcond=1e-8) @ ends.moment[:, free, None])[..., 0]
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
    across = np.swapaxes(rows, -1, -2) @ np.linalg.solve(rows @ np.swapaxes(rows, -1, -2), rows)
    return np.asarray(np.eye(3) - across)

"""Which orientation does a platform take at a given position if some of its angles are left free?

The tensions are those of least norm that balance the forces and the moments about the angles that are kept: the cables
do nothing to turn the platform about the others. The free angles are where these tensions leave no moment about them.
The search begins at the angles given. Poses that it does not reach from there are begun again from the nearest one that
it reached; a single pose, which has no neighbours, from orientations all around.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.pose import angle_between
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import CableModel, cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, platform_radius
from cdpr_struct.statics.guides import free_part
from cdpr_struct.statics.hanging_balance import balanced_together
from cdpr_struct.statics.hanging_search import BALANCED, WITHIN, HangingProblem, Hung, newton, turning_axes
from cdpr_struct.statics.held_stability import held_stability
from cdpr_struct.statics.holding_tensions import allowed_unbalance
from cdpr_struct.statics.lost_cables import lost

ANGLES = ("rx", "ry", "rz")
_ALIGNED = 1e-9  # by so much an axis of a free angle may differ from one about which a guide lets the platform turn
_TILTS = (0.3, 0.8, 1.3)  # [rad], of starts around the angles given
_EACH = 4  # starts of each tilt from which the search goes on
_QUARTER = 0.5 * np.pi  # [rad]: a platform turned further has tumbled
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


def hang_freely(problem: HangingProblem, angles: np.ndarray) -> FreeOrientation:
    """Free angles found from given ones (k, 3) [rad], or else from level ones; the others stay."""
    ends = newton(problem, problem.at(angles.copy()))  # it works in place
    level = np.where(problem.free, 0.0, angles)
    lost = np.flatnonzero(~ends.found & (level != angles).any(axis=1))
    if lost.size:
        _begun_again(problem, ends, lost, level[lost])
    if len(angles) == 1 and not ends.found[0]:
        _from_all_around(problem, ends, angles)
    for _ in range(_NEXT):
        lost, reached = np.flatnonzero(~ends.found), np.flatnonzero(ends.found)
        if not lost.size or not reached.size:
            break
        apart = np.linalg.norm(problem.position[lost, None] - problem.position[None, reached], axis=-1)
        near = ends.take(reached[apart.argmin(axis=1)])
        _begun_again(problem, ends, lost, np.where(problem.free, near.angles, angles[lost]), near.tension)
    return _checked(problem, balanced_together(problem, ends))


def _begun_again(
    problem: HangingProblem, ends: Hung, lost: np.ndarray, angles: np.ndarray, tension: np.ndarray | None = None
) -> None:
    """Newton once more for some items from other angles (n, 3) [rad]; takes what is better, in place."""
    part = problem.take(lost)
    again = newton(part, part.at(angles, tension))
    as_good, before = again.carried == ends.carried[lost], ends.size[lost]
    better = np.where(as_good, again.size < before, again.carried)
    ends.replaced(lost[better], again.take(better))


def _from_all_around(problem: HangingProblem, ends: Hung, angles: np.ndarray) -> None:
    """A single pose, which has no neighbours, begun again from orientations around its angles (1, 3), in place.

    The search goes on from a few of each tilt: those where tensions carry the platform before others, least moments
    first. Of the orientations found within a quarter turn, one that is held goes before one that is not, and the
    nearest before others.
    """
    starts = angles + _shifts(problem.free)
    many = problem.take(np.zeros(len(starts), dtype=int))
    begun = many.at(starts)
    rings = np.split(np.arange(len(starts)), len(_TILTS))
    some = np.concatenate([ring[np.lexsort((begun.size[ring], ~begun.carried[ring]))][:_EACH] for ring in rings])
    part = many.take(some)
    reached = newton(part, begun.take(some))
    hung, given = _checked(part, reached), rotation_from_angles(*angles[0])
    held = held_stability(part.arrays, part.position, hung.rotation, hung.cables).stable
    turn = angle_between(hung.rotation, given)
    chosen = np.flatnonzero(hung.found & (turn <= _QUARTER))
    if chosen.size:
        best = chosen[np.lexsort((turn[chosen], ~held[chosen]))[:1]]
        ends.replaced(np.zeros(1, dtype=int), reached.take(best))


def _shifts(free: np.ndarray) -> np.ndarray:
    """(n, 3) of the free angles [rad]: along their axes and diagonals, near and far."""
    signs = np.stack(np.meshgrid(*[(-1.0, 0.0, 1.0) if chosen else (0.0,) for chosen in free], indexing="ij"), axis=-1)
    ways = signs.reshape(-1, 3)
    ways = ways[ways.any(axis=1)]
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    return np.concatenate([shift * ways for shift in _TILTS])


def _checked(problem: HangingProblem, ends: Hung) -> FreeOrientation:
    """Where the search ends, and whether the tensions there balance the rest within their bounds."""
    arrays, (low, high) = problem.arrays, problem.bounds
    arms = PlatformArms.at(arrays, problem.position, ends.rotation)
    cables = problem.model.hold(arrays, arms.points, ends.tension).states
    wrench = free_part(cable_wrench(cables, arms) + load_wrench(arrays, arms) + problem.wrench, arrays)
    pull = cables.tension_at_platform
    size = np.linalg.norm(problem.wrench[:, :3], axis=1) + arrays.mass * arrays.gravity + pull.sum(axis=1)
    margin = WITHIN * size[:, None]
    inside = ((pull >= low - margin) & (pull <= high + margin)).all(axis=1)
    left = np.abs(np.concatenate([wrench[:, :3], wrench[:, 3:] / platform_radius(arrays)], axis=1)).max(axis=1)
    found = (ends.size <= BALANCED) & inside & (left <= allowed_unbalance(arrays, WITHIN, size))
    found &= ~lost(cables).any(axis=1)
    return FreeOrientation(ends.angles, ends.rotation, found, ends.moment, cables, wrench)

"""Which lower bound of force makes poses stable and every cable taut?

A ladder of bounds is tried at once, from half the weight of the lightest cable to far above all loads, then a finer one
below the first rung that will do. Rungs are rounded up to two digits before they are tried, so the answer was tried.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, load_wrench, tangent_stiffness
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.neutral_freedoms import stability
from cdpr_struct.statics.pose_error import pose_error
from cdpr_struct.statics.slack_cables import hangs_slack

RUNGS = 15
_FINER = 7  # rungs between the first that will do and the one below it
_LOWEST = 0.5, 1e-3  # of the lightest cable's weight, of the load: the larger of the two
_HIGHEST = 30.0, 3.0  # of the heaviest cable's weight, of the load: the larger of the two
_STRAINS = 1e-5, 1e-2  # of the softest cable, where there is neither weight nor load

Judge = Callable[[np.ndarray], np.ndarray]
"""From lower bounds (b,) [N] to whether each will do at each of n poses, (b, n) bool."""


@dataclass(frozen=True, slots=True)
class SufficientBound:
    """A lower bound for several poses.

    bound : smallest of the ladder that will do at most poses, two digits [N]; None if none does at any
    works : at how many poses it will do;  tried : number of poses
    """

    bound: float | None
    works: int
    tried: int


def sufficient_lower_bound(
    robot: Robot,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    upper: float | None = None,
) -> float | None:
    """Lower bound of force [N] at which a pose is held and stable, and no cable hangs slack; None if none is found.

    Parameters
    ----------
    position, rotation : (3,) [m], (3, 3) platform to world
    external_wrench : (6,) on the platform beside its weight, world axes [N, N m]
    upper : bound of force from above [N]; None: the robot's own

    It does not matter whether the pose is held or stable without the bound.
    """
    place = np.asarray(position, dtype=float)[None]
    return shared_lower_bound(robot, place, rotation, external_wrench, upper).bound


def shared_lower_bound(
    robot: Robot,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    upper: float | None = None,
) -> SufficientBound:
    """The same for poses (n, 3), (n, 3, 3): the bound that will do at most of them."""
    arrays = RobotArrays.of(robot)
    if upper is not None:
        arrays = replace(arrays, force_max=np.full(1, float(upper)))
    place, turn = np.asarray(position, dtype=float), np.asarray(rotation, dtype=float)

    def judge(bounds: np.ndarray) -> np.ndarray:
        low = bounds[:, None, None]
        found = inverse(arrays, place, turn, "sagging", external_wrench, low, allow_unheld=True)
        taut = found.held & ~hangs_slack(found.cables).any(axis=-1)
        return _stable(arrays, place, turn, found.cables, taut)

    return _search(judge, arrays, place, turn, external_wrench)


def shared_bound_of_pose_errors(robot: Robot, position: npt.ArrayLike, rotation: npt.ArrayLike) -> SufficientBound:
    """Lower bound of force at which the platform, let go at the lengths for poses (n, 3), has no slack cable.

    The bound is wound in at the reference poses as `pose_error` does it, and the sagging model then decides.
    """
    arrays = RobotArrays.of(robot)
    place, turn = np.asarray(position, dtype=float), np.asarray(rotation, dtype=float)

    def judge(bounds: np.ndarray) -> np.ndarray:
        low = bounds[:, None, None] * np.ones(arrays.cable_count)
        error = pose_error(replace(arrays, force_min=low), place, turn)
        return error.held & error.converged & ~hangs_slack(error.sagging.cables).any(axis=-1)

    return _search(judge, arrays, place, turn, None)


def _ladder(
    arrays: RobotArrays, place: np.ndarray, turn: np.ndarray, external_wrench: npt.ArrayLike | None
) -> np.ndarray:
    """(b,) bounds [N] from below every cable's weight to above all loads."""
    arms = PlatformArms.at(arrays, place, turn)
    chords = arms.points - arrays.frame_anchors
    weight = arrays.cable_load(chords)[0] * np.linalg.norm(chords, axis=-1)
    wrench = load_wrench(arrays, arms) + (0.0 if external_wrench is None else np.asarray(external_wrench))
    load = float(np.linalg.norm(wrench[..., :3], axis=-1).max())
    if not (load or weight.any()):
        return np.asarray(float(arrays.axial_stiffness.min()) * np.geomspace(*_STRAINS, RUNGS))
    lowest = max(_LOWEST[0] * weight.min(), _LOWEST[1] * load)
    return np.geomspace(lowest, max(_HIGHEST[0] * weight.max(), _HIGHEST[1] * load), RUNGS)


def _stable(
    arrays: RobotArrays, place: np.ndarray, turn: np.ndarray, states: CableStates, chosen: np.ndarray
) -> np.ndarray:
    """(b, n) bool: chosen, and no small motion of the platform grows at locked lengths."""
    stable = np.zeros(chosen.shape, dtype=bool)
    poses = np.nonzero(chosen)[-1]
    if poses.size:
        turns = np.broadcast_to(turn, (*place.shape[:-1], 3, 3))
        arms = PlatformArms.at(arrays, place[poses], turns[poses])
        matrix = tangent_stiffness(arrays, states.at(chosen), arms)
        stable[chosen] = ~stability(arrays.take(poses) if arrays.batch_shape else arrays, turns[poses], matrix).unstable
    return stable


def _search(
    judge: Judge,
    arrays: RobotArrays,
    place: np.ndarray,
    turn: np.ndarray,
    external_wrench: npt.ArrayLike | None,
) -> SufficientBound:
    """The first bound that will do at as many poses as any; of two digits."""
    limit, none = float(arrays.force_max.min()), SufficientBound(None, 0, len(place))
    ladder = _two_digits(_ladder(arrays, place, turn, external_wrench), limit)
    coarse = _first_of_most(judge, ladder, len(place)) if ladder.size else none
    if coarse.bound is None or coarse.bound == ladder[0]:
        return coarse
    below = ladder[np.searchsorted(ladder, coarse.bound) - 1]
    return _first_of_most(judge, _two_digits(np.geomspace(below, coarse.bound, _FINER), limit), len(place))


def _first_of_most(judge: Judge, ladder: np.ndarray, poses: int) -> SufficientBound:
    works = judge(ladder).sum(axis=1)
    best = int(works.argmax())
    return SufficientBound(float(ladder[best]) if works[best] else None, int(works[best]), poses)


def _two_digits(forces: np.ndarray, limit: float) -> np.ndarray:
    """(b,) forces rounded up, each once, those below a limit."""
    rounded = np.unique([rounded_up(force) for force in forces])
    return rounded[rounded < limit]


def rounded_up(force: float) -> float:
    """The next number of two digits."""
    step = 10.0 ** (np.floor(np.log10(force)) - 1.0)
    return float(f"{np.ceil(force / step * (1.0 - 1e-12)) * step:.6g}")

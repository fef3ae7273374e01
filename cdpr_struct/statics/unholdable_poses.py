"""Why is a pose not held? Which direction no cable acts in, or which cable's bound is in the way, and how much."""

import numpy as np
from scipy.optimize import nnls

from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.least_crossing import LeastCrossing, least_crossing
from cdpr_struct.statics.pulley import behind_wheel, within_wheel

DIRECTIONS = ("force x", "force y", "force z", "moment x", "moment y", "moment z")
_NO_LENGTH = 1e-9  # of the robot's size: ends of a cable this near to each other leave it no direction
_GIVE_LENGTHS = "Give cable lengths to find where the platform hangs."
_LET_HANG = "Leave its angles free (--free rx,ry,rz where the command has it), or give cable lengths."


def without_length(problem: HoldingProblem) -> np.ndarray:
    """(k, m) bool: the platform anchor lies on the frame anchor, and the cable has no direction."""
    anchors = problem.arrays.frame_anchors
    size = np.linalg.norm(anchors - anchors.mean(axis=-2, keepdims=True), axis=-1).max(axis=-1)
    return np.asarray(np.linalg.norm(problem.arms.points - anchors, axis=-1) <= _NO_LENGTH * size[..., None])


def no_length_error(nothing: np.ndarray) -> UnholdablePoseError:
    """Error about cables without length, (k, m) bool."""
    pose, cable = (int(i) for i in np.argwhere(nothing)[0])
    where = "this pose" if len(nothing) == 1 else f"pose {pose + 1} of {len(nothing)}"
    reason = f"cable {cable + 1} has no length at {where}: its platform anchor lies on its frame anchor. Move the pose."
    return UnholdablePoseError(reason, cable + 1)


def behind_wheels(arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
    """(k, m) bool: platform anchors (k, m, 3) behind the wheels of pulleys, to which a cable turns by over 180 deg, or
    within them."""
    return behind_wheel(points - arrays.frame_anchors, arrays.pulley_axis, arrays.pulley_radius)


def ends_within_wheels(arrays: RobotArrays, points: np.ndarray) -> np.ndarray:
    """(k, m) bool: platform anchors (k, m, 3) within the wheels of pulleys."""
    return within_wheel(points - arrays.frame_anchors, arrays.pulley_axis, arrays.pulley_radius)


def half_turn_error(arrays: RobotArrays, behind: np.ndarray) -> UnholdablePoseError:
    """Error about cables that end behind or within their wheels, (k, m) bool."""
    pose, cable = (int(i) for i in np.argwhere(behind)[0])
    where = "this pose" if len(behind) == 1 else f"pose {pose + 1} of {len(behind)}"
    across = 2.0 * float(np.broadcast_to(arrays.pulley_radius, behind.shape)[pose, cable])
    return UnholdablePoseError(
        f"cable {cable + 1} would turn by more than 180° on its pulley at {where}, which is not covered: its platform "
        f"anchor lies behind or within the wheel, nearer to the swivel axis than the wheel is wide ({across:.4g} m). "
        "Move the pose, or turn the swivel axis.",
        cable + 1,
    )


def unholdable(
    problem: HoldingProblem, held: np.ndarray, residual: np.ndarray, tension: np.ndarray, proven: np.ndarray
) -> UnholdablePoseError:
    """Error about the pose that is worst off.

    Parameters
    ----------
    held     : (k,) bool;  proven : (k,) bool, it is certain that no tensions hold the pose
    residual : (k, 6) wrench that the best attempt leaves unbalanced [N, N m];  tension : (k, m) its tensions [N]
    """
    failed = np.flatnonzero(~held)
    worst = failed[np.linalg.norm(residual[failed] / problem.unit[failed], axis=1).argmax()]
    one = problem.take(np.array([worst]))
    left = one.unbounded_tensions()[1][0]
    who = "the cables cannot hold " + ("this pose" if held.size == 1 else f"{failed.size} of {held.size} poses")
    if np.linalg.norm(left / one.unit[0]) > 1e-6 * np.linalg.norm(one.load / one.unit):
        axis = int(np.abs(left / one.unit[0]).argmax())
        amount = float(abs(left[axis]))
        reason = f"{who}: no cable acts against {amount:.4g} {'N' if axis < 3 else 'N m'} of {DIRECTIONS[axis]}. "
        return UnholdablePoseError(reason + (_LET_HANG if _forces_balance(one) else _GIVE_LENGTHS), None, amount)
    crossed = _crossed(one, residual[worst], tension[worst])
    size = 1e-9 * np.linalg.norm(one.load / one.unit)
    if crossed is not None and crossed.amount > size:
        doubt = "" if proven[worst] else "(The search found none; that there is none is not proven.) "
        reason = f"{who}: {crossed.said(one.low[0], one.high[0])}. "
        hint = "Move the pose, change the load or the bounds."
        return UnholdablePoseError(reason + doubt + hint, crossed.cable + 1, crossed.amount)
    if one.low.shape[1] < 6:
        return UnholdablePoseError(
            f"{who}: {one.low.shape[1]} cables cannot balance the platform there. {_GIVE_LENGTHS}"
        )
    return UnholdablePoseError(f"{who}: the cables' own weight uses up the bounds. Widen them, or move the pose.")


def _forces_balance(one: HoldingProblem) -> bool:
    """Straight cables that pull balance the forces, and only moments are in the way; not where a guide takes some."""
    if one.arrays.has_guides:
        return False
    force = -one.load[0, :3]
    left = nnls(one.straight_matrix()[0, :, :3].T, force)[1]
    return bool(left <= 1e-6 * np.linalg.norm(force))


def _crossed(one: HoldingProblem, residual: np.ndarray, tension: np.ndarray) -> LeastCrossing | None:
    """Bounds in the way, for taut cables around the tensions of the best attempt (m,) [N]."""
    matrix = np.swapaxes(one.straight_matrix(), -1, -2)[0] / one.unit[0][:, None]
    target = matrix @ tension - residual / one.unit[0]
    return least_crossing(matrix, target, one.low[0], one.high[0])

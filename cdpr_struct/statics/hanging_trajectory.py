"""Which orientations does a platform take along a path if some of its angles are left free?

At every instant that at which tensions of least norm carry weight and inertia of the platform's translation and do
nothing to turn it about its free angles: it hangs along the apparent gravity. The inertia of its turning from instant
to instant is left out, since cables that leave an angle free may have no moment about it; how large it is is told.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_models import CableModel
from cdpr_struct.statics.free_orientation import FreeOrientation, free_orientation
from cdpr_struct.statics.trajectory import Trajectory, turning_by

_ROUNDS = 60
_SETTLED = 1e-10  # [rad]


@dataclass(frozen=True, slots=True, eq=False)
class HangingTrajectory:
    """A path with orientations at which the platform hangs.

    trajectory : its angular rates are zero
    left_out   : (k,) moment of the inertia of turning that is left out [N m]
    """

    trajectory: Trajectory
    left_out: np.ndarray


def hanging_along(
    robot: Robot, path: Trajectory, free: np.ndarray, model: str | CableModel = "sagging"
) -> HangingTrajectory:
    """The path with orientations at which the platform hangs freely.

    free : (3,) bool, of rx, ry, rz; the search begins at those of the path, and the others stay as the path has them

    Raises
    ------
    UnholdablePoseError : at an instant there is none; names the time.
    """
    angles, still = angles_from_rotation(path.rotation), np.zeros_like(path.angular_velocity)
    sliding = replace(path, angular_velocity=still, angular_acceleration=still)
    for _ in range(_ROUNDS):  # the inertia force acts at the centre of mass, so its moment turns with the platform
        wrench = sliding.inertia_wrench(robot.platform)
        hung = free_orientation(robot, path.position, angles, free, wrench, model)
        _require_found(hung, path)
        change, angles = float(np.abs(hung.angles - angles).max()), hung.angles
        sliding = replace(sliding, rotation=hung.rotation)
        if change <= _SETTLED:
            turning = turning_by(path, angles).inertia_wrench(robot.platform)
            return HangingTrajectory(sliding, np.linalg.norm((turning - wrench)[:, 3:], axis=1))
    raise UnholdablePoseError(
        f"the orientation along the path is not settled after {_ROUNDS} rounds (it still changes by {change:.1g} rad): "
        f"the acceleration is too large for the platform to hang along it. Give the trajectory more time."
    )


def _require_found(hung: FreeOrientation, path: Trajectory) -> None:
    lost = np.flatnonzero(~hung.found)
    if lost.size:
        raise UnholdablePoseError(
            f"at {len(lost)} of {len(path)} instants, first at t = {path.time[lost[0]]:.4g} s, no orientation is found "
            f"at which the platform hangs freely within the force limits. Move the path, or widen the limits."
        )

"""From the options of a command to the robot at rest: at a pose that it holds, or at locked cable lengths."""

from typing import TYPE_CHECKING

import numpy as np

from cdpr_struct.cli.options import read_numbers, read_pose
from cdpr_struct.errors import CdprError, InputError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.operating_point import OperatingPoint
    from cdpr_struct.robot.robot import Robot


def rest(robot: "Robot", pose: str | None, lengths: str | None) -> "OperatingPoint":
    """The robot at rest with sagging cables.

    Parameters
    ----------
    pose : text of --pose; the cables hold it with the least norm of tensions within the robot's force limits
    lengths : text of --lengths, the unstrained lengths at which it is locked; only one of the two may be given

    Raises
    ------
    InputError : both given, or an unusable number.
    CdprError : the pose cannot be held, or the lengths lead to no stable equilibrium.
    """
    if lengths is None:
        return _held(robot, pose)
    if pose is not None:
        raise InputError("--lengths", "", lengths, "give either --pose or --lengths, not both")
    return _locked(robot, lengths)


def _held(robot: "Robot", pose: str | None) -> "OperatingPoint":
    from cdpr_struct.dynamics.operating_point import OperatingPoint
    from cdpr_struct.statics.inverse_kinematics import inverse

    where = read_pose(pose, robot)
    solution = inverse(robot, where.position, where.rotation, model="sagging")
    return OperatingPoint(robot, where.position, where.rotation, solution.cables)


def _locked(robot: "Robot", text: str) -> "OperatingPoint":
    from cdpr_struct.dynamics.operating_point import OperatingPoint
    from cdpr_struct.statics.forward_kinematics import forward

    count = len(robot.cables)
    lengths = np.array(
        read_numbers(text, "--lengths", (count,), f"unstrained lengths in m, one per cable of {robot.name}")
    )
    if not (lengths > 0.0).all():
        raise InputError("--lengths", "", text, "lengths must be above zero")
    start = (None, None) if robot.home is None else (robot.home.position, robot.home.rotation)
    solution = forward(robot, lengths, *start).require_converged()
    if not bool(solution.stable):
        raise CdprError(
            f"at these lengths the platform has no stable equilibrium (least {solution.least_stiffness:.3g} N/m)"
        )
    return OperatingPoint(robot, solution.position, solution.rotation, solution.cables)


def pose_in_degrees(point: "OperatingPoint") -> list[float]:
    """[x, y, z, rx, ry, rz] of an operating point, m and deg."""
    from cdpr_struct.robot.pose import angles_from_rotation

    return [*point.position.tolist(), *np.degrees(angles_from_rotation(point.rotation)).tolist()]

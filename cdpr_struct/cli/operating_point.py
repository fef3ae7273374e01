"""From the options of a command to the robot at rest: at a pose that it holds, or at locked cable lengths."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from cdpr_struct.cli.options import read_numbers, read_pose
from cdpr_struct.errors import CdprError, ConvergenceError, InputError, UnholdablePoseError, UnstableEquilibriumError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.operating_point import OperatingPoint
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.statics.inverse_kinematics import InverseSolution


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
    from cdpr_struct.dynamics.operating_point import OperatingPoint

    if lengths is None:
        where = read_pose(pose, robot)
        return OperatingPoint(robot, where.position, where.rotation, held(robot, where).cables)
    if pose is not None:
        raise InputError("--lengths", "", lengths, "give either --pose or --lengths, not both")
    return _locked(robot, lengths)


def held(
    robot: "Robot", where: "Pose", model: str = "sagging", external_wrench: "list[float] | None" = None
) -> "InverseSolution":
    """Tensions and lengths that hold a pose; a refusal that another lower bound would cure names the bound.

    Raises
    ------
    CdprError : the pose cannot be held, or the search for tensions was cut short.
    """
    from cdpr_struct.statics.bound_advice import bound_hint
    from cdpr_struct.statics.inverse_kinematics import inverse

    try:
        return inverse(robot, where.position, where.rotation, model, external_wrench)
    except (UnholdablePoseError, ConvergenceError) as error:
        hint = bound_hint(robot, where.position, where.rotation, external_wrench)
        if not hint:
            raise
        raise CdprError(str(error) + hint) from error


@contextmanager
def advised(point: "OperatingPoint", lengths: str | None) -> Iterator[None]:
    """Work about a state of rest; should it be unstable where a lower bound would cure it, the message names the bound.

    lengths : text of --lengths; locked lengths are what they are, so no bound is named
    """
    try:
        yield
    except UnstableEquilibriumError as error:
        from cdpr_struct.statics.bound_advice import bound_hint

        hint = "" if lengths is not None else bound_hint(point.entered, point.position, point.rotation)
        raise CdprError(f"{error}.{hint}" if hint else str(error)) from error


def state_warnings(point: "OperatingPoint", lengths: str | None) -> list[str]:
    """Sentences on cables that hang slack, and on locked cables outside the robot's force limits."""
    from cdpr_struct.statics.bound_advice import outside_limits, slack_warning
    from cdpr_struct.statics.slack_cables import hangs_slack, slack_sentence

    if lengths is None:
        said = slack_warning(point.entered, point.position, point.rotation, point.cables)
        return [] if said is None else [said]
    slack = slack_sentence(hangs_slack(point.cables))
    return [*([] if slack is None else [f"{slack}."]), *outside_limits(point.entered, point.cables.tension_at_platform)]


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

"""The robot at rest: at a pose that it holds, or at locked cable lengths."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, ConvergenceError, InputError, UnholdablePoseError, UnstableEquilibriumError
from cdpr_struct.interface.arguments import read_lengths, read_pose
from cdpr_struct.interface.free_angles import FreeAngles, HangingPose, hanging_pose
from cdpr_struct.interface.given import Numbers, PoseLike
from cdpr_struct.interface.lumps import require_lumps_on_cables
from cdpr_struct.interface.winches import held_on_shared_winches, winches_json
from cdpr_struct.reports.locked_rest import locked_json
from cdpr_struct.reports.platform_freedoms import freedoms_json
from cdpr_struct.reports.trust import Check
from cdpr_struct.reports.trust_at_rest import trust_at_rest
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.bound_advice import bound_hint
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.statics.locked_rest import LockedRest, locked_rest
from cdpr_struct.statics.slack_cables import cables_named, sagging_cables


@dataclass(frozen=True, slots=True, eq=False)
class AtRest:
    """The robot at rest, and how the pose was found if lengths were given instead of it, or angles left free."""

    point: OperatingPoint
    locked: LockedRest | None = None
    hanging: HangingPose | None = None

    @contextmanager
    def advised(self) -> Iterator[None]:
        """Work about the state of rest; should it be unstable where a lower bound would cure it, the message names it.

        Locked lengths are what they are, so for them no bound is named.
        """
        try:
            yield
        except UnstableEquilibriumError as error:
            point = self.point
            hint = "" if self.locked is not None else bound_hint(point.entered, point.position, point.rotation)
            raise UnstableEquilibriumError(f"{error}.{hint}" if hint else str(error)) from error

    def told(self, *more: Check, warnings: Sequence[str] = (), moves: bool = True) -> dict[str, Any]:
        """What every result says of the state of rest: `trust` with checks of the command's own, deep sag, neutral
        freedoms, what a guide holds, `winches` if cables share some, `locked` if the lengths were given, and `warnings`
        that are no checks.

        moves : whether the command lets the robot vibrate
        """
        state = {"sagging_cables": sagging_cables(self.point.cables), **freedoms_json(self.point)}
        state |= winches_json(self.point.entered, self.point.cables)
        state |= {"trust": trust_at_rest(self.point, self.locked, *more, moves=moves), "warnings": list(warnings)}
        if self.locked is not None:
            return {**state, "locked": locked_json(self.locked)}
        if self.hanging is None:
            return state
        return {**state, **self.hanging.json(), "warnings": [*warnings, self.hanging.sentence()]}


def rest(
    robot: Robot,
    pose: PoseLike | None,
    lengths: Numbers | None,
    start: PoseLike | None = None,
    free: FreeAngles | None = None,
) -> AtRest:
    """The robot at rest with sagging cables.

    Parameters
    ----------
    pose : the cables hold it with the least norm of tensions within the robot's force limits; None: the home pose
    lengths : unstrained lengths at which it is locked [m]; only one of the two may be given
    start : where to look, only with lengths
    free : angles of the pose that hang freely, found from those given

    Raises
    ------
    InputError : both given, or an unusable number.
    CdprError : the pose cannot be held, or the lengths lead to no stable equilibrium.
    """
    if lengths is None:
        if start is not None:
            raise InputError("start", "", start, "it belongs to `lengths`; leave it out")
        where = read_pose(pose, robot)
        hanging = None if free is None else hanging_pose(robot, where, free)
        where = where if hanging is None else hanging.pose
        cables = held(robot, where).cables if hanging is None else hanging.solution.cables
        point = OperatingPoint(robot, where.position, where.rotation, cables)
        require_lumps_on_cables(robot, cables)
        _require_shape(point, True)
        return AtRest(point, hanging=hanging)
    if free is not None:
        raise InputError("free", "", free, "it belongs to `pose`; at locked lengths every angle is found")
    if pose is not None:
        raise InputError("lengths", "", lengths, "give either `pose` or `lengths`, not both")
    return _locked(robot, lengths, start)


def held(robot: Robot, where: Pose, model: str = "sagging") -> InverseSolution:
    """Tensions and lengths that hold a pose; a refusal that another lower bound would cure names the bound.

    Raises
    ------
    CdprError : the pose cannot be held, or the search for tensions was cut short.
    """
    if robot.shared_winches:
        return held_on_shared_winches(robot, where, model)
    try:
        return inverse(robot, where.position, where.rotation, model)
    except (UnholdablePoseError, ConvergenceError) as error:
        hint = bound_hint(robot, where.position, where.rotation)
        if not hint:
            raise
        if isinstance(error, UnholdablePoseError):
            raise UnholdablePoseError(str(error) + hint, error.cable, error.amount) from error
        raise CdprError(str(error) + hint) from error


def _locked(robot: Robot, lengths: Numbers, start: PoseLike | None) -> AtRest:
    begin = None if start is None else read_pose(start, robot, "start")
    found = locked_rest(robot, read_lengths(lengths, robot), begin)
    solution = found.solution
    if not bool(solution.stable):
        raise CdprError(
            f"at these lengths the platform has no stable equilibrium here (least {solution.least_stiffness:.3g} N/m); "
            f"stable ones elsewhere: {found.others.count}"
        )
    point = OperatingPoint(robot, solution.position, solution.rotation, solution.cables)
    require_lumps_on_cables(robot, solution.cables)
    _require_shape(point, False)
    return AtRest(point, found)


def _require_shape(point: OperatingPoint, advised: bool) -> None:
    """Refuse cables that hang slack without gravity.

    advised : whether a lower bound may be named that would cure it
    """
    if not (point.arrays.is_weightless and point.cables.slack.any()):
        return
    numbers = (np.flatnonzero(point.cables.slack) + 1).tolist()
    loose = f"{cables_named(numbers)} {'does' if len(numbers) == 1 else 'do'} not pull"
    hint = bound_hint(point.entered, point.position, point.rotation) if advised else ""
    raise CdprError(f"without gravity a slack cable has no shape to vibrate about, and {loose}.{hint}")


def pose_in_degrees(point: OperatingPoint) -> list[float]:
    """[x, y, z, rx, ry, rz] of an operating point, m and deg."""
    return [*point.position.tolist(), *np.degrees(angles_from_rotation(point.rotation)).tolist()]

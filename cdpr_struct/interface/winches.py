"""Winches: what is said of robots whose winches hold tensions, or wind several cables each."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cdpr_struct.errors import InputError, UnholdablePoseError
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.free_orientation import left_free
from cdpr_struct.statics.hanging_solution import hung_solution
from cdpr_struct.statics.inverse_kinematics import InverseSolution
from cdpr_struct.statics.shared_winches import WoundRest, wound_rest

SAME_WINDING = 2e-5  # [m], by which lengths of cables on one winch may differ from equal changes: they are rounded
_SAME_TURN = 1e-7  # [rad], between the orientation that is asked for and that at which the platform rests
_WITHIN = 1e-7  # of the largest tension


def require_locked_lengths(robot: Robot, why: str) -> None:
    """Refuse a robot with a winch that holds the tension of its cable.

    why : what locked lengths are needed for, and what to do instead

    Raises
    ------
    InputError : there is one; the complaint names the field.
    """
    if robot.tension_winches:
        first = robot.tension_winches[0]
        value = robot.cables[first - 1].winch_tension
        raise InputError(robot.name, f"cables[{first}].winch_tension", value, f"leave it out: {why}")


def require_own_winches(robot: Robot, why: str) -> None:
    """Refuse a robot with a winch that winds several cables.

    why : what a winch for each cable is needed for, and what to do instead

    Raises
    ------
    InputError : there is one; the complaint names the field.
    """
    if robot.shared_winches:
        name = robot.shared_winches[0]
        first = next(i for i, cable in enumerate(robot.cables, start=1) if cable.winch == name)
        raise InputError(robot.name, f"cables[{first}].winch", name, f"leave it out: {why}")


def require_given_free(robot: Robot, free: object, what: str) -> None:
    """Refuse many poses of whole orientation on winches that are shared.

    Raises
    ------
    InputError : there are such winches, and no angle is left free.
    """
    if robot.shared_winches and free is None:
        right = f"rx,ry,rz or some of them: on winches that wind several cables, {what} leaves angles free"
        raise InputError("free", "", "nothing", right)


def winches_json(robot: Robot, cables: CableStates) -> dict[str, Any]:
    """The key `winches` of a robot at rest some of whose winches wind several cables."""
    if not robot.shared_winches:
        return {}
    winches = robot.winches
    said = winches.said(RobotArrays.of(robot).reading(cables.total_length))
    change = [float(now - home) if home else None for now, home in zip(said, winches.home, strict=True)]
    each = zip(winches.names, winches.cables, said.tolist(), change, strict=True)
    keys = ("name", "cables", "length_m", "paid_out_since_home_m")
    return {"winches": [dict(zip(keys, (n, list(c), *rest), strict=True)) for n, c, *rest in each]}


def lengths_of(robot: Robot, given: Sequence[float]) -> list[float]:
    """Unstrained lengths, one a cable, from as many, or from what the winches say [m].

    Raises
    ------
    InputError : lengths that the winches cannot have wound.
    """
    winches, values = robot.winches, np.asarray(given, dtype=float)
    if len(values) == winches.count and not robot.tension_winches:
        lengths = winches.lengths(values)
        if (short := int(lengths.argmin())) >= 0 and not lengths[short] > 0.0:
            right = f"lengths that leave every cable some: cable {short + 1} would have {lengths[short]:.4g} m"
            raise InputError("lengths", "", values.tolist(), right)
        return list(lengths.tolist())
    apart = winches.apart(values)
    worst = int(np.abs(apart).argmax())
    if abs(apart[worst]) > SAME_WINDING:
        name = robot.cables[worst].winch
        own = np.flatnonzero([cable.winch == name for cable in robot.cables])
        pair = sorted((own[apart[own].argmin()], own[apart[own].argmax()]))
        right = (
            f"on winch {name} cables change by equal lengths since home (or by their winch_ratio), but those of cables "
            f"{pair[0] + 1} and {pair[1] + 1} differ by {1e3 * np.ptp(apart[own]):.3g} mm; or give what "
            f"{winches.count} winches say"
        )
        raise InputError("lengths", "", float(values[worst]), right)
    return list(np.where(winches.share.any(axis=1), winches.lengths(winches.said(values)), values).tolist())


def wound(robot: Robot, where: Pose, free: np.ndarray, model: str) -> WoundRest:
    """The platform at rest at a position on winches that are shared, a batch of one.

    free : (3,) bool, which of its angles follow from balance

    Raises
    ------
    InputError : inextensible cables.
    UnholdablePoseError : it does not rest there, or not with tensions within their limits.
    """
    if model == "ideal":
        right = "sagging or spring: how inextensible cables share the load on one winch follows from no balance"
        raise InputError("model", "", model, right)
    found = wound_rest(robot, where.position[None], where.angles, free, model)
    if not found.hung.found[0]:
        raise _unreached(robot, found)
    return found


def _unreached(robot: Robot, found: WoundRest) -> UnholdablePoseError:
    """Why a platform does not rest where its winches are to bring it."""
    pull = found.hung.cables.tension_at_platform[0]
    low, high = robot.force_min - pull, pull - robot.force_max
    worst = int(np.maximum(low, high).argmax())
    amount = float(max(low[worst], high[worst]))
    if found.miss[0] <= 1e-6 and amount > _WITHIN * pull.max():
        limit = "below its force_min of" if low[worst] > high[worst] else "above its force_max of"
        bound = robot.force_min[worst] if low[worst] > high[worst] else robot.force_max[worst]
        return UnholdablePoseError(
            f"cable {worst + 1}: as cables share winches it has {pull[worst]:.4g} N there, {limit} {bound:.4g} N. "
            "Move the pose, change the limits, or leave more angles free.",
            worst + 1,
            amount,
        )
    if found.miss[0] <= 1e-6:
        return UnholdablePoseError(
            f"{robot.name}: the platform can be brought there, but the search for the lengths with tensions of least "
            "norm has not settled. Ask for some of the free angles, too, or move the pose."
        )
    return UnholdablePoseError(
        f"{robot.name}: no lengths of its winches are found at which the platform rests there: "
        f"{found.miss[0]:.2g} m are left. Move the pose, or begin at another orientation."
    )


def held_on_shared_winches(robot: Robot, where: Pose, model: str) -> InverseSolution:
    """Tensions and lengths that hold a whole pose on winches that are shared.

    Raises
    ------
    UnholdablePoseError : the platform does not rest there, or turned otherwise; the message says how.
    """
    guided = robot.held_freedoms
    try:
        free = left_free((False,) * 3, robot.winches.count, guided, ("winch", "winches"))
    except ValueError as error:
        raise UnholdablePoseError(str(error)) from error
    found = wound(robot, where, free, model)
    apart = 0.5 * np.linalg.norm(found.hung.rotation[0] - where.rotation) * np.sqrt(2.0)
    if apart > _SAME_TURN:
        rx, ry, rz = np.degrees(found.hung.angles[0])
        raise UnholdablePoseError(
            f"{robot.winches.count} winches do not set the whole orientation: at this position the platform rests "
            f"turned by ({rx:.6f}, {ry:.6f}, {rz:.6f})° about x, y, z. Ask for these angles, or leave them free "
            "(--free rx,ry,rz)."
        )
    return hung_solution(robot, found.hung).at(0)

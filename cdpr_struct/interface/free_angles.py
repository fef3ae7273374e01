"""Which angles of the platform are left free, and where does it hang?"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from cdpr_struct.errors import InputError, UnholdablePoseError
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import FREEDOMS, Robot
from cdpr_struct.statics.free_orientation import ANGLES, free_orientation, left_free, turn_with_guide
from cdpr_struct.statics.inverse_kinematics import InverseSolution, hung_solution

FreeAngles: TypeAlias = str | Iterable[str]
"""Names of angles, or their text with commas between them: rx, ry, rz."""
_EXPECTED = "give some of rx,ry,rz"
_DECIMALS = 6  # of angles in sentences [deg]: smaller ones are rounding


@dataclass(frozen=True, slots=True, eq=False)
class HangingPose:
    """A pose at which the platform hangs freely.

    free : (3,) bool, of rx, ry, rz;  added : names of angles that were not asked for, but are free, too
    solution : the tensions there
    """

    pose: Pose
    solution: InverseSolution
    free: np.ndarray
    added: tuple[str, ...]

    def json(self) -> dict[str, Any]:
        """The key `free` of results."""
        angles = np.degrees(self.pose.angles).tolist()
        return {"free": {"angles": names_of(self.free), "added": list(self.added), "orientation_deg": angles}}

    def sentence(self) -> str:
        """What is said of it."""
        rx, ry, rz = np.degrees(self.pose.angles).round(_DECIMALS) + 0.0
        many = f"; {', '.join(self.added)} because so few cables cannot hold more" if self.added else ""
        hangs = f"the platform hangs at ({rx:.4g}, {ry:.4g}, {rz:.4g})° about x, y, z."
        return f"{_were_left_free(self.free)}{many}: {hangs}"


def names_of(free: Sequence[bool] | np.ndarray) -> list[str]:
    """Names of the free angles, (3,) bool."""
    return [name for name, chosen in zip(ANGLES, free, strict=True) if chosen]


def _were_left_free(free: Sequence[bool] | np.ndarray) -> str:
    names = names_of(free)
    return f"{', '.join(names)} {'was' if len(names) == 1 else 'were'} left free"


def told_in_map(told: Mapping[str, Any], free: Sequence[bool], more: str = "") -> dict[str, Any]:
    """The result of a map with its free angles, (3,) bool, and a warning that says where those found stand."""
    said = f"{_were_left_free(free)}: rx_deg, ry_deg and rz_deg of map.csv are the angles found."
    return {**told, "free": {"angles": names_of(free)}, "warnings": [said + more, *told["warnings"]]}


def read_free(given: FreeAngles, robot: Robot, angles: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """(3,) bool: which of rx, ry, rz are free on the cables of a robot, and the names of those not asked for.

    angles : (3,) rx, ry, rz where the search begins [rad]

    Raises
    ------
    InputError : other names, angles that a guide holds, too few cables, or a winch that holds the tension of its cable.
    """
    require_locked_lengths(robot, "free angles are found for cables of locked lengths")
    names = [part.strip() for part in given.split(",")] if isinstance(given, str) else list(given)
    if not names or any(name not in ANGLES for name in names):
        raise InputError("free", "", given if isinstance(given, str) else names, _EXPECTED)
    asked = np.array([name in names for name in ANGLES])
    if held := [name for name in names if name in robot.guided]:
        what = "it" if len(held) == 1 else "them"
        raise InputError("free", "", given, f"leave out {', '.join(held)}: a guide of {robot.name} holds {what}")
    guided = np.array([name in robot.guided for name in FREEDOMS])
    try:
        free = left_free(asked, len(robot.cables), guided)
    except ValueError as error:
        raise InputError("free", "", given, str(error)) from error
    if not turn_with_guide(free, angles, guided):
        right = "beside guided rotations only the last one can be free, with the other angles zero; or give lengths"
        raise InputError("free", "", given, right)
    return free, tuple(names_of(free & ~asked))


def hanging_pose(robot: Robot, where: Pose, given: FreeAngles, model: str = "sagging") -> HangingPose:
    """The pose at the same position at which the platform hangs freely.

    Raises
    ------
    InputError : unusable names, or a winch that holds the tension of its cable.
    UnholdablePoseError : no such orientation is found from that of the pose.
    """
    free, added = read_free(given, robot, where.angles)
    found = free_orientation(robot, where.position[None], where.angles, free, model=model)
    if not found.found[0]:
        kept = [name for name in names_of(~free) if name not in robot.guided]
        hint = f"Free {', '.join(kept)} as well" if kept else "Move the pose"
        names, most = ", ".join(names_of(free)), float(np.abs(found.moment).max())
        left = f"{most:.2g} of arms times tensions is left as moment about them"
        if most < 1e-9:
            left = "no tensions within their limits balance the rest there"
        raise UnholdablePoseError(
            f"no orientation is found at which the platform hangs freely about {names}: {left}. "
            f"{hint}, or begin at another orientation."
        )
    return HangingPose(Pose(where.position, found.angles[0]), hung_solution(robot, found).at(0), free, added)

"""Which angles of the platform are left free, and where does it hang?"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from cdpr_struct.errors import InputError, UnholdablePoseError
from cdpr_struct.interface.arguments import one_of
from cdpr_struct.interface.winches import require_locked_lengths, require_own_winches, wound
from cdpr_struct.robot.pose import Pose, angle_between, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import PlatformArms
from cdpr_struct.statics.even_orientation import even_orientation
from cdpr_struct.statics.free_orientation import ANGLES, free_orientation, left_free, names_of, turn_with_guide
from cdpr_struct.statics.hanging_solution import hung_solution
from cdpr_struct.statics.inverse_kinematics import InverseSolution
from cdpr_struct.statics.unholdable_poses import behind_wheels, half_turn_error
from cdpr_struct.workspace.margins import largest_tilt

FreeAngles: TypeAlias = str | Iterable[str]
"""Names of angles, or their text with commas between them: rx, ry, rz."""
HANGING, EVEN = ORIENTS = ("hanging", "even")
_EXPECTED = "give some of rx,ry,rz"
_FAR = np.radians(30.0)  # so far from where its search began an orientation is not what one expects
_DECIMALS = 6  # of angles in sentences [deg]: smaller ones are rounding


@dataclass(frozen=True, slots=True, eq=False)
class HangingPose:
    """A pose at which the platform hangs freely.

    free : (3,) bool, of rx, ry, rz;  added : names of angles that were not asked for, but are free, too
    solution : the tensions there;  spread : of the tensions [-] if the angles are those of the most even ones, or None
    held_by : what holds the platform, in words
    turned : from where the search began [rad]
    """

    pose: Pose
    solution: InverseSolution
    free: np.ndarray
    added: tuple[str, ...]
    spread: float | None = None
    held_by: str = "cables"
    turned: float = 0.0

    def json(self) -> dict[str, Any]:
        """The key `free` of results."""
        angles = np.degrees(self.pose.angles).tolist()
        told = {"angles": names_of(self.free), "added": list(self.added), "orientation_deg": angles}
        told["turned_deg"] = float(np.degrees(self.turned))
        return {"free": told if self.spread is None else {**told, "orient": EVEN, "tension_spread": self.spread}}

    def sentence(self) -> str:
        """What is said of it."""
        rx, ry, rz = np.degrees(self.pose.angles).round(_DECIMALS) + 0.0
        if self.spread is not None:
            where = f"({rx:.4g}, {ry:.4g}, {rz:.4g})°"
            most = f"most even at {where}: their standard deviation is {self.spread:.3g} of their mean"
            return (
                f"{', '.join(names_of(self.free))} were chosen: the tensions are {most} (the nearest such orientation)."
            )
        many = f"; {', '.join(self.added)} because so few {self.held_by} cannot hold more" if self.added else ""
        hangs = f"the platform hangs at ({rx:.4g}, {ry:.4g}, {rz:.4g})° about x, y, z."
        if self.turned > _FAR:
            hangs += f" That is {np.degrees(self.turned):.0f}° from the angles given, near which none was found."
        return f"{_were_left_free(self.free)}{many}: {hangs}"


def found_angles(columns: Mapping[str, Any]) -> np.ndarray:
    """(k, 3) columns `rx_deg`, `ry_deg`, `rz_deg` of a map."""
    return np.stack([columns[f"{name}_deg"] for name in ANGLES], axis=-1)


def _were_left_free(free: Sequence[bool] | np.ndarray) -> str:
    names = names_of(free)
    return f"{', '.join(names)} {'was' if len(names) == 1 else 'were'} left free"


def where_judged(quantity: str) -> str:
    """What a map of a quantity says of its free angles."""
    if quantity.startswith("pose-error"):
        return " The references hang on straight, inextensible cables, from which the lengths are computed."
    return " Stability is judged there, at locked lengths."


def told_in_map(
    told: Mapping[str, Any],
    robot: Robot,
    free: Sequence[bool],
    degrees: np.ndarray,
    more: str = "",
    table: str = "map.csv",
) -> dict[str, Any]:
    """The result of a map with its free angles, (3,) bool, and a sentence on them.

    degrees : (k, 3) rx, ry, rz found, nan where none are;  table : which file has them
    """
    said = f"{_were_left_free(free)}: rx_deg, ry_deg and rz_deg of {table} are the angles found"
    tilt = largest_tilt(robot, degrees)
    said += "." if tilt is None else f", tilt up to {tilt:.1f}°."
    answer = {"angles": names_of(free), "largest_tilt_deg": tilt}
    return {**told, "free": answer, "warnings": [said + more, *told.get("warnings", ())]}


def told_on_way(told: Mapping[str, Any], free: Sequence[bool], rotation: np.ndarray, left_out: float) -> dict[str, Any]:
    """The result along a trajectory with its free angles, (3,) bool, and a warning that says how far they reach.

    rotation : (k, 3, 3) found along it;  left_out : largest moment of the inertia of turning [N m]
    """
    names = names_of(free)
    degrees = np.degrees(np.unwrap(angles_from_rotation(rotation), axis=0)) + 0.0
    reach = {name: [float(a.min()), float(a.max())] for name, a in zip(ANGLES, degrees.T, strict=True) if name in names}
    ranges = ", ".join(f"{name} from {low:.3g} to {high:.3g}°" for name, (low, high) in reach.items())
    said = f"{_were_left_free(free)}: the platform hangs along the apparent gravity, {ranges}."
    said += f" The inertia of its turning, at most {left_out:.2g} N m, is left out."
    return {
        **told,
        "free": {"angles": names, "range_deg": reach, "left_out_Nm": left_out},
        "warnings": [said, *told.get("warnings", ())],
    }


def read_free(given: FreeAngles, robot: Robot, angles: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """(3,) bool: which of rx, ry, rz are free on the cables of a robot, and the names of those not asked for.

    angles : (..., 3) rx, ry, rz where the search begins [rad]

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
    guided = robot.held_freedoms
    try:
        free = left_free(asked, *_holding(robot, guided))
    except ValueError as error:
        raise InputError("free", "", given, str(error)) from error
    if not turn_with_guide(free, angles, guided):
        right = "beside guided rotations only the last one can be free, with the other angles zero; or give lengths"
        raise InputError("free", "", given, right)
    return free, tuple(names_of(free & ~asked))


def _holding(robot: Robot, guided: np.ndarray) -> tuple[int, np.ndarray, tuple[str, str]]:
    """How many hold the platform, beside a guide (6,), and what they are called."""
    if robot.shared_winches:
        return robot.winches.count, guided, ("winch", "winches")
    return len(robot.cables), guided, ("cable", "cables")


def _range(robot: Robot) -> str:
    """The forces that the cables may have, in words."""
    low, high = float(robot.force_min.min()), float(robot.force_max.max())
    return f"from {low:g} to {high:g} N" if np.isfinite(high) else f"above {low:g} N"


def chosen_pose(
    robot: Robot, where: Pose, given: FreeAngles | None, orient: str | None, model: str = "sagging"
) -> HangingPose | None:
    """The pose with its angles chosen as asked: as the platform hangs, or of the most even tensions; None: as given.

    Raises
    ------
    InputError : unusable names.
    UnholdablePoseError : no such orientation is found.
    """
    if orient is not None and one_of(orient, "orient", ORIENTS) == EVEN:
        return even_pose(robot, where, ANGLES if given is None else given, model)
    if given is None:
        if orient is not None:
            raise InputError("orient", "", orient, "it says how the angles of `free` are chosen; give `free`, too")
        return None
    return hanging_pose(robot, where, given, model)


def even_pose(robot: Robot, where: Pose, given: FreeAngles, model: str = "sagging") -> HangingPose:
    """The pose at the same position at which the tensions are most even.

    Raises
    ------
    InputError : unusable names, or fewer than six cables, which turn the platform nowhere.
    UnholdablePoseError : no such orientation is found from that of the pose.
    """
    require_own_winches(robot, "the most even tensions are chosen for a winch of each cable")
    if len(robot.cables) < 6:
        raise InputError("orient", "", EVEN, "it needs six cables or more; with fewer the platform hangs: leave it out")
    free, _ = read_free(given, robot, where.angles)
    found = even_orientation(robot, where.position[None], where.angles, free, model)
    if not found.found[0]:
        raise UnholdablePoseError(
            f"no orientation of most even tensions is found by turning {', '.join(names_of(free))}: the cables hold "
            f"the platform nowhere near, or the search has not settled. Move the pose, or begin at another orientation."
        )
    pose, spread = Pose(where.position, found.angles[0]), float(found.spread[0])
    return HangingPose(pose, found.solution.at(0), free, (), spread, turned=_turned(where, pose))


def hanging_pose(robot: Robot, where: Pose, given: FreeAngles, model: str = "sagging") -> HangingPose:
    """The pose at the same position at which the platform hangs freely.

    Raises
    ------
    InputError : unusable names, or a winch that holds the tension of its cable.
    UnholdablePoseError : no such orientation is found from that of the pose.
    """
    free, added = read_free(given, robot, where.angles)
    if robot.shared_winches:
        hung = wound(robot, where, free, model).hung
        pose = Pose(where.position, hung.angles[0])
        solution, turned = hung_solution(robot, hung).at(0), _turned(where, pose)
        return HangingPose(pose, solution, free, added, held_by="winches", turned=turned)
    _require_no_half_turn(robot, [where, Pose(where.position, np.where(free, 0.0, where.angles))])
    found = free_orientation(robot, where.position[None], where.angles, free, model=model)
    if not found.found[0]:
        kept = [name for name in names_of(~free) if name not in robot.guided]
        hint = f"Free {', '.join(kept)} as well" if kept else "Move the pose"
        names, most = ", ".join(names_of(free)), float(np.abs(found.moment).max())
        left = f"{most:.2g} of arms times tensions is left as moment about them"
        if most < 1e-9:
            left = f"no tensions {_range(robot)} carry the platform at any angle tried"
        raise UnholdablePoseError(
            f"no orientation is found at which the platform hangs freely about {names}: {left}. "
            f"{hint}, or begin at another orientation."
        )
    pose = Pose(where.position, found.angles[0])
    return HangingPose(pose, hung_solution(robot, found).at(0), free, added, turned=_turned(where, pose))


def _turned(start: Pose, end: Pose) -> float:
    """Angle between two orientations [rad]."""
    return float(angle_between(start.rotation, end.rotation))


def _require_no_half_turn(robot: Robot, starts: list[Pose]) -> None:
    """Raise where a cable would turn by more than 180 degrees on its pulley at each of the poses a search begins at."""
    arrays = RobotArrays.of(robot)
    place, turn = (np.array([getattr(one, name) for one in starts]) for name in ("position", "rotation"))
    behind = np.atleast_2d(behind_wheels(arrays, PlatformArms.at(arrays, place, turn).points).all(axis=0))
    if behind.any():
        raise half_turn_error(arrays, behind)

"""What an argument stands for: numbers, poses, grids and robots, given as values or as the text of an option.

A complaint names the argument, others in backticks; the command line shows them as options.
"""

import os
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import doubt

if TYPE_CHECKING:
    from cdpr_struct.interface.given import GridLike, Numbers, PoseLike, RobotLike
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.workspace.grid import Grid

LARGEST, SMALLEST = 1e12, 1e-12  # of single numbers; beyond them squares and products leave what can be computed
_LOOKS_LIKE_MM = 50.0  # times the robot's width
Named = TypeVar("Named", bound=str)


def one_of(value: object, name: str, choices: Iterable[Named]) -> Named:
    """The choice that is named.

    Raises
    ------
    InputError : there is none of this name.
    """
    known = list(choices)
    found = next((choice for choice in known if choice == value), None)
    if found is None:
        given = "nothing" if value is None else value
        listed = " or ".join(known) if len(known) == 2 else f"one of: {', '.join(known)}"
        raise InputError(name, "", given, listed)
    return found


def whole(value: object, name: str, low: int, high: int) -> int:
    """A whole number from `low` to `high`.

    Raises
    ------
    InputError : anything else.
    """
    if isinstance(value, bool) or not isinstance(value, Integral) or not low <= int(value) <= high:
        raise InputError(name, "", value, f"give a number from {low} to {high}")
    return int(value)


def real(value: object, name: str, expected: str, above: float = -LARGEST, below: float = LARGEST) -> float:
    """A number between `above` and `below`, neither included.

    Raises
    ------
    InputError : anything else; `expected` says what would be right.
    """
    if isinstance(value, bool) or not isinstance(value, Real) or not above < float(value) < below:
        raise InputError(name, "", value, expected)
    return float(value)


def read_numbers(
    given: "Numbers", name: str, counts: tuple[int, ...] | None = None, what: str = "numbers"
) -> list[float]:
    """Finite numbers, given as such or as text with commas between them.

    Raises
    ------
    InputError : not numbers, not finite, too large, or not as many as `counts` admits.
    """
    wanted = "" if counts is None else " or ".join(map(str, counts)) + " "
    text = isinstance(given, str)
    expected = f"give {wanted}{'comma-separated ' if text else ''}{what}"
    try:
        values = [float(part) for part in (given.split(",") if isinstance(given, str) else given)]
    except (TypeError, ValueError) as error:
        raise InputError(name, "", _shown(given), expected) from error
    if any(LARGEST < abs(v) < float("inf") for v in values):
        raise InputError(name, "", _shown(given), f"{expected}, none above {LARGEST:g} in size")
    if not all(abs(v) < float("inf") for v in values) or (counts is not None and len(values) not in counts):
        raise InputError(name, "", _shown(given), expected)
    return values


def text_of(given: "Numbers") -> str:
    """Numbers as the text of an option, with all their digits."""
    return given if isinstance(given, str) else ",".join(repr(float(value)) for value in given)


def _shown(given: object) -> object:
    """A value as complaints show it: arrays as lists."""
    return given.tolist() if hasattr(given, "tolist") else given


def read_robot(
    robot: "RobotLike",
    payload: float = 0.0,
    mass: float | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    wrench: "Numbers | None" = None,
    temperature: float | None = None,
    lumps: bool = False,
    winches: bool = False,
) -> "Robot":
    """The robot with its load and temperature, its force limits replaced where arguments give others.

    Parameters
    ----------
    robot : a `Robot`, a built-in name, or the path of a robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    lower_bound, upper_bound : of the cable forces at the platform [N]; None keeps each cable's own
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; None keeps the robot's own
    lumps, winches : whether the command knows masses on cables, and winches that wind several cables each

    What can hardly be meant in it is said behind an error; every result says it by `with_extensions`.

    Raises
    ------
    InputError : no such robot, a number out of range, or masses on cables or shared winches that the command does not
        know.
    CdprError : cables on one winch without home lengths, and no home pose that says them.
    """
    from cdpr_struct.interface.lumps import require_no_lumps
    from cdpr_struct.interface.winches import require_own_winches
    from cdpr_struct.robot.plausibility import implausible
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.robot.robot_file import load_robot
    from cdpr_struct.statics.home_lengths import with_home_lengths

    if isinstance(payload, bool) or not isinstance(payload, Real) or not 0.0 <= payload < float("inf"):
        raise InputError("payload", "", payload, "give a mass in kg, zero or more")
    if mass is not None:
        real(mass, "mass", "give a mass in kg above zero", 0.0, float("inf"))
    read_bounds(lower_bound, upper_bound)
    if not isinstance(robot, Robot | str | os.PathLike):
        raise InputError("robot", "", robot, "a Robot, a built-in name, or the path of a robot file")
    entered = robot if isinstance(robot, Robot) else load_robot(os.fspath(robot))
    if not lumps:
        require_no_lumps(entered, "this command knows no masses on cables; inverse, forward, modes, frf do")
    if not winches:
        require_own_winches(
            entered, "this command knows a winch for each cable; inverse, forward, modes, verify, frf do"
        )
    entered = with_home_lengths(entered)
    doubt(implausible(entered))
    try:
        loaded = entered.with_load(payload, mass)
    except ValueError as error:
        raise InputError("mass", "", mass, str(error)) from error
    try:
        limited = loaded.with_force_limits(lower_bound, upper_bound)
    except ValueError as error:
        crossed = ("upper_bound", upper_bound) if upper_bound is not None else ("lower_bound", lower_bound)
        raise InputError(crossed[0], "", crossed[1], str(error)) from error
    return _conditioned(limited, wrench, temperature)


def _conditioned(robot: "Robot", wrench: "Numbers | None", temperature: float | None) -> "Robot":
    """The robot under a further wrench, and at another temperature."""
    if wrench is not None:
        robot = robot.with_wrench(read_numbers(wrench, "wrench", (6,), "numbers in N and N m"))
    if temperature is None:
        return robot
    from cdpr_struct.robot.parameters import EXTENSIONS

    key = EXTENSIONS["temperature_change"]
    expected = f"give a difference in K from {key.least:g} to {key.most:g}"
    change = real(temperature, "temperature", expected)
    if not key.least <= change <= key.most:
        raise InputError("temperature", "", temperature, expected)
    return robot.at_temperature(change)


def read_bounds(lower_bound: float | None, upper_bound: float | None) -> tuple[float | None, float | None]:
    """The bounds of cable force that arguments give, each a force of its own.

    Raises
    ------
    InputError : negative, not finite, or the upper one not above zero.
    """
    if lower_bound is not None and not (isinstance(lower_bound, Real) and 0.0 <= lower_bound < float("inf")):
        raise InputError("lower_bound", "", lower_bound, "give a force in N, zero or more")
    if upper_bound is not None and not (isinstance(upper_bound, Real) and upper_bound > 0.0):
        raise InputError("upper_bound", "", upper_bound, "give a force in N above zero")
    return lower_bound, upper_bound


def read_pose(given: "PoseLike | None", robot: "Robot", name: str = "pose") -> "Pose":
    """The pose that an argument names, x, y, z[, rx, ry, rz] in m and deg, or the robot's home pose.

    Raises
    ------
    InputError : not 3 or 6 numbers, or None and the robot has no home pose.
    """
    from cdpr_struct.robot.pose import Pose

    if isinstance(given, Pose):
        return given
    if given is not None:
        return Pose.from_degrees(read_numbers(given, name, (3, 6), "numbers x,y,z[,rx,ry,rz] in m and deg"))
    if robot.home is None:
        raise InputError(name, "", "nothing", f"robot {robot.name} has no home_pose, so give x,y,z[,rx,ry,rz]")
    return robot.home


def read_lengths(given: "Numbers | None", robot: "Robot") -> list[float]:
    """Unstrained lengths [m], one a cable; or one a winch, where one winds several cables.

    Raises
    ------
    InputError : missing, not one positive number per cable, or in mm.
    """
    count = len(robot.cables)
    each = "winch or cable" if robot.shared_winches else "cable"
    what = f"unstrained lengths in m, one per {each} of {robot.name}"
    if given is None:
        raise InputError("lengths", "", "nothing", f"give {count} {what}")
    counts = (robot.winches.count, count) if robot.shared_winches else (count,)
    values = read_numbers(given, "lengths", counts, what)
    if min(values) <= 0.0:
        raise InputError("lengths", "", _shown(given), "lengths must be above zero")
    _require_metres(values, robot)
    if not robot.shared_winches:
        return values
    from cdpr_struct.interface.winches import lengths_of

    return lengths_of(robot, values)


def _require_metres(values: list[float], robot: "Robot") -> None:
    """Refuse lengths that look like mm: even the shortest is many times the distances between anchors and platform."""
    import numpy as np

    place = np.zeros(3) if robot.home is None else robot.home.position
    size = float(np.linalg.norm(np.ptp(np.vstack([robot.frame_anchors, place]), axis=0)))
    if size > 0.0 and min(values) > _LOOKS_LIKE_MM * size:
        right = f"lengths in m; these look like mm (the robot measures {size:.3g} m)"
        raise InputError("lengths", "", values[0], right)


_GRID_FORM = "give X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ] in m and deg, each of x, y, z a number or a range like -3:3:7"
_MOST_POSES = 4_000_000


def read_grid(given: "GridLike") -> "Grid":
    """The grid of poses that an argument describes.

    Raises
    ------
    InputError : not the form, not ascending, not finite, or too many poses.
    """
    import numpy as np

    from cdpr_struct.workspace.grid import Grid

    if isinstance(given, Grid):
        return given
    if not isinstance(given, str):
        raise InputError("grid", "", "nothing" if given is None else given, _GRID_FORM)
    parts = given.split(",")
    if len(parts) not in (3, 6):
        raise InputError("grid", "", given, _GRID_FORM)
    axes = [_axis(part, given) for part in parts[:3]]
    angles = read_numbers(",".join(parts[3:]), "grid", (3,), "angles rx,ry,rz in deg") if parts[3:] else [0.0] * 3
    if np.prod([float(count) for _, _, count in axes]) > _MOST_POSES:
        raise InputError("grid", "", given, f"at most {_MOST_POSES} poses")
    x, y, z = (np.linspace(*axis) for axis in axes)
    return Grid(x, y, z, np.radians(angles))


def _axis(part: str, text: str) -> tuple[float, float, int]:
    numbers = part.split(":")
    try:
        low, high = float(numbers[0]), float(numbers[1]) if len(numbers) == 3 else float(numbers[0])
        count = int(numbers[2]) if len(numbers) == 3 else 1
    except ValueError as error:
        raise InputError("grid", "", text, _GRID_FORM) from error
    if len(numbers) not in (1, 3) or not (abs(low) <= LARGEST and abs(high) <= LARGEST):
        raise InputError("grid", "", text, _GRID_FORM)
    if len(numbers) == 3 and not (high > low and count >= 2):
        raise InputError("grid", part, part, "a range ascends and has at least 2 values, like -3:3:7")
    return low, high, count


def require_one(given: Mapping[str, object]) -> None:
    """Refuse several of arguments that exclude each other; those not given are None.

    Raises
    ------
    InputError : names the last one, and all of which one is to be given.
    """
    named = [name for name, value in given.items() if value is not None]
    if len(named) > 1:
        last = named[-1]
        raise InputError(last, "", _shown(given[last]), "give only one of " + ", ".join(f"`{name}`" for name in given))


def require_file(path: str | os.PathLike[str]) -> None:
    """Refuse a campaign that is not there before anything slow is loaded.

    Raises
    ------
    InputError : no such file.
    """
    if not isinstance(path, str | os.PathLike):
        raise InputError("campaign", "", path, "a Campaign, or the path of a campaign file")
    from cdpr_struct.measurement.campaign_sources import is_there

    if not is_there(Path(path)):
        raise InputError("campaign", "", os.fspath(path), _why_no_campaign(Path(path)))


def _why_no_campaign(path: Path) -> str:
    """What is wrong with the path of a campaign file, and the campaign files in the folder if it is one."""
    if not os.path.isdir(path):  # noqa: PTH112, the method of Path raises where a name is too long
        return "no such file"
    inside = sorted(str(file) for file in path.glob("*campaign*.toml"))
    return f"a file, not a folder; give {' or '.join(inside) or 'the campaign file in it'}"

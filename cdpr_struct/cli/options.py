"""Options that several commands share, and how their text is read."""

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.workspace.grid import Grid


_LOOKS_LIKE_MM = 50.0  # times the robot's width
LARGEST, SMALLEST = 1e12, 1e-12  # of single numbers; beyond them squares and products leave what can be computed


def number(text: str) -> float:
    """A number of an option; the complaint says what was given."""
    try:
        value = float(text)
    except ValueError as error:
        raise typer.BadParameter(f"got {text!r}; give a number") from error
    if LARGEST < abs(value) < float("inf"):
        raise typer.BadParameter(f"got {text!r}; give a number of at most {LARGEST:g}")
    if 0.0 < abs(value) < SMALLEST:
        raise typer.BadParameter(f"got {text!r}; give zero or a number of at least {SMALLEST:g}")
    return value


def whole_number(text: str) -> int:
    """A whole number of an option."""
    try:
        return int(text)
    except ValueError as error:
        raise typer.BadParameter(f"got {text!r}; give a whole number") from error


def directory(text: str) -> Path:
    """The directory of --out; the complaint comes before any work is done."""
    found = next((p for p in (Path(text), *Path(text).absolute().parents) if p.exists()), Path("/"))
    if not text.strip() or not found.is_dir() or not os.access(found, os.W_OK | os.X_OK):
        raise typer.BadParameter(f"got {text!r}; give a directory that can be written")
    try:
        Path(tempfile.mkdtemp(dir=found)).rmdir()
    except OSError as error:
        raise typer.BadParameter(f"got {text!r}; give a directory that can be written ({error.strerror})") from error
    return Path(text)


def require_file(path: str) -> None:
    """Refuse a campaign that is not there before anything slow is loaded.

    Raises
    ------
    InputError : no such file.
    """
    if not Path(path).is_file():
        raise InputError("CAMPAIGN", "", path, "no such file" if not Path(path).is_dir() else "a file, not a folder")


def require_metres(values: list[float], robot: "Robot", option: str = "--lengths") -> None:
    """Refuse lengths that look like mm.

    Raises
    ------
    InputError : even the shortest is many times as long as the robot is wide.
    """
    import numpy as np

    wide = float(np.linalg.norm(np.ptp(robot.frame_anchors, axis=0)))
    if wide > 0.0 and min(values) > _LOOKS_LIKE_MM * wide:
        raise InputError(option, "", values[0], f"lengths in m; these look like mm (the robot is {wide:.3g} m wide)")


RobotName = Annotated[str, typer.Argument(metavar="ROBOT", help="Built-in name or path to a robot file.")]
PoseText = Annotated[
    str | None,
    typer.Option("--pose", metavar="X,Y,Z[,RX,RY,RZ]", help="Pose [m, deg]; default: the robot's home pose."),
]
Lengths = Annotated[
    str | None, typer.Option("--lengths", metavar="L1,..,Lm", help="Locked unstrained lengths [m], in place of --pose.")
]
Start = Annotated[
    str | None,
    typer.Option(
        "--start",
        metavar="X,Y,Z[,RX,RY,RZ]",
        help="With --lengths: where to look [m, deg]; default: the way continues from the home pose.",
    ),
]
LowerBound = Annotated[
    float | None,
    typer.Option(
        "--lower-bound",
        parser=number,
        metavar="N",
        help="Smallest cable force at the platform [N]; default: force_min of the robot file.",
    ),
]
UpperBound = Annotated[
    float | None,
    typer.Option(
        "--upper-bound", parser=number, metavar="N",
        help="Largest cable force at the platform [N]; default: force_max of the robot file.",
    ),
]  # fmt: skip
AssemblyName = Annotated[str, typer.Option("--assembly", help="consistent, or thesis (eq. 3.8 as printed).")]
Payload = Annotated[
    float, typer.Option("--payload", parser=number, metavar="KG", help="Point load at the platform origin [kg].")
]
Mass = Annotated[
    float | None, typer.Option("--mass", parser=number, metavar="KG", help="Replaces the platform's mass [kg].")
]


def read_numbers(text: str, option: str, counts: tuple[int, ...] | None = None, what: str = "numbers") -> list[float]:
    """Finite numbers of a comma-separated option.

    Raises
    ------
    InputError : not numbers, not finite, or not as many as `counts` admits.
    """
    wanted = "" if counts is None else " or ".join(map(str, counts)) + " "
    expected = f"give {wanted}comma-separated {what}"
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise InputError(option, "", text, expected) from error
    if any(LARGEST < abs(v) < float("inf") for v in values):
        raise InputError(option, "", text, f"{expected}, none above {LARGEST:g} in size")
    if not all(abs(v) < float("inf") for v in values) or (counts is not None and len(values) not in counts):
        raise InputError(option, "", text, expected)
    return values


def read_robot(
    name: str,
    payload: float = 0.0,
    mass: float | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
) -> "Robot":
    """The robot with its load, its force limits replaced where an option gives others.

    Raises
    ------
    InputError : no such robot, or a number out of range.
    """
    from cdpr_struct.robot.robot_file import load_robot

    if not 0.0 <= payload < float("inf"):
        raise InputError("--payload", "", payload, "give a mass in kg, zero or more")
    if mass is not None and not 0.0 < mass < float("inf"):
        raise InputError("--mass", "", mass, "give a mass in kg above zero")
    read_bounds(lower_bound, upper_bound)
    entered = load_robot(name)
    try:
        robot = entered.with_load(payload, mass)
    except ValueError as error:
        raise InputError("--mass", "", mass, str(error)) from error
    try:
        return robot.with_force_limits(lower_bound, upper_bound)
    except ValueError as error:
        crossed = ("--upper-bound", upper_bound) if upper_bound is not None else ("--lower-bound", lower_bound)
        raise InputError(crossed[0], "", crossed[1], str(error)) from error


def read_bounds(lower_bound: float | None, upper_bound: float | None) -> tuple[float | None, float | None]:
    """The bounds of cable force that options give, each a force of its own.

    Raises
    ------
    InputError : negative, not finite, or the upper one not above zero.
    """
    if lower_bound is not None and not 0.0 <= lower_bound < float("inf"):
        raise InputError("--lower-bound", "", lower_bound, "give a force in N, zero or more")
    if upper_bound is not None and not upper_bound > 0.0:
        raise InputError("--upper-bound", "", upper_bound, "give a force in N above zero")
    return lower_bound, upper_bound


def read_pose(text: str | None, robot: "Robot", option: str = "--pose") -> "Pose":
    """The pose that the option names, or the robot's home pose."""
    from cdpr_struct.robot.pose import Pose

    if text is not None:
        return Pose.from_degrees(read_numbers(text, option, (3, 6), "numbers x,y,z[,rx,ry,rz] in m and deg"))
    if robot.home is None:
        raise InputError(option, "", "nothing", f"robot {robot.name} has no home_pose, so give x,y,z[,rx,ry,rz]")
    return robot.home


def read_assembly(text: str) -> "Assembly":
    """The way the platform's stiffness is assembled.

    Raises
    ------
    InputError : neither consistent nor thesis.
    """
    if text == "consistent":
        return "consistent"
    if text == "thesis":
        return "thesis"
    raise InputError("--assembly", "", text, "consistent or thesis")


GridText = Annotated[
    str | None,
    typer.Option("--grid", metavar="X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ]", help="Poses [m, deg]; x, y, z: value or range."),
]  # fmt: skip
_GRID_FORM = "give X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ] in m and deg, each of x, y, z a number or a range like -3:3:7"
_MOST_POSES = 4_000_000


def read_grid(text: str) -> "Grid":
    """The grid of poses that the option describes.

    Raises
    ------
    InputError : not the form, not ascending, not finite, or too many poses.
    """
    import numpy as np

    from cdpr_struct.workspace.grid import Grid

    parts = text.split(",")
    if len(parts) not in (3, 6):
        raise InputError("--grid", "", text, _GRID_FORM)
    axes = [_axis(part, text) for part in parts[:3]]
    angles = read_numbers(",".join(parts[3:]), "--grid", (3,), "angles rx,ry,rz in deg") if parts[3:] else [0.0] * 3
    if np.prod([float(count) for _, _, count in axes]) > _MOST_POSES:
        raise InputError("--grid", "", text, f"at most {_MOST_POSES} poses")
    x, y, z = (np.linspace(*axis) for axis in axes)
    return Grid(x, y, z, np.radians(angles))


def _axis(part: str, text: str) -> tuple[float, float, int]:
    numbers = part.split(":")
    try:
        low, high = float(numbers[0]), float(numbers[1]) if len(numbers) == 3 else float(numbers[0])
        count = int(numbers[2]) if len(numbers) == 3 else 1
    except ValueError as error:
        raise InputError("--grid", "", text, _GRID_FORM) from error
    if len(numbers) not in (1, 3) or not (abs(low) <= LARGEST and abs(high) <= LARGEST):
        raise InputError("--grid", "", text, _GRID_FORM)
    if len(numbers) == 3 and not (high > low and count >= 2):
        raise InputError("--grid", part, part, "a range ascends and has at least 2 values, like -3:3:7")
    return low, high, count

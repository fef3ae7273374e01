"""Options that several commands share, and how their text is read."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot


def number(text: str) -> float:
    """A number of an option; the complaint says what was given."""
    try:
        return float(text)
    except ValueError as error:
        raise typer.BadParameter(f"got {text!r}; give a number") from error


def whole_number(text: str) -> int:
    """A whole number of an option."""
    try:
        return int(text)
    except ValueError as error:
        raise typer.BadParameter(f"got {text!r}; give a whole number") from error


RobotName = Annotated[str, typer.Argument(metavar="ROBOT", help="Built-in name or path to a robot file.")]
Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Write result.json, tables, figures and report.html here."),
]
Json = Annotated[bool, typer.Option("--json", help="Print result.json to stdout, nothing else.")]
PoseText = Annotated[
    str | None,
    typer.Option("--pose", metavar="X,Y,Z[,RX,RY,RZ]", help="Pose [m, deg]; default: the robot's home pose."),
]
Lengths = Annotated[
    str | None, typer.Option("--lengths", metavar="L1,..,Lm", help="Locked unstrained lengths [m], in place of --pose.")
]
LowerBound = Annotated[
    float, typer.Option("--lower-bound", parser=number, metavar="N", help="Smallest cable force at the platform [N].")
]
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
    if not all(abs(v) < float("inf") for v in values) or (counts is not None and len(values) not in counts):
        raise InputError(option, "", text, expected)
    return values


def read_robot(name: str, payload: float = 0.0, mass: float | None = None) -> "Robot":
    """The robot with its load."""
    from cdpr_struct.robot.robot_file import load_robot

    if not 0.0 <= payload < float("inf"):
        raise InputError("--payload", "", payload, "give a mass in kg, zero or more")
    if mass is not None and not 0.0 < mass < float("inf"):
        raise InputError("--mass", "", mass, "give a mass in kg above zero")
    return load_robot(name).with_load(payload, mass)


def read_pose(text: str | None, robot: "Robot") -> "Pose":
    """The pose that the option names, or the robot's home pose."""
    from cdpr_struct.robot.pose import Pose

    if text is not None:
        return Pose.from_degrees(read_numbers(text, "--pose", (3, 6), "numbers x,y,z[,rx,ry,rz] in m and deg"))
    if robot.home is None:
        raise InputError("--pose", "", "nothing", f"robot {robot.name} has no home_pose, so give x,y,z[,rx,ry,rz]")
    return robot.home


def read_assembly(text: str) -> "Assembly":
    """The way the platform's stiffness is assembled.

    Raises
    ------
    InputError : neither consistent nor thesis.
    """
    if text == "consistent" or text == "thesis":
        return text
    raise InputError("--assembly", "", text, "consistent or thesis")

"""Options that several commands share; what their text stands for is read by `interface.arguments`."""

import os
import tempfile
from pathlib import Path
from typing import Annotated

import typer

from cdpr_struct.interface.arguments import (
    LARGEST,
    SMALLEST,
    read_bounds,
    read_numbers,
    require_file,
)

__all__ = ["read_bounds", "read_numbers", "require_file"]


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
    try:
        found = next((p for p in (Path(text), *Path(text).absolute().parents) if p.exists()), Path("/"))
    except OSError as error:  # a name that is too long
        raise typer.BadParameter(f"got {text!r}; give a directory that can be written ({error.strerror})") from error
    if not text.strip() or not found.is_dir() or not os.access(found, os.W_OK | os.X_OK):
        raise typer.BadParameter(f"got {text!r}; give a directory that can be written")
    try:
        Path(tempfile.mkdtemp(dir=found)).rmdir()
    except OSError as error:
        raise typer.BadParameter(f"got {text!r}; give a directory that can be written ({error.strerror})") from error
    return Path(text)


def robot_names(incomplete: str) -> list[str]:
    """Built-in robots whose names begin so, for a shell that completes a word; a shell completes paths by itself."""
    from cdpr_struct.robot.robot_file import builtin_names

    return [name for name in builtin_names() if name.startswith(incomplete)]


RobotName = Annotated[
    str,
    typer.Argument(metavar="ROBOT", help="Built-in name or path to a robot file.", autocompletion=robot_names),
]
PoseText = Annotated[
    str | None,
    typer.Option("--pose", metavar="X,Y,Z[,RX,RY,RZ]", help="Pose [m, deg]; default: the robot's home pose."),
]
Lengths = Annotated[
    str | None,
    typer.Option(
        "--lengths",
        metavar="L1,..,Lm",
        help="Locked unstrained lengths [m], one a cable (or a winch, if shared), in place of --pose.",
    ),
]
Start = Annotated[
    str | None,
    typer.Option(
        "--start",
        metavar="X,Y,Z[,RX,RY,RZ]",
        help="With --lengths: pose where the search begins [m, deg]; default: followed from the home pose.",
    ),
]
Free = Annotated[
    str | None,
    typer.Option(
        "--free",
        metavar="rx,ry,rz",
        help="Angles that the platform takes by hanging, some of rx,ry,rz; the search begins at those given.",
    ),
]
Orient = Annotated[
    str | None,
    typer.Option(
        "--orient",
        metavar="hanging|even",
        help="How the angles of --free are chosen: as the platform hangs, or for the most even tensions.",
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
Wrench = Annotated[
    str | None,
    typer.Option(
        "--wrench", metavar="FX,FY,FZ,MX,MY,MZ",
        help="Further constant force and moment on the platform, world axes, about its origin [N, N m].",
    ),
]  # fmt: skip
Temperature = Annotated[
    float | None,
    typer.Option(
        "--temperature", parser=number, metavar="K",
        help="Of the cables, above that at which lengths are entered [K]; default: that of the robot file.",
    ),
]  # fmt: skip


GridText = Annotated[
    str | None,
    typer.Option("--grid", metavar="X0:X1:NX,Y0:Y1:NY,Z[,RX,RY,RZ]", help="Poses [m, deg]; x, y, z: value or range."),
]  # fmt: skip
UniversalFile = Annotated[bool, typer.Option("--uff", help="Write a universal file, too (pyuff and modal software).")]
Band = Annotated[
    float | None,
    typer.Option(
        "--band",
        parser=number,
        metavar="PERCENT",
        help="Band that holds with this probability, like 90: within the tolerances of the robot file.",
    ),
]
Percent = Annotated[
    float | None,
    typer.Option(
        "--percent",
        parser=number,
        metavar="PERCENT",
        help="Band that holds with this probability, like 90: robots drawn within the tolerances of the robot file.",
    ),
]
Samples = Annotated[
    int | None,
    typer.Option(
        "--samples",
        parser=whole_number,
        metavar="N",
        help="With a band: so many robots drawn within the tolerances check it, or make it.",
    ),
]

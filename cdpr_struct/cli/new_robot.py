"""`cdpr-struct new-robot`: a commented robot file to begin with."""

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import number, whole_number
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.written_files import write_new
from cdpr_struct.errors import InputError

NAME = "new-robot"
EXAMPLES = (
    "cdpr-struct new-robot my-robot --cables 8 --size 6,4,3 --mass 25 --out results/my-robot.toml",
    "cdpr-struct new-robot crane --cables 6 --size 12,12,8 --rope dyneema --diameter 5 --out results/crane.toml",
)
_ASKED = {
    "cables": "number of cables (4, or 6 to 16)",
    "size": "width, depth, height of the frame [m]",
    "mass": "mass of the platform [kg]",
    "rope": "rope (steel-6x19, steel-7x19, steel-1x19, dyneema, aramid)",
    "diameter": "diameter of the rope [mm]",
    "pulleys": "radius of the pulleys [m], 0 for none",
}


def run(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the robot.")],
    cables: Annotated[
        int, typer.Option("--cables", parser=whole_number, metavar="N", help="How many: 4, or 6 to 16.")
    ] = 8,
    size: Annotated[
        str, typer.Option("--size", metavar="W,D,H", help="Width, depth, height of the frame [m].")
    ] = "6,4,3",
    mass: Annotated[float, typer.Option("--mass", parser=number, metavar="KG", help="Of the platform [kg].")] = 25.0,
    rope: Annotated[
        str, typer.Option("--rope", metavar="KIND", help="steel-6x19, steel-7x19, steel-1x19, dyneema or aramid.")
    ] = "steel-6x19",
    diameter: Annotated[
        float, typer.Option("--diameter", parser=number, metavar="MM", help="Nominal diameter of the rope [mm].")
    ] = 4.0,
    pulleys: Annotated[
        float,
        typer.Option(
            "--pulleys", parser=number, metavar="R", help="Radius of swivelling pulleys [m]; 0: fixed points."
        ),
    ] = 0.0,
    ask: Annotated[bool, typer.Option("--ask", help="Ask for each of these on the terminal.")] = False,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="ROBOT.toml", help="Robot file to write; default: NAME.toml.")
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace ROBOT.toml if it is there.")] = False,
    *,
    output: Output,
) -> int:
    """Write a commented robot file to begin with, of a robot that every command takes at once."""
    given: dict[str, Any] = {
        "cables": cables, "size": size, "mass": mass, "rope": rope, "diameter": diameter, "pulleys": pulleys
    }  # fmt: skip
    if ask:
        given = _asked(given)
    made = cs.new_robot(name, **given)
    path = out or Path("".join(c if c.isalnum() or c in "-_." else "-" for c in name) + ".toml")
    write_new(path, made.text, overwrite)
    result = {"file": str(path), "robot": made.robot.name, **given, "force_min_N": float(made.robot.force_min.max())}
    output.deliver(result, lambda: _text(path, given, made.robot), dict)
    return 0


def _asked(given: dict[str, Any]) -> dict[str, Any]:
    """The same, each asked for on the terminal; what is given is what an empty line means."""
    if not sys.stdin.isatty():
        raise InputError("--ask", "", "no terminal", "give the options instead: --cables, --size, --mass, --rope, ...")
    return {
        name: typer.prompt(_ASKED[name], default=value, type=type(value), err=True) for name, value in given.items()
    }


def _text(path: Path, given: dict[str, Any], robot: "cs.Robot") -> str:
    size = str(given["size"])
    pulleys = f"pulleys of {given['pulleys']:g} m" if given["pulleys"] else "no pulleys"
    return (
        f"{path}: {given['cables']} cables of {given['rope']}, {given['diameter']:g} mm, frame {size} m, "
        f"platform {given['mass']:g} kg, {pulleys}.\n"
        "Estimated, for you to replace: platform size and inertia, EA and mass of the rope, damping, force limits.\n"
        f"Next: cdpr-struct modes {path} --count 12\n"
        f"      cdpr-struct map {path} {_grid(robot, size)} --quantity first-frequency{_hanging(robot)}"
    )


def _grid(robot: "cs.Robot", size: str) -> str:
    """A grid over the middle of the frame at the height of the home pose."""
    x, y = (0.15 * float(side) for side in size.split(",")[:2])
    z = 0.0 if robot.home is None else float(robot.home.position[2])
    return f"--grid=-{x:.3g}:{x:.3g}:7,-{y:.3g}:{y:.3g}:5,{z:.3g}"


def _hanging(robot: "cs.Robot") -> str:
    """Option without which a robot on six or seven hanging cables can be held at few poses, and why."""
    count = len(robot.cables)
    if count not in (6, 7):
        return ""
    return f" --free rx,ry,rz\n{count} hanging cables hold the platform level at few poses; --free lets it hang tilted."

"""`cdpr-struct import-caspr`: a robot file from a CASPR model."""

from pathlib import Path
from typing import Annotated

import typer

from cdpr_struct.cli.options import number, read_numbers
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.written_files import write_new
from cdpr_struct.errors import InputError

NAME = "import-caspr"
EXAMPLES = (
    "cdpr-struct import-caspr examples/caspr/bodies.xml examples/caspr/cables.xml --out lift.toml --rho 0.05",
    "cdpr-struct import-caspr examples/caspr/bodies.xml examples/caspr/cables.xml --out lift.toml --EA 4e5 --overwrite",
)


def run(
    bodies: Annotated[Path, typer.Argument(metavar="BODIES.xml", help="CASPR body model.")],
    cables: Annotated[Path, typer.Argument(metavar="CABLES.xml", help="CASPR cable model.")],
    out: Annotated[Path | None, typer.Option("--out", metavar="ROBOT.toml", help="Robot file to write.")] = None,
    axial_stiffness: Annotated[
        float | None, typer.Option("--EA", parser=number, metavar="EA", help="Axial stiffness of every cable [N].")
    ] = None,
    density: Annotated[
        float | None, typer.Option("--rho", parser=number, metavar="RHO", help="Linear density of every cable [kg/m].")
    ] = None,
    cable_set: Annotated[
        str | None, typer.Option("--cable-set", metavar="ID", help="Which cable set; default: the file's default.")
    ] = None,
    inertia: Annotated[
        str | None,
        typer.Option(
            "--inertia", metavar="IXX,IYY,IZZ,IXY,IXZ,IYZ",
            help="About the centre of mass, as entries of the matrix [kg m^2], in place of the file's.",
        ),
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace ROBOT.toml if it is there.")] = False,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Write a robot file from a CASPR body and cable model, and say what the model leaves open."""
    if out is None:
        raise InputError("--out", "", "nothing", "give the name of the robot file to write, like robot.toml")
    for option, value in (("--EA", axial_stiffness), ("--rho", density)):
        if value is not None and not 0.0 < value < float("inf"):
            raise InputError(option, "", value, "give a finite number above zero")
    entries = None if inertia is None else read_numbers(inertia, "--inertia", (6,), "numbers in kg m^2")
    from cdpr_struct.robot.caspr_import import Choices, import_caspr

    choices = Choices(axial_stiffness, density, cable_set, entries)
    found = import_caspr(
        read_text(bodies, "BODIES.xml"), read_text(cables, "CABLES.xml"), str(bodies), str(cables), choices
    )
    result = {"file": str(out), "robot": found.name, "cables": found.cables, "warnings": list(found.warnings)}
    write_new(out, found.text, overwrite)
    head = f"{out}: {found.name}, {found.cables} cables"
    output.deliver(result, lambda: head, dict)
    return 0


def read_text(path: Path, argument: str) -> str:
    """Text of a file.

    Raises
    ------
    InputError : it cannot be read.
    """
    try:
        return path.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(argument, "", str(path), "a CASPR XML file that can be read") from error

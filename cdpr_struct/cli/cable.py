"""`cdpr-struct cable`: everything about one cable under one end force."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import number
from cdpr_struct.cli.output import Output

NAME = "cable"
EXAMPLES = (
    "cdpr-struct cable --force 100,-100 --length 20 --EA 251327.4 --rho 0.067",
    "cdpr-struct cable --force 40,-10 --length 8 --EA 1e5 --rho 0.05 --json",
)


def run(
    force: Annotated[str, typer.Option("--force", metavar="FX,FZ", help="Force at the free end [N], z up.")],
    length: Annotated[float, typer.Option("--length", parser=number, metavar="L", help="Unstrained length [m].")],
    axial_stiffness: Annotated[float, typer.Option("--EA", parser=number, metavar="EA", help="Axial stiffness [N].")],
    density: Annotated[float, typer.Option("--rho", parser=number, metavar="RHO", help="Linear density [kg/m].")],
    gravity: Annotated[float, typer.Option("--gravity", parser=number, metavar="G", help="[m/s^2]")] = 9.81,
    fem: Annotated[bool, typer.Option("--fem", help="The referee's frequencies, too.")] = False,
    *,
    output: Output,
) -> int:
    """One cable: end point, sag, elongation, stiffness, validity of the DSM, natural frequencies."""
    found = cs.cable(force=force, length=length, EA=axial_stiffness, rho=density, gravity=gravity, fem=fem)
    output.give(found)
    return 0

"""`cdpr-struct cable`: everything about one cable under one end force."""

from typing import Annotated

import typer

from cdpr_struct.cli.options import SMALLEST, number, read_numbers
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.errors import InputError

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
    force_x, force_z = read_numbers(force, "--force", (2,), "numbers FX,FZ in N")
    for option, value in (("--length", length), ("--EA", axial_stiffness), ("--rho", density), ("--gravity", gravity)):
        if not 0.0 < value < float("inf"):
            raise InputError(option, "", value, "give a finite number above zero")
    if abs(force_x) < SMALLEST:
        raise InputError(
            "--force", "FX", force_x, "give a horizontal force that is not zero (a vertical cable has no plane)"
        )
    from cdpr_struct.crosscheck.single_cable import describe_cable

    result = describe_cable(force_x, force_z, length, axial_stiffness, density, gravity, fem)
    from cdpr_struct.reports.text import cable_text

    def files() -> Files:
        from cdpr_struct.reports.cable_page import cable_files

        return cable_files(result)

    output.deliver(result, lambda: cable_text(result), files)
    return 0

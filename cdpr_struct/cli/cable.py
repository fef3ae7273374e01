"""`cdpr-struct cable`: everything about one cable under one end force."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from cdpr_struct.cli.options import SMALLEST, Json, Out, number, read_numbers
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.errors import InputError

NAME = "cable"


def run(
    force: Annotated[str, typer.Option("--force", metavar="FX,FZ", help="Force at the free end [N], z up.")],
    length: Annotated[float, typer.Option("--length", parser=number, metavar="L", help="Unstrained length [m].")],
    axial_stiffness: Annotated[float, typer.Option("--EA", parser=number, metavar="EA", help="Axial stiffness [N].")],
    density: Annotated[float, typer.Option("--rho", parser=number, metavar="RHO", help="Linear density [kg/m].")],
    gravity: Annotated[float, typer.Option("--gravity", parser=number, metavar="G", help="[m/s^2]")] = 9.81,
    out: Out = None,
    json: Json = False,
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

    result = describe_cable(force_x, force_z, length, axial_stiffness, density, gravity)
    emit(result, json, lambda: _print(result))
    if out is not None:
        from cdpr_struct.reports.cable_page import cable_files

        write_files(out, {"result.json": result_json(result), **cable_files(result)})
    return 0


def _print(result: Mapping[str, Any]) -> None:
    from cdpr_struct.reports.text import cable_text

    print(cable_text(result))

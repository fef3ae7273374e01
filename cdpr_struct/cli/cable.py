"""`cdpr-struct cable`: everything about one cable under one end force."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import Band, Samples, number
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
    band: Band = None,
    samples: Samples = None,
    tolerances: Annotated[
        str | None,
        typer.Option(
            "--tolerances", metavar="NAME=VALUE,..",
            help="With --band, one sigma each: length_m, anchor_m, axial_stiffness, linear_density, load_cell_gain, "
            "load_cell_bias_N; default: those of a robot file without [tolerances].",
        ),
    ] = None,
    held: Annotated[
        str | None,
        typer.Option(
            "--held", metavar="force|ends",
            help="With --band, what stays as entered: the force (default), or both ends; the force then follows.",
        ),
    ] = None,
    *,
    output: Output,
) -> int:  # fmt: skip
    """One cable: end point, sag, elongation, stiffness, validity of the DSM, natural frequencies."""
    found = cs.cable(
        force=force, length=length, EA=axial_stiffness, rho=density, gravity=gravity, fem=fem,
        band=band, samples=samples, tolerances=tolerances, held=held,
    )  # fmt: skip
    output.give(found)
    return 0

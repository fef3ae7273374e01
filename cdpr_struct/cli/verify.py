"""`cdpr-struct verify`: the exact model and the closed-form DSM before the finite-element referee."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    AssemblyName,
    Free,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Start,
    Temperature,
    UpperBound,
    Wrench,
    number,
    whole_number,
)
from cdpr_struct.cli.output import Output

NAME = "verify"
EXAMPLES = (
    "cdpr-struct verify thesis-3-1 --modes 12 --elements 8,16,32 --out results/verify",
    "cdpr-struct verify thesis-5 --pose 1,0.5,2 --lower-bound 300 --modes 6 --elements 8,16,32",
)


def run(
    robot: RobotName,
    pose: PoseText = None,
    free: Free = None,
    lengths: Lengths = None,
    start: Start = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    wrench: Wrench = None,
    temperature: Temperature = None,
    model: Annotated[
        str | None, typer.Option("--model", help="exact or dsm: judge this one only. Default: exact first, then dsm.")
    ] = None,
    elements: Annotated[
        str, typer.Option("--elements", help="Element counts per cable to begin with.")
    ] = "10,20,40,80",
    most_elements: Annotated[
        int,
        typer.Option(
            "--most-elements",
            parser=whole_number,
            help="Per cable: the FEM is refined up to this, until it is certain to a tenth of the tolerance.",
        ),
    ] = 1280,
    modes: Annotated[
        int, typer.Option("--modes", parser=whole_number, help="How many eigenfrequencies to compare.")
    ] = 60,
    assembly: AssemblyName = "consistent",
    tolerance: Annotated[
        float | None,
        typer.Option(
            "--tolerance",
            parser=number,
            help="Largest relative deviation from the FEM; default: 1e-4 for exact, 0.01 for dsm.",
        ),
    ] = None,
    *,
    output: Output,
) -> int:
    """Compare eigenfrequencies of the exact model and the DSM with the FEM's; exit 1 if the exact one disagrees."""
    with output.steps(len(elements.split(",")) + 2) as progress:
        found = cs.verify(
            robot, pose, free=free, lengths=lengths, start=start, lower_bound=lower_bound, upper_bound=upper_bound,
            payload=payload, mass=mass,
            wrench=wrench, temperature=temperature,
            elements=elements, modes=modes, assembly=assembly, tolerance=tolerance,
            model=model, most_elements=most_elements,
            progress=progress,
        )  # fmt: skip
    output.give(found)
    return 0 if found.holds else 1

"""`cdpr-struct forward`: the pose that the platform takes at locked cable lengths."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    Band,
    Lengths,
    Mass,
    Payload,
    RobotName,
    Samples,
    Start,
    Temperature,
    Wrench,
)
from cdpr_struct.cli.output import Output

NAME = "forward"
EXAMPLES = (
    "cdpr-struct forward thesis-3-1 --lengths 10.78,10.38,10.78,10.38,10.24,10.64,10.24,10.64",
    "cdpr-struct forward thesis-3-1 --lengths 10.8,10.4,10.8,10.4,10.3,10.7,10.3,10.7 --payload 20 --model spring",
)


def run(
    robot: RobotName,
    lengths: Lengths = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    wrench: Wrench = None,
    temperature: Temperature = None,
    model: Annotated[str, typer.Option("--model", help="sagging, spring or ideal")] = "sagging",
    start: Start = None,
    equilibria: Annotated[
        bool, typer.Option("--equilibria", help="List and draw all stable poses that are found at these lengths.")
    ] = False,
    band: Band = None,
    samples: Samples = None,
    *,
    output: Output,
) -> int:
    """Pose and tensions at fixed unstrained cable lengths."""
    found = cs.forward(
        robot,
        lengths,
        payload=payload,
        mass=mass,
        wrench=wrench,
        temperature=temperature,
        model=model,
        start=start,
        equilibria=equilibria,
        band=band,
        samples=samples,
    )
    output.give(found)
    return 0 if found.stable else 1

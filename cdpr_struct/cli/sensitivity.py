"""`cdpr-struct sensitivity`: what moves frequencies, pose and tensions, and what to change for another frequency."""

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

NAME = "sensitivity"
EXAMPLES = (
    "cdpr-struct sensitivity cogiro --out results/sensitivity",
    "cdpr-struct sensitivity cogiro --raise mode:1 --to 3",
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
    model: Annotated[str, typer.Option("--model", help="static, dsm or exact.")] = "exact",
    assembly: AssemblyName = "consistent",
    count: Annotated[int, typer.Option("--count", parser=whole_number, help="How many eigenfrequencies.")] = 6,
    mode: Annotated[
        int, typer.Option("--mode", parser=whole_number, help="Mode whose largest movers are listed and drawn.")
    ] = 1,
    force: Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")] = False,
    raise_mode: Annotated[
        str | None,
        typer.Option(
            "--raise",
            metavar="mode:N",
            help="Find the changes of the design that bring this mode to the frequency --to.",
        ),
    ] = None,
    to: Annotated[
        float | None, typer.Option("--to", parser=number, metavar="HZ", help="Frequency for --raise [Hz].")
    ] = None,
    *,
    output: Output,
) -> int:
    """What moves frequencies, pose and tensions, by how much, and what to change for another frequency."""
    found = cs.sensitivity(
        robot, pose, free=free, lengths=lengths, start=start, lower_bound=lower_bound, upper_bound=upper_bound,
        payload=payload, mass=mass, wrench=wrench, temperature=temperature,
        model=model, assembly=assembly, count=count, mode=mode, force=force, raise_mode=raise_mode, to=to,
    )  # fmt: skip
    output.give(found)
    return 0

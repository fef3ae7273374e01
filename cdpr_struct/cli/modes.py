"""`cdpr-struct modes`: eigenfrequencies of the whole robot, none missing."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    AssemblyName,
    Band,
    Free,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Samples,
    Start,
    Temperature,
    UniversalFile,
    UpperBound,
    Wrench,
    whole_number,
)
from cdpr_struct.cli.output import Output

NAME = "modes"
EXAMPLES = (
    "cdpr-struct modes thesis-3-1 --count 20 --out results/modes",
    "cdpr-struct modes thesis-5 --pose 1,0.5,2 --lower-bound 150 --count 6 --json",
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
    model: Annotated[str, typer.Option("--model", help="static, dsm, exact or fem.")] = "exact",
    assembly: AssemblyName = "consistent",
    elements: Annotated[int, typer.Option("--elements", parser=whole_number, help="Per cable, for --model fem.")] = 80,
    count: Annotated[int, typer.Option("--count", parser=whole_number, help="How many eigenfrequencies.")] = 40,
    force: Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")] = False,
    amplitude: Annotated[
        str | None,
        typer.Option(
            "--amplitude",
            metavar="A1,A2,..",
            help="Frequencies of the platform's modes in large motion, too, at these amplitudes [m] of the cables' "
            "platform end that moves most.",
        ),
    ] = None,
    band: Band = None,
    samples: Samples = None,
    uff: UniversalFile = False,
    *,
    output: Output,
) -> int:
    """Eigenfrequencies of the robot at rest, with their kind."""
    found = cs.modes(
        robot, pose, free=free, lengths=lengths, start=start, lower_bound=lower_bound, upper_bound=upper_bound,
        payload=payload, mass=mass,
        wrench=wrench, temperature=temperature,
        model=model, assembly=assembly, elements=elements, count=count, force=force, amplitude=amplitude,
        band=band, samples=samples,
    )  # fmt: skip
    output.give(found, lambda: {"modes.uff": found.universal_file()} if uff else {})
    return 0

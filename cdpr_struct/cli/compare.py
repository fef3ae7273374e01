"""`cdpr-struct compare`: measured against predicted, each reading in its band or not."""

from pathlib import Path
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
)
from cdpr_struct.cli.output import Output

NAME = "compare"
EXAMPLES = (
    "cdpr-struct compare examples/bands/robot.toml examples/bands/measured.csv --out results/compare",
    "cdpr-struct compare examples/bands/robot.toml examples/bands/measured.csv --band 99 --json",
)


def run(
    robot: RobotName,
    measured: Annotated[Path, typer.Argument(metavar="MEASURED.csv", help="Readings of one state of rest.")],
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
    force: Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")] = False,
    band: Annotated[float, typer.Option("--band", parser=number, metavar="PERCENT", help="Level of each band.")] = 90.0,
    *,
    output: Output,
) -> int:
    """Measured frequencies, tensions and poses against their predicted bands."""
    found = cs.compare(
        robot, measured, pose, free=free, lengths=lengths, start=start, lower_bound=lower_bound,
        upper_bound=upper_bound, payload=payload, mass=mass, wrench=wrench, temperature=temperature,
        model=model, assembly=assembly, force=force, band=band,
    )  # fmt: skip
    output.give(found)
    return 0 if found.holds else 1

"""`cdpr-struct inverse`: lengths and tensions that hold a pose."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    Band,
    Free,
    LowerBound,
    Mass,
    Orient,
    Payload,
    PoseText,
    RobotName,
    Samples,
    Temperature,
    UpperBound,
    Wrench,
)
from cdpr_struct.cli.output import Output

NAME = "inverse"
EXAMPLES = (
    "cdpr-struct inverse thesis-3-1 --pose 0.5,-1,0.8,2,0,5 --out results/inverse",
    "cdpr-struct inverse thesis-5 --pose 1,0.5,2 --lower-bound 150 --payload 10",
)


def run(
    robot: RobotName,
    pose: PoseText = None,
    free: Free = None,
    orient: Orient = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    model: Annotated[str, typer.Option("--model", help="sagging, spring or ideal")] = "sagging",
    wrench: Wrench = None,
    temperature: Temperature = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    band: Band = None,
    samples: Samples = None,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Unstrained lengths and tensions that hold a pose (minimum norm where there is a choice)."""
    found = cs.inverse(
        robot, pose, free=free, orient=orient, payload=payload, mass=mass, model=model,
        wrench=wrench, temperature=temperature, lower_bound=lower_bound,
        upper_bound=upper_bound, band=band, samples=samples,
    )  # fmt: skip
    output.give(found)
    return 0 if found.answer["stable"] else 1

"""`cdpr-struct accept`: does a robot within its tolerances meet requirements?"""

from pathlib import Path
from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import (
    AssemblyName,
    LowerBound,
    Mass,
    Payload,
    RobotName,
    Temperature,
    UpperBound,
    Wrench,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.interface.requirements import read_requirements

NAME = "accept"
EXAMPLES = (
    "cdpr-struct accept examples/bands/robot.toml examples/bands/requirements.toml --out results/accept",
    "cdpr-struct accept examples/bands/robot.toml examples/bands/requirements.toml --mass 110 --json",
)


def run(
    robot: RobotName,
    requirements: Annotated[Path, typer.Argument(metavar="REQUIREMENTS.toml", help="Limits and poses.")],
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    wrench: Wrench = None,
    temperature: Temperature = None,
    model: Annotated[str, typer.Option("--model", help="static, dsm or exact.")] = "exact",
    assembly: AssemblyName = "consistent",
    force: Annotated[bool, typer.Option("--force", help="Use the dsm outside its validity limits.")] = False,
    *,
    output: Output,
) -> int:
    """Pass, fail or cannot be said: requirements on a robot within its tolerances."""
    poses = read_requirements(requirements, cs.load_robot(robot)).poses
    with output.steps(len(poses)) as begin:
        found = cs.accept(
            robot, requirements, lower_bound=lower_bound, upper_bound=upper_bound, payload=payload, mass=mass,
            wrench=wrench, temperature=temperature, model=model, assembly=assembly, force=force, progress=begin,
        )  # fmt: skip
    output.give(found)
    return 0 if found.holds else 1

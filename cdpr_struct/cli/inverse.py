"""`cdpr-struct inverse`: lengths and tensions that hold a pose."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.operating_point import held
from cdpr_struct.cli.options import (
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    UpperBound,
    read_numbers,
    read_pose,
    read_robot,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.errors import InputError

NAME = "inverse"
EXAMPLES = (
    "cdpr-struct inverse thesis-3-1 --pose 0.5,-1,0.8,2,0,5 --out results/inverse",
    "cdpr-struct inverse thesis-5 --pose 1,0.5,2 --lower-bound 150 --payload 10",
)
MODELS = ("sagging", "spring", "ideal")


def run(
    robot: RobotName,
    pose: PoseText = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    model: Annotated[str, typer.Option("--model", help="sagging, spring or ideal")] = "sagging",
    wrench: Annotated[
        str | None, typer.Option("--wrench", metavar="FX,FY,FZ,MX,MY,MZ", help="Extra wrench on the platform [N, N m].")
    ] = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Unstrained lengths and tensions that hold a pose (minimum norm where there is a choice)."""
    chosen = read_model(model)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    where = read_pose(pose, machine)
    extra = None if wrench is None else read_numbers(wrench, "--wrench", (6,), "numbers in N and N m")
    from cdpr_struct.reports import statics_rest as report
    from cdpr_struct.statics.bound_advice import slack_warning

    solution = held(machine, where, chosen, extra)
    told = report.inverse_json(machine, chosen, where, solution)
    slack = slack_warning(machine, where.position, where.rotation, solution.cables, extra)
    told |= {"warnings": [] if slack is None else [slack]}
    result = with_extensions(told, machine, NAME, chosen)
    output.deliver(
        result, lambda: report.inverse_text(result), lambda: report.inverse_files(machine, where, solution, result)
    )
    return 0


def read_model(text: str) -> str:
    """Name of a cable model.

    Raises
    ------
    InputError : there is none of this name.
    """
    if text not in MODELS:
        raise InputError("--model", "", text, f"one of: {', '.join(MODELS)}")
    return text

"""`cdpr-struct inverse`: lengths and tensions that hold a pose."""

from typing import Annotated

import typer

from cdpr_struct.cli.command_words import command_words
from cdpr_struct.cli.extension_notes import noted, with_extensions
from cdpr_struct.cli.options import (
    Json,
    LowerBound,
    Mass,
    Out,
    Payload,
    PoseText,
    RobotName,
    number,
    read_numbers,
    read_pose,
    read_robot,
)
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.errors import InputError

NAME = "inverse"
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
    lower_bound: LowerBound = 0.0,
    upper_bound: Annotated[
        float, typer.Option("--upper-bound", parser=number, metavar="N", help="Largest cable force there [N].")
    ] = float("inf"),
    out: Out = None,
    json: Json = False,
) -> int:  # fmt: skip
    """Unstrained lengths and tensions that hold a pose (minimum norm where there is a choice)."""
    chosen = read_model(model)
    if not 0.0 <= lower_bound < float("inf"):
        raise InputError("--lower-bound", "", lower_bound, "give a force in N, zero or more")
    if not upper_bound > lower_bound:
        raise InputError(
            "--upper-bound", "", upper_bound, f"give a force in N above the lower bound, {lower_bound:g} N"
        )
    machine = read_robot(robot, payload, mass)
    where = read_pose(pose, machine)
    extra = None if wrench is None else read_numbers(wrench, "--wrench", (6,), "numbers in N and N m")
    from cdpr_struct.reports import statics_rest as report
    from cdpr_struct.statics.inverse_kinematics import inverse

    solution = inverse(machine, where.position, where.rotation, chosen, extra, lower_bound, upper_bound)
    result = with_extensions(report.inverse_json(machine, chosen, where, solution), machine, NAME, chosen)
    if out is not None:
        bounds = {
            "--lower-bound": lower_bound or None,
            "--upper-bound": None if upper_bound == float("inf") else upper_bound,
        }
        options = {"--pose": pose, "--model": model, "--wrench": wrench, **bounds}
        command = command_words(NAME, robot, payload, mass, **options)
        write_files(
            out,
            noted(
                result,
                {"result.json": result_json(result), **report.inverse_files(machine, where, solution, result, command)},
            ),
        )
    emit(result, json, lambda: print(report.inverse_text(result)))
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

"""`cdpr-struct inverse`: lengths and tensions that hold a pose."""

from typing import Annotated

import typer

from cdpr_struct.cli.options import (
    Json,
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
    lower_bound: Annotated[
        float, typer.Option("--lower-bound", parser=number, metavar="N", help="Smallest cable force [N].")
    ] = 0.0,
    out: Out = None,
    json: Json = False,
) -> int:
    """Unstrained lengths and tensions that hold a pose (minimum norm where there is a choice)."""
    if model not in MODELS:
        raise InputError("--model", "", model, f"one of: {', '.join(MODELS)}")
    if not 0.0 <= lower_bound < float("inf"):
        raise InputError("--lower-bound", "", lower_bound, "give a force in N, zero or more")
    machine = read_robot(robot, payload, mass)
    where = read_pose(pose, machine)
    import numpy as np

    from cdpr_struct.statics.inverse_kinematics import inverse

    extra = None if wrench is None else np.array(read_numbers(wrench, "--wrench", (6,), "numbers in N and N m"))
    solution = inverse(
        machine, where.position, where.rotation, model=model, external_wrench=extra, lower_bound=lower_bound
    )
    result = {
        "robot": machine.name,
        "model": model,
        "pose": where.in_degrees(),
        "lengths_m": solution.lengths,
        "tensions_N": solution.tensions,
        "residual_wrench": solution.residual_wrench,
    }

    def text() -> None:
        from cdpr_struct.reports.text import plain_table

        rows = [
            [f"cable {i}", f"{length:.5f}", f"{tension:.3f}"]
            for i, (length, tension) in enumerate(zip(solution.lengths, solution.tensions, strict=True), start=1)
        ]
        print(plain_table(f"{machine.name}, {model} cables", ["", "length [m]", "tension [N]"], rows))
        print(
            f"largest unbalanced force {abs(solution.residual_wrench[:3]).max():.2g} N, "
            f"moment {abs(solution.residual_wrench[3:]).max():.2g} N m"
        )

    emit(result, json, text)
    if out is not None:
        write_files(out, {"result.json": result_json(result)})
    return 0

"""`cdpr-struct audit`: the cables against the printed validity limits, or the limits themselves on trial."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.executors import Scheduler, Where, Workers, check_workers, executor
from cdpr_struct.cli.options import (
    GridText,
    Lengths,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    Start,
    UpperBound,
    number,
    robot_names,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches
from cdpr_struct.errors import InputError

NAME = "audit"
EXAMPLES = (
    "cdpr-struct audit thesis-3-1 --grid -3:3:5,-3:3:5,0.5",
    "cdpr-struct audit thesis-5 --trajectory line:0,0,2:1,0,2.5:4",
)
_TRAJECTORY = "helix, line:START:END:SECONDS, or a CSV file time_s,x_m,y_m,z_m[,rx_deg,ry_deg,rz_deg]."


def run(
    robot: Annotated[
        str | None,
        typer.Argument(
            metavar="ROBOT",
            help="Built-in name or path to a robot file; not with --limits.",
            autocompletion=robot_names,
        ),
    ] = None,
    pose: PoseText = None,
    lengths: Lengths = None,
    start: Start = None,
    grid: GridText = None,
    trajectory: Annotated[str | None, typer.Option("--trajectory", metavar="T", help=_TRAJECTORY)] = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    limits: Annotated[bool, typer.Option("--limits", help="Put the printed limits themselves on trial.")] = False,
    small: Annotated[bool, typer.Option("--small", help="With --limits: a coarse grid, some seconds.")] = False,
    tolerance: Annotated[
        float, typer.Option("--tolerance", parser=number, help="With --limits: error that counts as a failure.")
    ] = 0.01,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    *,
    output: Output,
) -> int:
    """Check each cable at each pose against the printed limits; exit 1 if one is broken (or, with --limits, fails)."""
    check_workers(workers, scheduler)
    where = workers, scheduler
    if limits:
        ways = {"ROBOT": robot, "--pose": pose, "--lengths": lengths, "--grid": grid, "--trajectory": trajectory}
        for option, text in ways.items():
            if text is not None:
                raise InputError(option, "", text, "--limits tries single cables of every kind; leave this out")
        return _try_limits(small, tolerance, where, output)
    if robot is None:
        raise InputError("ROBOT", "", "nothing", "give a robot, or --limits")
    if small:
        raise InputError("--small", "", small, "it belongs to --limits; leave it out")
    from cdpr_struct.interface.audit import AuditResult, audit_question

    asked = audit_question(robot, pose, lengths, start, grid, trajectory, payload, mass, lower_bound, upper_bound)
    if isinstance(asked, AuditResult):
        output.give(asked)
        return 0 if asked.valid else 1
    found = asked.answered(run_batches(asked.batches, where, output)[0])
    output.give(found)
    clear_checkpoint(asked.batches, output.directory)
    return 0 if found.valid else 1


def _try_limits(small: bool, tolerance: float, where: Where, output: Output) -> int:
    from cdpr_struct.crosscheck.limits_trial import step_count
    from cdpr_struct.interface.limits import extent

    with executor(*where) as pool, output.steps(step_count(extent(small))) as progress:
        found = cs.limits(small=small, tolerance=tolerance, executor=pool, progress=progress)
    output.give(found)
    return 0 if found.holds else 1

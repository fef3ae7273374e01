"""`cdpr-struct audit`: the cables against the printed validity limits, or the limits themselves on trial."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cdpr_struct.cli.executors import Scheduler, Where, Workers, check_workers, executor
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.operating_point import rest
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
    read_grid,
    read_robot,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches
from cdpr_struct.cli.trajectory_input import read_trajectory
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    import numpy as np

    from cdpr_struct.crosscheck.limits_poses import PoseAudit
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.workspace.grid import Grid

NAME = "audit"
EXAMPLES = (
    "cdpr-struct audit thesis-3-1 --grid -3:3:5,-3:3:5,0.5 --workers 2",
    "cdpr-struct audit thesis-5 --trajectory line:0,0,2:1,0,2.5:4",
)
_INSTANTS = 301
_TRAJECTORY = "helix, line:START:END:SECONDS, or a CSV file time_s,x_m,y_m,z_m[,rx_deg,ry_deg,rz_deg]."


def run(
    robot: Annotated[
        str | None, typer.Argument(metavar="ROBOT", help="Built-in name or path to a robot file; not with --limits.")
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
    ways = {"--pose": pose, "--lengths": lengths, "--grid": grid, "--trajectory": trajectory}
    given = {option: text for option, text in ways.items() if text is not None}
    check_workers(workers, scheduler)
    if limits:
        for option, text in ({"ROBOT": robot} if robot else given).items():
            raise InputError(option, "", text, "--limits tries single cables of every kind; leave this out")
        return _try_limits(small, tolerance, (workers, scheduler), output)
    if robot is None:
        raise InputError("ROBOT", "", "nothing", "give a robot, or --limits")
    if len(given) > 1:
        last = list(given)[-1]
        raise InputError(last, "", given[last], f"give only one of {', '.join(ways)}")
    if small:
        raise InputError("--small", "", small, "it belongs to --limits; leave it out")
    if start is not None and lengths is None:
        raise InputError("--start", "", start, "it belongs to --lengths; leave it out")
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    if grid is not None or trajectory is not None:
        return _many(machine, grid, trajectory, (workers, scheduler), output)
    from cdpr_struct.crosscheck.limits_poses import audit_rest

    state = rest(machine, pose, lengths, start)
    return _report(audit_rest(state.point), machine, output, more=state.told())


def _many(machine: "Robot", grid: str | None, trajectory: str | None, where: Where, output: Output) -> int:
    """The audit of many poses, reported over the grid or the times that they are ordered by."""
    from cdpr_struct.crosscheck.limits_poses import audit_batches, audit_of

    if grid is not None:
        poses = read_grid(grid)
        batches = audit_batches(machine, poses.positions, poses.rotation)
        columns, _ = run_batches(batches, where, output)
        code = _report(audit_of(batches, columns), machine, output, grid=poses)
    else:
        text = str(trajectory)
        path, assumed = read_trajectory(text, _INSTANTS if text == "helix" or text.startswith("line:") else None)
        batches = audit_batches(machine, path.position, path.rotation)
        columns, _ = run_batches(batches, where, output)
        code = _report(audit_of(batches, columns), machine, output, time=path.time, more={"warnings": assumed})
    clear_checkpoint(batches, output.directory)
    return code


def _report(
    audit: "PoseAudit",
    machine: "Robot",
    output: Output,
    grid: "Grid | None" = None,
    time: "np.ndarray | None" = None,
    more: "dict[str, Any] | None" = None,
) -> int:
    from cdpr_struct.reports.audit_result import audit_json, audit_text

    def files() -> Files:
        from cdpr_struct.reports.audit_page import audit_files

        return audit_files(audit, grid, time)

    told = audit_json(audit, time) | (more or {"warnings": []})
    result = with_extensions(told, machine, NAME)
    output.deliver(result, lambda: audit_text(audit), files)
    return 0 if result["valid"] else 1


def _try_limits(small: bool, tolerance: float, where: Where, output: Output) -> int:
    if not 0.0 < tolerance < 1.0:
        raise InputError("--tolerance", "", tolerance, "give a ratio between 0 and 1, like 0.01")
    from cdpr_struct.crosscheck.limits_trial import FULL_EXTENT, SMALL_EXTENT, step_count, try_limits
    from cdpr_struct.reports.audit_limits_result import limits_trial_json
    from cdpr_struct.reports.audit_limits_text import limits_trial_text

    extent = SMALL_EXTENT if small else FULL_EXTENT
    with executor(*where) as pool, output.steps(step_count(extent)) as progress:
        trial = try_limits(extent, tolerance, pool, progress)

    def files() -> Files:
        from cdpr_struct.reports.audit_limits_page import limits_trial_files

        return limits_trial_files(trial)

    output.deliver(limits_trial_json(trial), lambda: limits_trial_text(trial), files)
    return 0 if trial.holds else 1

"""`cdpr-struct pose-error`: how far the platform misses its pose when sag and stretch are not accounted for."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cdpr_struct.cli.executors import Scheduler, Workers, check_workers
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.options import (
    GridText,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    UpperBound,
    number,
    read_grid,
    read_pose,
    read_robot,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.robot.pose import Pose
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.statics.sufficient_load import SufficientLoad

NAME = "pose-error"
EXAMPLES = (
    "cdpr-struct pose-error thesis-3-1 --grid -3:3:7,-3:3:7,0.5 --mass 30 --out results/pose-error",
    "cdpr-struct pose-error thesis-3-1 --sufficient-load 1 --pose 0,0,0.5",
)


def run(
    robot: RobotName,
    grid: GridText = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    sufficient_load: Annotated[
        float | None,
        typer.Option(
            "--sufficient-load", parser=number, metavar="TOL_MM",
            help="Find the mass from which on the spring model is good to this tolerance, at --pose.",
        ),
    ] = None,
    pose: PoseText = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Static pose error over a grid, split into what sag adds and what stretch adds (thesis 3.2.2)."""
    _check(grid, sufficient_load, pose)
    check_workers(workers, scheduler)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    poses = None if grid is None else read_grid(grid)
    load = None if sufficient_load is None else _load(machine, read_pose(pose, machine), sufficient_load)
    from cdpr_struct.reports import statics_pose_error as report
    from cdpr_struct.workspace.pose_error_map import PoseErrorMap
    from cdpr_struct.workspace.sweep import sweep

    errors: PoseErrorMap | None = None
    result: dict[str, Any] = {"robot": machine.name, "mass_kg": machine.platform.mass}
    batches = None
    if poses is not None:
        batches = sweep("pose-error", machine, poses)
        columns, _ = run_batches(batches, (workers, scheduler), output)
        errors = PoseErrorMap(machine.name, machine.platform.mass, poses, columns).require_some()
        result |= report.pose_error_json(errors, machine)
    if load is not None:
        result["sufficient_load"] = report.sufficient_load_json(*load)
    result = with_extensions(result, machine, NAME)
    output.deliver(
        result,
        lambda: "\n".join(report.pose_error_sentences(errors, load)),
        lambda: report.pose_error_files(machine, errors, load),
    )
    if batches is not None:
        clear_checkpoint(batches, output.directory)
    return 0


def _check(grid: str | None, sufficient_load: float | None, pose: str | None) -> None:
    """What is asked for, and whether the options belong together."""
    if grid is None and sufficient_load is None:
        raise InputError("--grid", "", "nothing", "give --grid, --sufficient-load, or both")
    if sufficient_load is not None and not 0.0 < sufficient_load < float("inf"):
        raise InputError("--sufficient-load", "", sufficient_load, "give a tolerance in mm above zero")
    if pose is not None and sufficient_load is None:
        raise InputError("--pose", "", pose, "a pose is for --sufficient-load; errors over poses take --grid")


def _load(machine: "Robot", where: "Pose", tolerance: float) -> "tuple[SufficientLoad, Pose]":
    from cdpr_struct.statics.sufficient_load import sufficient_load

    return sufficient_load(machine, where.position, where.rotation, 1e-3 * tolerance), where

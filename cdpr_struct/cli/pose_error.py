"""`cdpr-struct pose-error`: how far the platform misses its pose when sag and stretch are not accounted for."""

from typing import Annotated

import typer

from cdpr_struct.cli.executors import Scheduler, Workers, check_workers
from cdpr_struct.cli.options import (
    Band,
    Free,
    GridText,
    LowerBound,
    Mass,
    Payload,
    PoseText,
    RobotName,
    Samples,
    Temperature,
    UpperBound,
    Wrench,
    number,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches

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
    wrench: Wrench = None,
    temperature: Temperature = None,
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
    free: Free = None,
    band: Band = None,
    samples: Samples = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Static pose error over a grid, split into what sag adds and what stretch adds (thesis 3.2.2)."""
    check_workers(workers, scheduler)
    from cdpr_struct.interface.pose_error import pose_error_question

    asked = pose_error_question(
        robot, grid, payload, mass, wrench, temperature, lower_bound, upper_bound, sufficient_load, pose, free,
        band, samples,
    )  # fmt: skip
    batches = asked.batches
    columns = None if batches is None else run_batches(batches, (workers, scheduler), output)[0]
    output.give(asked.answered(columns))
    if batches is not None:
        clear_checkpoint(batches, output.directory)
    return 0

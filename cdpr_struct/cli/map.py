"""`cdpr-struct map`: any quantity over the workspace, resumable, on as many processes or machines as there are."""

from typing import Annotated

import typer

from cdpr_struct.cli.executors import Scheduler, Workers, check_workers
from cdpr_struct.cli.options import (
    Free,
    GridText,
    LowerBound,
    Mass,
    Payload,
    RobotName,
    Temperature,
    UpperBound,
    Wrench,
    whole_number,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches

NAME = "map"
EXAMPLES = (
    "cdpr-struct map thesis-3-1 --grid -3:3:9,-3:3:9,0.5 --quantity first-frequency --out results/map",
    "cdpr-struct map thesis-5 --grid -2:2:5,0,1.5:3.5:5 --quantity tension-max --lower-bound 100",
)


def run(
    robot: RobotName,
    grid: GridText = None,
    quantity: Annotated[
        str | None, typer.Option("--quantity", metavar="NAME", help="What to map; an unknown name lists them.")
    ] = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    wrench: Wrench = None,
    temperature: Temperature = None,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    free: Free = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    chunk: Annotated[
        int | None,
        typer.Option("--chunk", parser=whole_number, help="Poses per batch; default: chosen for the quantity."),
    ] = None,
    *,
    output: Output,
) -> int:
    """Map a quantity over a grid of poses; with --out, an interrupted run continues where it stopped."""
    check_workers(workers, scheduler)
    from cdpr_struct.interface.map import map_question

    asked = map_question(
        robot, grid, quantity, payload, mass, wrench, temperature, lower_bound, upper_bound, chunk, free
    )
    batches = asked.batches
    found = asked.answered(*run_batches(batches, (workers, scheduler), output))
    output.give(found)
    clear_checkpoint(batches, output.directory)
    return 0 if found.answer["held"] > found.answer["unstable"] else 1

"""`cdpr-struct map`: any quantity over the workspace, resumable, on as many processes or machines as there are."""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.cli.executors import Scheduler, Workers, check_workers
from cdpr_struct.cli.options import (
    Band,
    Free,
    GridText,
    LowerBound,
    Mass,
    Payload,
    RobotName,
    Samples,
    Temperature,
    UpperBound,
    Wrench,
    number,
    whole_number,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches

if TYPE_CHECKING:
    from cdpr_struct.workspace.pose_batches import PoseBatches
    from cdpr_struct.workspace.work_list import Columns

NAME = "map"
EXAMPLES = (
    "cdpr-struct map thesis-3-1 --grid -3:3:9,-3:3:9,0.5 --quantity first-frequency --out results/map",
    'cdpr-struct map thesis-3-1 --grid -3:3:7,-3:3:7,1.5 --quantity workspace --require "cable-distance>=0.3"',
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
    require: Annotated[
        list[str] | None,
        typer.Option(
            "--require", metavar="NAME>=VALUE", help="Of a workspace: any quantity with >= or <=; may be repeated."
        ),
    ] = None,
    wrenches: Annotated[
        str | None,
        typer.Option(
            "--wrenches",
            metavar="FILE.csv|fx=A:B,..",
            help="Wrenches to be held beside the load: rows of a CSV file, or all corners of ranges [N, N m].",
        ),
    ] = None,
    refine: Annotated[
        int,
        typer.Option("--refine", parser=whole_number, help="Halvings of the grid where the workspace ends."),
    ] = 1,
    anchor_zone: Annotated[
        float,
        typer.Option(
            "--anchor-zone",
            parser=number,
            metavar="M",
            help="Cable next to an anchor that is shared or sits on a body, left out of distances [m].",
        ),
    ] = 0.1,
    band: Band = None,
    samples: Samples = None,
    limit: Annotated[
        float | None,
        typer.Option(
            "--limit",
            parser=number,
            metavar="VALUE",
            help="With --band: map the probability of falling below, in the quantity's unit.",
        ),
    ] = None,
    *,
    output: Output,
) -> int:
    """Map a quantity, or where all requirements hold; with --out, an interrupted run continues where it stopped."""
    check_workers(workers, scheduler)
    from cdpr_struct.interface.map import map_question

    asked = map_question(
        robot, grid, quantity, payload, mass, wrench, temperature, lower_bound, upper_bound, chunk, free,
        (require or None, wrenches, refine, anchor_zone), (band, samples, limit),
    )  # fmt: skip
    resumed = 0

    def run_here(batches: "PoseBatches") -> "Columns":
        nonlocal resumed
        columns, kept = run_batches(batches, (workers, scheduler), output)
        resumed += kept
        return columns

    found = asked.answered_by(run_here)
    output.give(replace(found, answer={**found.answer, "resumed_chunks": resumed}))
    for batches in asked.ran:
        clear_checkpoint(batches, output.directory)
    if "hold_all" in found.answer:
        return 0 if found.answer["hold_all"] else 1
    return 0 if found.answer["held"] > found.answer["unstable"] else 1

"""`cdpr-struct map`: any quantity over the workspace, resumable, on as many processes or machines as there are."""

from typing import Annotated

import typer

from cdpr_struct.cli.executors import Scheduler, Workers, check_workers
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.options import (
    GridText,
    LowerBound,
    Mass,
    Payload,
    RobotName,
    UpperBound,
    read_grid,
    read_robot,
    whole_number,
)
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.sweeping import clear_checkpoint, run_batches
from cdpr_struct.errors import InputError

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
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    chunk: Annotated[
        int | None,
        typer.Option("--chunk", parser=whole_number, help="Poses a batch; what suits the quantity if not given."),
    ] = None,
    *,
    output: Output,
) -> int:
    """Map a quantity over a grid of poses; with --out, an interrupted run continues where it stopped."""
    if grid is None:
        raise InputError("--grid", "", "nothing", "give X0:X1:NX,Y0:Y1:NY,Z, like -3:3:13,-3:3:13,0.5")
    if chunk is not None and not 1 <= chunk <= 100_000:
        raise InputError("--chunk", "", chunk, "give a number from 1 to 100000")
    check_workers(workers, scheduler)
    machine, poses = read_robot(robot, payload, mass, lower_bound, upper_bound), read_grid(grid)
    from cdpr_struct.reports import statics_map as report
    from cdpr_struct.workspace.quantities import quantity_of
    from cdpr_struct.workspace.sweep import sweep

    quantity = quantity or "nothing"
    try:
        what = quantity_of(quantity)
    except KeyError as error:
        raise InputError("--quantity", "", quantity, error.args[0]) from None
    if what.most_poses is not None and poses.size > (most := what.most_poses(machine)):
        right = f"at most {most} poses for {quantity}, which keeps the mode shapes of all poses in memory"
        raise InputError("--grid", "", f"{poses.size} poses", right)
    batches = sweep(quantity, machine, poses, chunk)
    columns, resumed = run_batches(batches, (workers, scheduler), output)
    columns = what.finished(machine, poses, columns)
    result = report.map_json(machine, quantity, poses, columns) | {"resumed_chunks": resumed}
    result = with_extensions(result, machine, _kin(quantity))
    output.deliver(
        result,
        lambda: report.map_sentence(result),
        lambda: report.map_files(machine, quantity, poses, columns, result),
    )
    clear_checkpoint(batches, output.directory)
    return 0 if result["held"] > result["unstable"] else 1


def _kin(quantity: str) -> str:
    """The command that knows the extensions which this quantity knows."""
    if quantity.startswith("pose-error"):
        return "pose-error"
    return NAME if quantity.startswith(("first-", "mode-")) or quantity == "frequencies" else "inverse"

"""A quantity over a grid, in batches that any `concurrent.futures.Executor` may share out."""

from functools import partial

from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.quantities import evaluate, quantity_of


def sweep(quantity: str, robot: Robot, grid: Grid, batch: int | None = None) -> PoseBatches:
    """A quantity (`quantity_of`) over a grid; `batch` poses at once, what suits the quantity if not given."""
    size = batch or quantity_of(quantity).chunk
    return PoseBatches(quantity, partial(evaluate, quantity), robot, grid.positions, grid.rotation, size)

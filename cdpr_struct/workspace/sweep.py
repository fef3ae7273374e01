"""A quantity over a grid, in batches that any `concurrent.futures.Executor` may share out."""

from functools import partial

from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.quantities import QUANTITIES, evaluate


def sweep(quantity: str, robot: Robot, grid: Grid, batch: int | None = None) -> PoseBatches:
    """One of `QUANTITIES` over a grid; `batch` poses at once, what suits the quantity if not given."""
    size = batch or QUANTITIES[quantity].chunk
    return PoseBatches(quantity, partial(evaluate, quantity), robot, grid.positions, grid.rotation, size)

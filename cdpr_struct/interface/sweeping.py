"""A quantity over a grid of poses, a chunk at a time, here or on any executor."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor

import numpy as np

from cdpr_struct.interface.answering import one_thread
from cdpr_struct.interface.given import Progress
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.quantities import QUANTITIES, Columns, evaluate

_Work = tuple[str, Robot, np.ndarray, np.ndarray]


def swept(
    quantity: str, robot: Robot, grid: Grid, executor: Executor | None, progress: Progress, chunk: int | None = None
) -> Columns:
    """Columns of n values over the whole grid.

    executor : of `concurrent.futures`, a Dask cluster's among them, that computes the chunks; None: this process
    progress : called once a chunk
    chunk    : poses a batch; None: what suits the quantity
    """
    size = chunk or QUANTITIES[quantity].chunk
    positions, rotation = grid.positions, grid.rotation
    work = [(quantity, robot, positions[i : i + size], rotation) for i in range(0, grid.size, size)]
    run: Callable[..., Iterator[Columns]] = map if executor is None else executor.map
    parts = []
    progress(f"{grid.size} poses")
    for part in run(_evaluated, work):
        parts.append(part)
        progress(f"{grid.size} poses")
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _evaluated(work: _Work) -> Columns:
    """A chunk, computed wherever it lands."""
    with one_thread():
        return evaluate(*work)

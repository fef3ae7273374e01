"""A function of very many poses, a batch at a time, here or on any executor."""

from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.interface.answering import one_thread
from cdpr_struct.interface.given import Progress
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.pose_batches import Evaluate, PoseBatches
from cdpr_struct.workspace.work_list import Columns


def swept(batches: PoseBatches, executor: Executor | None, progress: Progress) -> Columns:
    """Columns of n values over all poses.

    executor : of `concurrent.futures`, a Dask cluster's among them, that computes the batches; None: this process
    progress : called once a batch
    """
    return replace(batches, evaluate=_OnOneThread(batches.evaluate)).here(executor, progress)


@dataclass(frozen=True, slots=True)
class _OnOneThread:
    """What computes a batch, wherever it lands."""

    evaluate: Evaluate

    def __call__(self, robot: Robot, position: np.ndarray, rotation: np.ndarray) -> Columns:
        with one_thread():
            return self.evaluate(robot, position, rotation)

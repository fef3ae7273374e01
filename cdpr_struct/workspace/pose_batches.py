"""A function of very many poses, cut into batches."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from cdpr_struct.robot.fingerprint import fingerprint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.work_list import Columns, run_parts

Evaluate = Callable[[Robot, np.ndarray, np.ndarray], Columns]


@dataclass(frozen=True, slots=True, eq=False)
class PoseBatches:
    """Columns of a robot at n poses as a `work_list.WorkList`: each part is one batch of poses.

    name     : of what is computed, for the fingerprint
    evaluate : (robot, positions (k, 3) [m], rotation (3, 3) or (k, 3, 3)) -> columns with k rows; it can be sent to
               another process
    position : (n, 3) platform origin, world frame [m]
    rotation : (3, 3) for all poses, or (n, 3, 3), platform to world
    batch    : poses in a batch
    """

    name: str
    evaluate: Evaluate
    robot: Robot
    position: np.ndarray
    rotation: np.ndarray
    batch: int

    @property
    def parts(self) -> int:
        """Number of batches, one at least."""
        return max(1, -(-len(self.position) // self.batch))

    @property
    def about(self) -> str:
        """For the progress bar."""
        return f"{len(self.position)} poses"

    @property
    def fingerprint(self) -> str:
        """Hexadecimal digest of everything that the result depends on."""
        return fingerprint(f"{self.name} {self.batch}", self.robot, self.position, self.rotation)

    def key(self, number: int) -> str:
        """Name of a batch."""
        return f"{number:06d}"

    def call(self, number: int) -> tuple[Callable[..., Columns], tuple[Any, ...]]:
        """What computes a batch."""
        part = slice(number * self.batch, (number + 1) * self.batch)
        rotation = self.rotation if self.rotation.ndim == 2 else self.rotation[part]
        return self.evaluate, (self.robot, self.position[part], rotation)

    def joined(self, found: Mapping[int, Columns]) -> Columns:
        """Columns over all poses, from all batches by number, which are used up: all is in memory once."""
        batches = [found[number] for number in range(self.parts)]
        return {name: np.concatenate([batch.pop(name) for batch in batches]) for name in list(batches[0])}

    def here(self, executor: Executor | None = None, progress: Callable[[str], None] = lambda about: None) -> Columns:
        """Columns over all poses, computed now.

        executor : that shares the batches; None: this process, in this thread
        progress : called once a batch, and once before the first
        """
        progress(self.about)
        found: dict[int, Columns] = {}

        def finished(number: int, part: Columns) -> None:
            found[number] = part
            progress(self.about)

        if executor is not None:
            run_parts(self, executor, range(self.parts), finished)
            return self.joined(found)
        for number in range(self.parts):
            evaluate, given = self.call(number)
            finished(number, evaluate(*given))
        return self.joined(found)

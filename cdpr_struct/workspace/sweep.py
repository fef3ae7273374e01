"""Working off a grid in chunks, each one batch, on any `concurrent.futures.Executor`."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, fields
from importlib.metadata import version

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.quantities import Columns, evaluate

CHUNK = 256


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """One quantity of one robot over one grid.

    quantity : a name of `QUANTITIES`
    chunk    : poses a batch
    """

    quantity: str
    robot: Robot
    grid: Grid
    chunk: int = CHUNK

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.grid.size // self.chunk)

    @property
    def fingerprint(self) -> str:
        """Hexadecimal digest of everything that the result depends on."""
        arrays = RobotArrays.of(self.robot)
        parts = [np.asarray(getattr(arrays, f.name), dtype=float) for f in fields(arrays)]
        parts += [*self.grid.axes, self.grid.angles]
        digest = hashlib.sha256(f"{version('cdpr-struct')} {self.quantity} {self.chunk}".encode())
        for part in parts:
            digest.update(f"{part.shape}".encode() + np.ascontiguousarray(part).tobytes())
        return digest.hexdigest()[:16]

    def run(
        self,
        executor: Executor,
        known: Mapping[int, Columns] | None = None,
        finished: Callable[[int, Columns], None] = lambda number, columns: None,
    ) -> Columns:
        """Columns of n values over the whole grid.

        Parameters
        ----------
        executor : where the chunks run; threads, processes, or a cluster's
        known : chunks by number that need not be computed
        finished : called with number and columns of each chunk as it is done, in this thread
        """
        columns: Columns = {}
        positions, rotation = self.grid.positions, self.grid.rotation
        for number, part in (known or {}).items():
            self._enter(columns, number, part)
        missing = {
            executor.submit(evaluate, self.quantity, self.robot, positions[part], rotation): number
            for number, part in enumerate(self._parts())
            if number not in (known or {})
        }
        try:
            for future in as_completed(list(missing)):
                number, part = missing.pop(future), future.result()
                self._enter(columns, number, part)
                finished(number, part)
        finally:
            for future in missing:
                future.cancel()
        return columns

    def _enter(self, columns: Columns, number: int, part: Columns) -> None:
        """Write a chunk into the columns over the whole grid."""
        start = number * self.chunk
        for name, values in part.items():
            if name not in columns:
                columns[name] = np.empty(self.grid.size, dtype=values.dtype)
            columns[name][start : start + len(values)] = values

    def _parts(self) -> Iterator[slice]:
        return (slice(start, start + self.chunk) for start in range(0, self.grid.size, self.chunk))

"""Long work in parts that do not depend on each other, on any `concurrent.futures.Executor`."""

from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from typing import Any, Protocol, TypeVar

import numpy as np

Part = TypeVar("Part")
PartMade = TypeVar("PartMade", covariant=True)

Columns = dict[str, np.ndarray]
"""Arrays of one length by name: a table, or some of its rows."""

PENDING = 512  # parts that are handed out at a time: enough for some hundred cores, and no burden for a scheduler


class WorkList(Protocol[PartMade]):
    """Parts of a long computation, numbered from 0."""

    @property
    def parts(self) -> int:
        """How many."""

    @property
    def about(self) -> str:
        """What is computed, for the progress bar, like `625 poses`."""

    @property
    def fingerprint(self) -> str:
        """Digest of everything that all parts depend on."""

    def key(self, number: int) -> str:
        """Name of a part under the fingerprint: a file's name."""

    def call(self, number: int) -> tuple[Callable[..., PartMade], tuple[Any, ...]]:
        """Function and arguments that give a part; both can be sent to another process."""


def run_parts(
    work: WorkList[Part], executor: Executor, missing: Iterable[int], finished: Callable[[int, Part], None]
) -> None:
    """Compute parts, at most `PENDING` of them handed out at a time.

    Parameters
    ----------
    executor : where they run; threads, processes, or a cluster's
    missing : their numbers
    finished : called with number and result of each as it is done, in this thread
    """
    numbers, pending = iter(missing), dict[Future[Part], int]()
    try:
        while True:
            for number in numbers:
                function, arguments = work.call(number)
                pending[executor.submit(function, *arguments)] = number
                if len(pending) >= PENDING:
                    break
            if not pending:
                return
            done = wait(pending, return_when=FIRST_COMPLETED).done
            for future in sorted(done, key=lambda one: one.exception() is not None):  # keep what is whole, then fail
                finished(pending.pop(future), future.result())
    finally:
        for future in pending:
            future.cancel()

"""Independent pieces of work on all cores: forked processes, which begin with everything computed so far."""

import io
import os
import pickle
import signal
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

_alone = False  # whether this process is one of several already


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item], known: Sequence[object]) -> list[Result]:
    """work(item) of each, in order; known objects in results are these objects themselves, whatever they hold.

    What another process does not deliver is done here. Without forks or with one core, all is done here.
    """
    several = min(cores(), len(items))
    if several < 2:
        return [work(item) for item in items]
    names = {id(thing): thing for thing in known}
    others = [_Other(work, items[i::several], names) for i in range(1, several)]
    try:
        parts = [[work(item) for item in items[::several]], *(other.results() for other in others)]
    finally:
        for other in others:
            other.end()
    return [parts[i % several][i // several] for i in range(len(items))]


def cores() -> int:
    """How many processes may work at once; one where processes cannot be forked, and in a forked one."""
    return 1 if _alone or sys.platform != "linux" else len(os.sched_getaffinity(0))


class _Other:
    """A forked process that does a part of the work."""

    def __init__(self, work: Callable[[Any], Any], items: Sequence[Any], names: dict[int, object]) -> None:
        self.work, self.items, self.names = work, items, names
        self.pipe, write = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of forks beside threads, which the work does not use
            self.process = os.fork()
        if not self.process:
            self._deliver(write)
        os.close(write)

    def results(self) -> list[Any]:
        """What it found; found here if it ended without."""
        with os.fdopen(os.dup(self.pipe), "rb") as pipe:
            reader = pickle.Unpickler(pipe)
            reader.persistent_load = self.names.__getitem__  # type: ignore[method-assign]
            try:
                found: list[Any] = reader.load()
            except (EOFError, pickle.UnpicklingError):
                found = [self.work(item) for item in self.items]
        return found

    def end(self) -> None:
        """The process is gone afterwards."""
        os.close(self.pipe)
        os.kill(self.process, signal.SIGKILL)
        os.waitpid(self.process, 0)

    def _deliver(self, write: int) -> None:
        """In the forked process, which ends here: results, or nothing where anything goes wrong."""
        global _alone
        _alone = True
        try:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            text = io.BytesIO()
            writer = pickle.Pickler(text, pickle.HIGHEST_PROTOCOL)
            writer.persistent_id = lambda thing: id(thing) if id(thing) in self.names else None  # type: ignore[method-assign]
            writer.dump([self.work(item) for item in self.items])
            with os.fdopen(write, "wb") as pipe:
                pipe.write(text.getbuffer())
        finally:
            os._exit(0)

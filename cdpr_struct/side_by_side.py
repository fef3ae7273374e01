"""Independent pieces of work on all cores: forked processes, which begin with everything computed so far."""

import ctypes
import io
import os
import pickle
import signal
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

_WIDTH = 4  # bytes of a number in the queue
_MOST = 10_000  # numbers that a pipe holds
_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of Linux
_alone = False  # whether this process is one of several already


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item], known: Sequence[object]) -> list[Result]:
    """work(item) of each, in order; known objects in results are these objects themselves, whatever they hold.

    Each process takes the next piece when it is free. What another one does not deliver is done here. Without forks or
    with one core, all is done here.
    """
    several = min(cores(), len(items))
    if several < 2 or len(items) > _MOST:
        return [work(item) for item in items]
    queue, names = _queue(len(items)), {id(thing): thing for thing in known}

    def taken() -> dict[int, Any]:
        return {i: work(items[i]) for i in _numbers(queue)}

    others = [_Other(taken, names) for _ in range(several - 1)]
    try:
        found = taken()
        for other in others:
            found |= other.results()
    finally:
        os.close(queue)
        for other in others:
            other.end()
    return [found[i] if i in found else work(item) for i, item in enumerate(items)]


def cores() -> int:
    """How many processes may work at once; one where processes cannot be forked, and in a forked one."""
    return 1 if _alone or sys.platform != "linux" else len(os.sched_getaffinity(0))


def _queue(count: int) -> int:
    """A pipe from which each number below a count is read once, by whoever comes first."""
    queue, write = os.pipe()
    os.write(write, b"".join(i.to_bytes(_WIDTH, "little") for i in range(count)))
    os.close(write)
    return queue


def _numbers(queue: int) -> Iterator[int]:
    while number := os.read(queue, _WIDTH):
        yield int.from_bytes(number, "little")


class _Other:
    """A forked process that takes a part of the work."""

    def __init__(self, taken: Callable[[], dict[int, Any]], names: dict[int, object]) -> None:
        self.names = names
        self.pipe, write = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of forks beside threads, which the work does not use
            self.process = os.fork()
        if not self.process:
            self._deliver(taken, write)
        os.close(write)

    def results(self) -> dict[int, Any]:
        """What it found, by number; nothing where it failed."""
        with os.fdopen(os.dup(self.pipe), "rb") as pipe:
            reader = pickle.Unpickler(pipe)
            reader.persistent_load = self.names.__getitem__  # type: ignore[method-assign]
            try:
                found: dict[int, Any] = reader.load()
            except (EOFError, pickle.UnpicklingError):
                found = {}
        return found

    def end(self) -> None:
        """The process is gone afterwards."""
        os.close(self.pipe)
        os.kill(self.process, signal.SIGKILL)
        os.waitpid(self.process, 0)

    def _deliver(self, taken: Callable[[], dict[int, Any]], write: int) -> None:
        """In the forked process, which ends here: results, or nothing where anything goes wrong."""
        global _alone
        _alone = True
        try:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            _end_with_parent()
            text = io.BytesIO()
            writer = pickle.Pickler(text, pickle.HIGHEST_PROTOCOL)
            writer.persistent_id = lambda thing: id(thing) if id(thing) in self.names else None  # type: ignore[method-assign]
            writer.dump(taken())
            with os.fdopen(write, "wb") as pipe:
                pipe.write(text.getbuffer())
        finally:
            os._exit(0)


def _end_with_parent() -> None:
    """Let a forked process end when its parent is killed: it could not deliver any more."""
    ctypes.CDLL(None).prctl(_DEATH_SIGNAL, signal.SIGKILL)

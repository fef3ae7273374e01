"""Where the batches of a sweep are computed: this process, several, or a cluster."""

import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing.connection import wait
from threading import Thread
from typing import Annotated

import typer

from cdpr_struct.cli.options import whole_number
from cdpr_struct.errors import InputError

Workers = Annotated[
    int, typer.Option("--workers", parser=whole_number, metavar="N", help="Processes that share the work.")
]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Dask scheduler that takes the work, like tcp://host:8786.")
]  # fmt: skip
_SPAWN = multiprocessing.get_context("spawn")
Where = tuple[int, str | None]
"""Values of --workers and --scheduler."""


def check_workers(workers: int, scheduler: str | None) -> None:
    """Complain about options before any work is done.

    Raises
    ------
    InputError : a count out of range, or both ways at once.
    """
    if not 1 <= workers <= 256:
        raise InputError("--workers", "", workers, "give a number from 1 to 256")
    if scheduler is not None and workers != 1:
        raise InputError("--workers", "", workers, "give either --workers or --scheduler, not both")


@contextmanager
def executor(workers: int, scheduler: str | None) -> Iterator[Executor]:
    """The executor that the options name; pending work is dropped when the block is left by an error.

    An interrupt ends workers at once, with what they are at; it leaves a thread behind, which ends with the program.

    Raises
    ------
    InputError : dask.distributed is not installed, or the scheduler does not answer.
    """
    if scheduler is not None:
        with _cluster(scheduler) as pool:
            yield pool
        return
    here, waits = workers == 1, True
    own = ThreadPoolExecutor(1) if here else ProcessPoolExecutor(workers, _SPAWN, _end_with_the_parent)
    try:
        yield own
    except KeyboardInterrupt:
        waits = not here
        for worker in multiprocessing.active_children():
            worker.terminate()
        raise
    finally:
        own.shutdown(wait=waits, cancel_futures=True)


def _end_with_the_parent() -> None:
    """A worker whose parent was killed would wait for work for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        Thread(target=_end_after, args=(parent.sentinel,), daemon=True).start()


def _end_after(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)


@contextmanager
def _cluster(address: str) -> Iterator[Executor]:
    try:
        from dask.distributed import Client  # type: ignore[import-not-found, unused-ignore]
    except ImportError as error:
        hint = "handing work to a cluster needs the extra: pip install 'cdpr-struct[scheduler]'"
        raise InputError("--scheduler", "", address, hint) from error
    try:
        client = Client(address, timeout=10)
    except (OSError, ValueError, TypeError) as error:
        hint = f"no Dask scheduler answers there ({error})".replace("\n", " ")
        raise InputError("--scheduler", "", address, hint) from error
    with client:
        yield client.get_executor()

"""Running a sweep from the command line: executor, progress bar, checkpoint."""

from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from cdpr_struct.cli.checkpoint import Checkpoint
from cdpr_struct.cli.executors import executor
from cdpr_struct.cli.interruption import Interrupted
from cdpr_struct.cli.output import Output
from cdpr_struct.errors import CdprError

if TYPE_CHECKING:
    from cdpr_struct.workspace.quantities import Columns
    from cdpr_struct.workspace.sweep import Sweep

_LIVES = 3  # pools of workers that one run may use up


def run_sweep(sweep: "Sweep", workers: int, scheduler: str | None, output: Output) -> "tuple[Columns, int]":
    """Columns over the grid, and how many chunks came from an earlier, interrupted run in the same directory."""
    store = None if output.directory is None else Checkpoint(output.directory, sweep.fingerprint)
    known = {} if store is None else store.chunks(sweep.chunks)
    resumed = len(known)
    with output.steps(sweep.chunks - resumed) as begin:
        begin(f"{sweep.grid.size} poses")

        def finished(number: int, columns: "Columns") -> None:
            known[number] = columns
            if store is not None:
                store.keep(number, columns)
            begin(f"{sweep.grid.size} poses")

        try:
            return _run(sweep, workers, scheduler, known, finished), resumed
        except KeyboardInterrupt as stop:
            raise Interrupted(_what_is_kept(store, sweep)) from stop


def _run(
    sweep: "Sweep",
    workers: int,
    scheduler: str | None,
    known: "dict[int, Columns]",
    finished: "Callable[[int, Columns], None]",
) -> "Columns":
    """Columns over the grid. Where a worker dies, what `known` does not hold by then is given to new ones.

    Raises
    ------
    CdprError : workers died again and again, or a cluster gave up.
    """
    for _ in range(_LIVES):
        with executor(workers, scheduler) as pool:
            try:
                return sweep.run(pool, dict(known), finished)
            except BrokenExecutor:
                continue
            except Exception as error:
                if type(error).__module__.partition(".")[0] != "distributed":
                    raise
                what = f"{type(error).__name__}: {error}".replace("\n", " ")
                raise CdprError(f"the cluster of {scheduler} gave up ({what}); finished chunks are kept") from error
    raise CdprError(
        f"worker processes were ended from outside {_LIVES} times (is there enough memory?); give fewer --workers"
    )


def clear_checkpoint(sweep: "Sweep", directory: Path | None) -> None:
    """Forget the chunks of a sweep whose result is written."""
    if directory is not None:
        Checkpoint(directory, sweep.fingerprint).clear()


def _what_is_kept(store: Checkpoint | None, sweep: "Sweep") -> str:
    if store is None:
        return "interrupted; nothing was written (with --out, finished poses are kept)"
    kept = len(store.chunks(sweep.chunks))
    return f"interrupted; {kept} of {sweep.chunks} chunks are kept, the same command continues"

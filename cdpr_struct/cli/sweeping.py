"""Running a sweep from the command line: executor, progress bar, checkpoint."""

from pathlib import Path
from typing import TYPE_CHECKING

from cdpr_struct.cli.checkpoint import Checkpoint
from cdpr_struct.cli.executors import executor
from cdpr_struct.cli.interruption import Interrupted
from cdpr_struct.cli.output import Output

if TYPE_CHECKING:
    from cdpr_struct.workspace.quantities import Columns
    from cdpr_struct.workspace.sweep import Sweep


def run_sweep(sweep: "Sweep", workers: int, scheduler: str | None, output: Output) -> "tuple[Columns, int]":
    """Columns over the grid, and how many chunks came from an earlier, interrupted run in the same directory."""
    store = None if output.directory is None else Checkpoint(output.directory, sweep.fingerprint)
    known = {} if store is None else store.chunks(sweep.chunks)
    left = sweep.chunks - len(known)
    with executor(workers, scheduler) as pool, output.steps(left) as begin:
        begin(f"{sweep.grid.size} poses")

        def finished(number: int, columns: "Columns") -> None:
            if store is not None:
                store.keep(number, columns)
            begin(f"{sweep.grid.size} poses")

        try:
            columns = sweep.run(pool, known, finished)
        except KeyboardInterrupt as stop:
            raise Interrupted(_what_is_kept(store, sweep)) from stop
    return columns, len(known)


def clear_checkpoint(sweep: "Sweep", directory: Path | None) -> None:
    """Forget the chunks of a sweep whose result is written."""
    if directory is not None:
        Checkpoint(directory, sweep.fingerprint).clear()


def _what_is_kept(store: Checkpoint | None, sweep: "Sweep") -> str:
    if store is None:
        return "interrupted; nothing was written (with --out, finished poses are kept)"
    kept = len(store.chunks(sweep.chunks))
    return f"interrupted; {kept} of {sweep.chunks} chunks are kept, the same command continues"

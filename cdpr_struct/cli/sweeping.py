"""Long work from the command line: executor, progress bar, checkpoint."""

from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from cdpr_struct.cli.checkpoint import Checkpoint
from cdpr_struct.cli.executors import Where, executor
from cdpr_struct.cli.interruption import Interrupted
from cdpr_struct.cli.output import Output
from cdpr_struct.errors import CdprError

if TYPE_CHECKING:
    from cdpr_struct.workspace.pose_batches import PoseBatches
    from cdpr_struct.workspace.work_list import Columns, WorkList

Part = TypeVar("Part")
_LIVES = 3  # pools of workers that one run may use up


def run_batches(batches: "PoseBatches", where: Where, output: Output) -> "tuple[Columns, int]":
    """Columns over all poses, and how many batches came from an earlier, interrupted run in the same directory."""
    found, resumed = run_work(batches, where, output, lambda number, columns: columns)
    return batches.joined(found), resumed


def run_work(
    work: "WorkList[Part]", where: Where, output: Output, kept: "Callable[[int, Part], Columns]"
) -> "tuple[dict[int, Columns], int]":
    """What is kept of all parts, by number, and how many came from an earlier, interrupted run in the same directory.

    kept : called with number and result of each part as it is done; may write files; what it returns is kept
    """
    store = None if output.directory is None else Checkpoint(output.directory, work.fingerprint)
    names = [work.key(number) for number in range(work.parts)]
    known = {} if store is None else store.parts(names)
    resumed = len(known)
    with output.steps(work.parts - resumed) as begin:
        begin(work.about)

        def finished(number: int, part: Part) -> None:
            known[number] = kept(number, part)
            if store is not None:
                store.keep(names[number], known[number])
            begin(work.about)

        try:
            _run(work, where, known, finished)
        except KeyboardInterrupt as stop:
            raise Interrupted(_what_is_kept(store, names)) from stop
    return known, resumed


def _run(
    work: "WorkList[Part]", where: Where, known: "dict[int, Columns]", finished: "Callable[[int, Part], None]"
) -> None:
    """Compute what `known` does not hold. Where a worker dies, what is missing by then is given to new ones.

    Raises
    ------
    CdprError : workers died again and again, or a cluster gave up.
    """
    from cdpr_struct.workspace import work_list

    for _ in range(_LIVES):
        with executor(*where) as pool:
            try:
                missing = [number for number in range(work.parts) if number not in known]
                work_list.run_parts(work, pool, missing, finished)
                return
            except BrokenExecutor:
                continue
            except Exception as error:
                if type(error).__module__.partition(".")[0] != "distributed":
                    raise
                what = f"{type(error).__name__}: {error}".replace("\n", " ")
                raise CdprError(f"the cluster of {where[1]} gave up ({what:.300}). {_AGAIN}") from error
    raise CdprError(
        f"worker processes were ended from outside {_LIVES} times (too little memory, for instance). {_AGAIN}"
    )


_AGAIN = "With --out, finished parts are kept and the same command continues"


def clear_checkpoint(work: "WorkList[Any]", directory: Path | None) -> None:
    """Forget the parts of work whose result is written."""
    if directory is not None:
        Checkpoint(directory, work.fingerprint).clear()


def _what_is_kept(store: Checkpoint | None, names: list[str]) -> str:
    if store is None:
        return "interrupted; nothing was written (with --out, finished parts are kept)"
    return f"interrupted; {len(store.parts(names))} of {len(names)} parts are kept, the same command continues"

"""Progress bars on stderr."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Begin = Callable[[str], None]
"""To be called with the name of the step that begins."""


@contextmanager
def steps(total: int) -> Iterator[Begin]:
    """A bar of `total` steps; call what it yields with the name of the step that begins.

    It is there from the first step on, so that complaints about input stand alone, and vanishes when done.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    task = bar.add_task("starting", total=total, start=False)
    begun = False

    def begin(name: str) -> None:
        nonlocal begun
        if not begun:
            bar.start()
            bar.start_task(task)
        bar.update(task, description=name, advance=1 if begun else 0)
        begun = True

    try:
        yield begin
    finally:
        if begun:
            bar.stop()


def silent(name: str) -> None:
    """A step that nobody is told of."""

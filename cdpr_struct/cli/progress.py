"""Progress bars on stderr."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Begin = Callable[[str], None]
"""To be called with the name of the step that begins."""


@contextmanager
def steps(total: int) -> Iterator[Begin]:
    """A bar of `total` steps; call what it yields with the name of the step that begins. Vanishes when done."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starting", total=total)
        begun = False

        def begin(name: str) -> None:
            nonlocal begun
            bar.update(task, description=name, advance=1 if begun else 0)
            begun = True

        yield begin


def silent(name: str) -> None:
    """A step that nobody is told of."""

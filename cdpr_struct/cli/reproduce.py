"""`cdpr-struct reproduce`: thesis tables and figures, printed value beside ours."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.output import Output

NAME = "reproduce"
EXAMPLES = (
    "cdpr-struct reproduce table-2.2 table-2.3",
    "cdpr-struct reproduce table-2.4 --out results/thesis",
)


def run(
    items: Annotated[list[str] | None, typer.Argument(metavar="[ITEM ..]", help="Default: all items.")] = None,
    *,
    output: Output,
) -> int:
    """Recompute tables and figures of the thesis and show the deviations."""
    from cdpr_struct.thesis.catalogue import ITEMS

    with output.steps(len(set(items or ITEMS))) as progress:
        found = cs.reproduce(*(items or ()), progress=progress)
    output.give(found)
    return 0

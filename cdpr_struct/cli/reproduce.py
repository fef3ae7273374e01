"""`cdpr-struct reproduce`: thesis tables and figures, printed value beside ours."""

from typing import Annotated

import typer

from cdpr_struct.cli.output import Output
from cdpr_struct.errors import InputError

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
    from cdpr_struct.reports import reproduce_page as report
    from cdpr_struct.thesis.catalogue import ITEMS

    names = list(dict.fromkeys(items or ITEMS))
    for name in names:
        if name not in ITEMS:
            raise InputError("ITEM", "", name, f"one of: {', '.join(ITEMS)}")
    found = []
    with output.steps(len(names)) as begin:
        for name in names:
            begin(name)
            found.append(ITEMS[name]())
    result = {"items": [report.reproduction_json(item) for item in found]}
    output.deliver(
        result,
        lambda: "\n\n".join(report.reproduction_text(item) for item in found),
        lambda: report.reproduction_files(found),
    )
    return 0

"""`cdpr-struct reproduce`: thesis tables and figures, printed value beside ours."""

from typing import Annotated

import typer

from cdpr_struct.cli.options import Json, Out
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.cli.progress import steps
from cdpr_struct.errors import InputError

NAME = "reproduce"


def run(
    items: Annotated[list[str] | None, typer.Argument(metavar="[ITEM ..]", help="Default: all items.")] = None,
    out: Out = None,
    json: Json = False,
) -> int:
    """Recompute tables and figures of the thesis and show the deviations."""
    from cdpr_struct.reports import reproduce_page as report
    from cdpr_struct.thesis.catalogue import ITEMS

    names = list(dict.fromkeys(items or ITEMS))
    for name in names:
        if name not in ITEMS:
            raise InputError("ITEM", "", name, f"one of: {', '.join(ITEMS)}")
    found = []
    with steps(len(names)) as begin:
        for name in names:
            begin(name)
            found.append(ITEMS[name]())
    result = {"items": [report.reproduction_json(item) for item in found]}
    if out is not None:
        write_files(out, {"result.json": result_json(result), **report.reproduction_files(found, items or [])})
    emit(result, json, lambda: print("\n\n".join(report.reproduction_text(item) for item in found)))
    return 0

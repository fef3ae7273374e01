"""`cdpr-struct reproduce`: thesis tables, printed value beside ours."""

from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.cli.options import Json, Out
from cdpr_struct.cli.output import emit, result_json, write_files
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.thesis.reproduction import Reproduction

NAME = "reproduce"


def run(
    items: Annotated[list[str] | None, typer.Argument(metavar="[ITEM ..]", help="Default: all items.")] = None,
    out: Out = None,
    json: Json = False,
) -> int:
    """Recompute tables of the thesis and show the deviations."""
    from cdpr_struct.thesis.catalogue import ITEMS

    for name in items or ():
        if name not in ITEMS:
            raise InputError("ITEM", "", name, f"one of: {', '.join(ITEMS)}")
    found = [ITEMS[name]() for name in items or ITEMS]
    result = {"items": [_json(item) for item in found]}
    emit(result, json, lambda: print("\n\n".join(_text(item) for item in found)))
    if out is not None:
        write_files(out, {"result.json": result_json(result)} | {f"{i.id}.csv": _csv(i) for i in found})
    return 0


def _json(item: "Reproduction") -> dict[str, object]:
    worst = item.worst
    return {
        "id": item.id,
        "title": item.title,
        "cells": [
            {"row": c.row, "column": c.column, "printed": float(c.printed), "ours": c.ours, "within": c.within_print}
            for c in item.cells
        ],
        "within_tolerance": item.within_tolerance,
        "worst": {"row": worst.row, "column": worst.column, "printed": float(worst.printed), "ours": worst.ours},
        "note": item.note,
    }


def _text(item: "Reproduction") -> str:
    from cdpr_struct.reports.text import plain_table

    rows = [
        [c.row, c.column, c.printed, f"{c.ours:.6g}", f"{c.deviation:+.2g}", "" if c.within_print else "differs"]
        for c in item.cells
    ]
    title = f"{item.id}: {item.title} ({item.within_tolerance} of {len(item.cells)} round to the printed number)"
    return plain_table(title, ["", "", "printed", "ours", "deviation", ""], rows) + "\n" + item.note


def _csv(item: "Reproduction") -> str:
    lines = ["row,column,printed,ours,within"]
    lines += [f'"{c.row}",{c.column},{c.printed},{c.ours!r},{int(c.within_print)}' for c in item.cells]
    return "\n".join(lines) + "\n"

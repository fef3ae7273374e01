"""Reproduced thesis items: result, text, CSV, figures and the page with printed beside ours."""

from collections.abc import Sequence
from typing import Any

from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.reproductions import FIGURES
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import paragraphs, plain_table
from cdpr_struct.thesis.reproduction import Cell, Reproduction

_HOW = (
    "Every number is computed anew by the models of this program, with the parameters that the thesis states or, where "
    "it states none, with those named in the notes; no parameter is fitted silently. A cell agrees if ours rounds to "
    "the printed number, or deviates by less than the tolerance where one is stated.",
    "`converged`: where the thesis's number is an average over a coarse grid, the limit for finer grids.",
)


def reproduction_json(item: Reproduction) -> dict[str, Any]:
    """Result of one item."""
    return {
        "id": item.id,
        "title": item.title,
        "cells": [_cell_json(cell) for cell in item.cells],
        "within_tolerance": item.within_tolerance,
        "worst": _cell_json(item.worst) if item.cells else None,
        "statements": [{"thesis": s.text, "ours": s.ours, "holds": s.holds} for s in item.statements],
        "note": item.note,
    }


def reproduction_text(item: Reproduction) -> str:
    """One item for a terminal."""
    beside = any(cell.converged is not None for cell in item.cells)
    columns = ["", "", "printed", "ours", "deviation", *(["converged"] if beside else []), ""]
    said = [f"{'as printed' if s.holds else 'DIFFERS'}: {s.text}. Ours: {s.ours}." for s in item.statements]
    rows = [_row(cell, beside, "differs") for cell in item.cells]
    table = plain_table(_headline(item), columns, rows) if rows else _headline(item)
    return paragraphs("\n".join([table, *said]), item.note)


def reproduction_files(items: Sequence[Reproduction]) -> dict[str, str | bytes]:
    """CSV, figures and page."""
    files: dict[str, str | bytes] = {f"{item.id}.csv": csv_text(cell_columns(item)) for item in items}
    files |= {f"{item.id}-data.csv": csv_text(item.columns) for item in items if item.columns}
    plates = [_plate(item) for item in items if item.id in FIGURES]
    return {**files, **page_files(_page(items, plates))}


def _page(items: Sequence[Reproduction], plates: list[Plate]) -> Page:
    cells = sum(len(item.cells) for item in items)
    good = sum(item.within_tolerance for item in items)
    said = [s for item in items for s in item.statements]
    return Page(
        title="The thesis, recomputed",
        subtitle="Yuan, Static and Dynamic Stiffness Analysis of Cable-Driven Parallel Robots; printed beside ours",
        verdict=reproduction_sentences(items),
        holds=all(item.holds for item in items),
        facts=[
            (str(len(items)), "tables and figures"),
            (f"{good} of {cells}", "numbers within tolerance"),
            (f"{sum(s.holds for s in said)} of {len(said)}", "statements confirmed"),
        ],
        plates=plates,
        tables=[*(_table(item) for item in items), *_statements(items)],
        notes=[*((item.id, (item.note,)) for item in items), ("How to read this", _HOW)],
    )


def reproduction_sentences(items: Sequence[Reproduction]) -> list[str]:
    """How many items agree with the print, and which do not."""
    met = [item.id for item in items if item.holds]
    other = [item.id for item in items if not item.holds]
    first = f"{len(met)} of {len(items)} items agree with the print in every number and statement."
    return [first, *([f"Deviations, explained in the notes: {', '.join(other)}."] if other else [])]


def _plate(item: Reproduction) -> Plate:
    draw, size, caption = FIGURES[item.id]
    name = item.id.replace("-", "_").replace(".", "_")
    return Plate(name, f"{item.id}: {item.title}", Drawing(name, size, lambda f: draw(f, item)), caption(item))


def _table(item: Reproduction) -> HtmlTable:
    beside = any(cell.converged is not None for cell in item.cells)
    columns = ["", "", "printed", "ours", "deviation", *(["converged"] if beside else []), ""]
    marked = frozenset(i for i, cell in enumerate(item.cells) if not cell.within)
    return HtmlTable(_headline(item), columns, [_row(cell, beside, "differs") for cell in item.cells], "", marked)


def _statements(items: Sequence[Reproduction]) -> list[HtmlTable]:
    rows = [(item.id, s) for item in items for s in item.statements]
    if not rows:
        return []
    marked = frozenset(i for i, (_, s) in enumerate(rows) if not s.holds)
    text = [[name, s.text, s.ours, "" if s.holds else "differs"] for name, s in rows]
    return [HtmlTable("What the thesis says in words", ["", "thesis", "ours", ""], text, "", marked)]


def _headline(item: Reproduction) -> str:
    if not item.cells:
        return f"{item.id}: {item.title}"
    stated = {cell.tolerance for cell in item.cells}
    how = "round to the printed number" if stated == {None} else f"are within {max(c.allowed for c in item.cells):g}"
    return f"{item.id}: {item.title} ({item.within_tolerance} of {len(item.cells)} {how})"


def _row(cell: Cell, beside: bool, mark: str) -> list[str]:
    extra = ["" if cell.converged is None else f"{cell.converged:.6g}"] if beside else []
    ours = [cell.row, cell.column, cell.printed, f"{cell.ours:.6g}", f"{cell.deviation:+.2g}"]
    return [*ours, *extra, "" if cell.within else mark]


def _cell_json(cell: Cell) -> dict[str, Any]:
    return {
        "row": cell.row,
        "column": cell.column,
        "printed": float(cell.printed),
        "ours": cell.ours,
        "tolerance": cell.allowed,
        "within": cell.within,
        "converged": cell.converged,
    }


def cell_columns(item: Reproduction) -> dict[str, Any]:
    """Columns of an item's CSV file, one row a number of the thesis."""
    cells = item.cells
    return {
        "row": [c.row for c in cells],
        "column": [c.column for c in cells],
        "printed": [c.printed for c in cells],
        "ours": [c.ours for c in cells],
        "tolerance": [c.allowed for c in cells],
        "within": [int(c.within) for c in cells],
        "converged": [float("nan") if c.converged is None else c.converged for c in cells],
    }

"""The files of a robot's sensitivities: tables as CSV, the tornado, the report page."""

from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import tornado
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.sensitivity_told import effects, raise_rows, row_columns, sensitivity_sentences, shares_table

_HOW = (
    "Rates are first derivatives at rest with the winches locked: a change moves platform and tensions, and all of "
    "it counts. Modes at the same frequency have the rates of their mean.",
    "Changes of a design (--raise) hold the pose instead: the cables are wound anew, with the tensions of least norm, "
    "and each frequency given was computed again with the changed robot.",
)


def sensitivity_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name."""
    drawn = Drawing("tornado", tornado.SIZE, lambda figure: tornado.draw_tornado(figure, result))
    own = result["shares"][result["mode"] - 1]
    page = Page(
        robot=result["robot"],
        title=f"{result['robot']}: what moves its frequencies",
        subtitle=f"cable model {result['model']}, assembly {result['assembly']}; winches locked",
        verdict=sensitivity_sentences(result),
        holds=True,
        facts=[
            (f"{result['frequencies_hz'][result['mode'] - 1]:.4g} Hz", f"mode {result['mode']}"),
            (str(own["sigma"]), "its sigma within the tolerances"),
        ],
        plates=[Plate("tornado", "What moves the predictions", drawn, tornado.CAPTION)],
        tables=_tables(result),
        notes=[("How it was computed", _HOW)],
    )
    rows = {f"{name}.csv": csv_text(row_columns(result[name])) for name in ("frequencies", "poses", "tensions")}
    return {**rows, **page_files(page)}


def _tables(result: Mapping[str, Any]) -> list[HtmlTable]:
    names, rows = effects(result)
    columns, shares = shares_table(result)
    tables = [
        HtmlTable("Change of the frequencies [%]", names, rows, prose=frozenset({0})),
        HtmlTable("Share of the variance [%] by tolerance", columns, shares, prose=frozenset({0, 1})),
    ]
    if raised := result.get("raise"):
        title = f"Mode {raised['mode']} from {raised['from_hz']:.5g} to {raised['to_hz']:.5g} Hz, the pose held"
        tables.insert(0, HtmlTable(title, ["change of", "by"], raise_rows(raised), prose=frozenset({0, 1})))
    return tables

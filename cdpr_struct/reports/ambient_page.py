"""The files of ambient records: tables as CSV, stabilisation diagrams, and the report page."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.measurement.ambient_records import AmbientRecord
from cdpr_struct.reports.ambient_result import HEAD, ambient_sentences, frequency_columns, mode_columns, mode_rows
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import ambient as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files

_MOST_PLATES = 6
_METHOD = (
    "Modes: stochastic subspace identification from covariances (pyOMA-2, SSI-cov) at model orders up to 100. "
    "Poles that continue from order to order with nearly the same frequency, damping and shape are one mode. A "
    "mode is kept if it is stable over 30 % of the orders or more, is found in both halves of the record and in most "
    "records without one block, and if its frequency is known to 1 % or better.",
    "Sigma: jackknife over 20 blocks of the record, larger where the halves of the record differ by more. Orders "
    "are averaged with the weights of their own scatter.",
)
_DIAGRAM = (
    "Poles over the model order (right). Blue: poles of the chosen modes, which stay where they are as the order "
    "grows. Orange rings: poles that continue from order to order but were not chosen. Crosses: poles of one "
    "order. Grey lines (left): largest singular values of the spectral density. Look for peaks of the upper line "
    "without a column of blue poles: such a mode was not found. Two columns under one peak are two modes if the "
    "second line has a peak there, too. Light bands: two sigma."
)
_TABLE = (
    "Orders: at how many model orders the mode is stable. Halves apart: frequency in the second half of the "
    "record less that in the first, in sigmas. robot_frequency.csv holds these frequencies as measured data."
)


def ambient_files(result: Mapping[str, Any], records: Sequence[AmbientRecord]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name."""
    return {
        "modes.csv": csv_text(mode_columns(result)),
        "robot_frequency.csv": csv_text(frequency_columns(result)),
        "diagram.csv": csv_text(diagram_columns(records)),
        **page_files(_page(result, records)),
    }


def diagram_columns(records: Sequence[AmbientRecord]) -> dict[str, Any]:
    """Columns of diagram.csv, one row a pole; mode 0: of none."""
    parts = [r.diagram for r in records]
    empty = np.zeros(0)
    return {
        "case": [r.case for r in records for _ in r.diagram.order],
        "order": np.concatenate([empty, *(p.order for p in parts)]).astype(int),
        "frequency_hz": np.concatenate([empty, *(p.hertz for p in parts)]),
        "damping_ratio": np.concatenate([empty, *(p.damping for p in parts)]),
        "stable": np.concatenate([empty, *(p.stable for p in parts)]).astype(int),
        "mode": np.concatenate([empty, *(p.chosen + 1 for p in parts)]).astype(int),
    }


def ambient_plates(records: Sequence[AmbientRecord]) -> list[Plate]:
    """Stabilisation diagrams of the first records."""
    return [_plate(f"stabilisation_{i + 1}", record) for i, record in enumerate(records[:_MOST_PLATES])]


def _plate(name: str, record: AmbientRecord) -> Plate:
    return Plate(
        name,
        f"Stabilisation diagram of {record.case}",
        Drawing(name, figures.SIZE, lambda f: figures.draw_stabilisation(f, record)),
        _DIAGRAM,
    )


def _page(result: Mapping[str, Any], records: Sequence[AmbientRecord]) -> Page:
    modes = [mode for one in result["records"] for mode in one["modes"]]
    share = [mode["sigma_hz"] / mode["frequency_hz"] for mode in modes]
    return Page(
        robot=result["robot"],
        title=f"{result['robot']}: modes in ambient records",
        subtitle=f"{len(records)} records of {result['campaign']}",
        verdict=ambient_sentences(result),
        holds=bool(modes),
        facts=[
            (str(len(modes)), "modes"),
            (f"{100.0 * float(np.median(share)):.2g} %" if share else "none", "median sigma of the frequencies"),
        ],
        plates=ambient_plates(records),
        tables=[HtmlTable("Modes", HEAD, mode_rows(result), _TABLE)],
        notes=[("How it was computed", _METHOD)],
    )

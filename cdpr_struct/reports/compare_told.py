"""Readings against their bands: keys of result.json, table, CSV, page."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.bands.compared import Compared
from cdpr_struct.measurement.compared_readings import Reading
from cdpr_struct.reports.bands_told import band_note
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import paragraphs, plain_table

DOUBTFUL = 0.01
"""Probability of readings as far off as these below which tolerances and noise do not explain them."""
_NAMES = ["reading", "measured", "predicted", "band", "off [sigmas]", ""]


def compare_json(
    readings: Sequence[Reading], numbers: np.ndarray, predicted: np.ndarray, found: Compared
) -> dict[str, Any]:
    """What was read and predicted, one row a reading, and the verdict on all."""
    rows = [
        {
            "reading": one.column,
            "line": one.line,
            "mode": int(numbers[i]) if one.column == "frequency_hz" else None,
            "assigned": one.column == "frequency_hz" and one.number == 0,
            "cable": int(numbers[i]) if one.column == "tension_N" else None,
            "measured": one.measured,
            "sigma": one.sigma,
            "predicted": predicted[i],
            "band": [found.low[i], found.high[i]],
            "inside": bool(found.inside[i]),
            "off_sigmas": found.sigmas[i],
        }
        for i, one in enumerate(readings)
    ]
    together = {"p_value": found.p_value, "agrees": found.p_value >= DOUBTFUL, "inside": int(found.inside.sum())}
    return {"readings": rows, **together}


def words_of(row: Mapping[str, Any]) -> str:
    """Which reading, in words."""
    if row["mode"] is not None:
        return f"mode {row['mode']}{' (nearest)' if row['assigned'] else ''} [Hz]"
    if row["cable"] is not None:
        return f"tension {row['cable']} [N]"
    name, unit = row["reading"].rsplit("_", 1)
    return f"{name} [{unit}]"


def _rows(result: Mapping[str, Any]) -> list[list[str]]:
    return [
        [
            words_of(row), f"{row['measured']:.5g}", f"{row['predicted']:.5g}",
            f"{row['band'][0]:.5g} .. {row['band'][1]:.5g}", f"{row['off_sigmas']:+.1f}",
            "inside" if row["inside"] else "OUTSIDE",
        ]
        for row in result["readings"]
    ]  # fmt: skip


def compare_sentences(result: Mapping[str, Any]) -> list[str]:
    """How many lie inside, and whether all agree."""
    count, level = len(result["readings"]), result["level"]
    first = f"{result['inside']} of {count} readings lie inside their {level:g} % bands."
    p = result["p_value"]
    chance = f"{p:.2g}" if p >= 1e-9 else "below 1e-9"
    if result["agrees"]:
        return [first, f"Together they agree with the robot within its tolerances (p = {chance})."]
    worst = max(result["readings"], key=lambda row: abs(row["off_sigmas"]))
    return [
        first,
        f"Together they do NOT agree with the robot within its tolerances (p = {chance}); furthest off by itself is "
        f"{words_of(worst)}, by {worst['off_sigmas']:+.1f} sigmas. A campaign and diagnose look for the cause.",
    ]


def compare_text(result: Mapping[str, Any]) -> str:
    """Every reading with its band, and the verdict on all."""
    table = plain_table(f"{result['robot']}, {result['level']:g} % bands", _NAMES, _rows(result))
    return paragraphs(table, " ".join(compare_sentences(result)), band_note(result))


def compare_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of readings.csv, one row a reading."""
    rows = result["readings"]
    plain = ("reading", "mode", "cable", "measured", "sigma", "predicted", "off_sigmas")
    columns = {name: ["" if row[name] is None else row[name] for row in rows] for name in plain}
    ends = {f"band_{end}": [row["band"][i] for row in rows] for i, end in enumerate(("low", "high"))}
    return {**columns, **ends, "inside": [int(row["inside"]) for row in rows]}


def compare_files(result: Mapping[str, Any]) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name."""
    from cdpr_struct.reports.figures import readings_in_bands
    from cdpr_struct.reports.figures.drawing import Drawing

    draw = readings_in_bands.draw_readings
    drawn = Drawing("readings", readings_in_bands.size(result), lambda figure: draw(figure, result))
    page = Page(
        robot=result["robot"],
        title=f"{result['robot']}: measured against predicted",
        subtitle=f"cable model {result['model']}, {result['level']:g} % bands",
        verdict=compare_sentences(result),
        holds=result["agrees"],
        facts=[
            (f"{result['inside']} of {len(result['readings'])}", "readings inside their bands"),
            (f"{result['p_value']:.2g}", "probability of readings as far off, all together"),
        ],
        plates=[Plate("readings", "Readings in their bands", drawn, readings_in_bands.CAPTION)],
        tables=[HtmlTable("Readings", _NAMES, _rows(result), band_note(result), prose=frozenset({0, 5}))],
        notes=[("How it was judged", (_HOW,))],
    )
    return {"readings.csv": csv_text(compare_columns(result)), **page_files(page)}


_HOW = (
    "Bands hold tolerances of the robot and noise of the sensor, each reading by itself. The verdict is about all "
    "readings together, by their joint covariance: readings of one robot share its errors, so that several may lie "
    "outside for one reason, or all inside and still contradict each other."
)

"""Bands of a pose error: keys of result.json, table, columns, plate of the page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.bands.drawn_robots import DrawnRobots
from cdpr_struct.bands.pose_error_bands import PARTS, PoseErrorBands
from cdpr_struct.reports.bands_told import band_note, differing, samples_told, words_of_band
from cdpr_struct.reports.figures import pose_error_bands as figure
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Plate
from cdpr_struct.reports.text import plain_table, rounded

_LENGTHS = PARTS[:3]
NAMES = (
    *(f"{part}_{axis}_mm" for part in _LENGTHS for axis in "xyz"),
    *(f"global_r{axis}_deg" for axis in "xyz"),
    *(f"{part}_mm" for part in _LENGTHS),
    "global_turn_deg",
)
"""Of the numbers of `PoseErrorBands`; those of components are columns of pose_error.csv."""
_WORDS = {"global": "whole error", "axial": "from stretch", "sag": "from sag"}
_SIZES = ("mm", "turn")
_DIGITS = 3


def pose_error_bands_told(
    entered: np.ndarray, found: PoseErrorBands, errors: np.ndarray | None, drawn: DrawnRobots | None, level: float
) -> dict[str, Any]:
    """Bands of errors [mm, deg] by name.

    entered : (16,) errors of the robot as entered;  errors : (n, 16) of drawn robots, if there are any
    """
    scale = np.array([1e3 if name.endswith("_mm") else np.degrees(1.0) for name in NAMES])
    value, sigma, band = scale * entered, scale * found.sigma, scale[:, None] * found.band
    rows = {
        name: {"value": value[i], "band": band[i], "sigma": sigma[i]} for i, name in enumerate(NAMES)
    }  # fmt: skip
    if errors is None or drawn is None:
        return {"errors": rows}
    ends = scale[:, None] * np.quantile(errors, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0).T
    for i, name in enumerate(NAMES):
        rows[name]["drawn"] = ends[i]
    differ = [NAMES[number - 1] for number in differing(band, ends)]
    return {"errors": rows, "samples": samples_told(drawn) | {"differ": differ}}


def pose_error_bands_text(bands: Mapping[str, Any]) -> list[str]:
    """Table and note for a terminal."""
    return [plain_table("Pose error within the tolerances", *_rows(bands)), band_note(bands)]


def pose_error_bands_table(bands: Mapping[str, Any]) -> HtmlTable:
    """The same for the page."""
    return HtmlTable("Pose error within the tolerances", *_rows(bands), band_note(bands))


def pose_error_bands_columns(bands: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Columns of pose_error.csv, one row: the size of the error, and ends and sigma of every band."""
    columns = {name: row["value"] for name, row in bands["errors"].items() if _is_size(name)}
    for name, row in bands["errors"].items():
        what, _, unit = name.rpartition("_")
        told = {"low": row["band"][0], "high": row["band"][1], "sigma": row["sigma"]}
        columns |= {f"{what}_{end}_{unit}": value for end, value in told.items()}
    return {name: np.array([value]) for name, value in columns.items()}


def pose_error_bands_plate(bands: Mapping[str, Any]) -> Plate:
    """The picture of the bands on the page."""
    drawn = Drawing("bands", figure.SIZE, lambda empty: figure.draw_bands(empty, bands))
    return Plate("bands", "Pose error within the tolerances", drawn, figure.caption(bands))


def _is_size(name: str) -> bool:
    return name.split("_")[1] in _SIZES


def _rows(bands: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    differ = bands.get("samples", {}).get("differ", ())
    rows = []
    for name, row in bands["errors"].items():
        starred = name in differ
        inside = words_of_band(row["drawn"] if starred else row["band"], _DIGITS, starred)
        rows.append(
            [_words(name), f"{rounded((row['value'],), _DIGITS)[0]:+.{_DIGITS}f}", inside, f"{row['sigma']:.3g}"]
        )
    return ["", "as entered", f"{bands['level']:g} % band", "sigma"], rows


def _words(name: str) -> str:
    """`global_x_mm` as "whole error, x [mm]"."""
    part, *axis, unit = name.split("_")
    about = axis[0] if axis else "length"
    return f"{_WORDS[part]}, {about} [{'mm' if unit == 'mm' else '°'}]"

"""Bands of curves, frequency responses and vibrations: keys of result.json, table, CSV, plate of the page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.bands.drawn_curves import CurveBands, thinned_lines
from cdpr_struct.dynamics.frequency_sweep import ResponseSweep
from cdpr_struct.dynamics.vibration_record import VibrationRecord
from cdpr_struct.measurement.universal_file import response_unit
from cdpr_struct.reports.bands_told import band_note, words_of_band
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures.curve_bands import ShownCurves, caption, draw_curve_bands
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Plate
from cdpr_struct.reports.text import plain_table
from cdpr_struct.reports.trust import Check

_TITLE = "Largest values within the tolerances"


def response_curves(sweep: ResponseSweep, bands: CurveBands) -> ShownCurves:
    """Magnitudes of frequency responses."""
    found = sweep.evenly
    names = [port.name for port in found.respond]
    units = [response_unit(port, found.excite, found.quantity) for port in found.respond]
    entered = np.where(sweep.silent[:, None], 0.0, np.abs(found.response[thinned_lines(found.hertz)]).T)
    return ShownCurves(names, units, "frequency [Hz]", entered, bands, True)


def vibration_curves(record: VibrationRecord, bands: CurveBands) -> ShownCurves:
    """Displacements of all ports over time."""
    moved = record.vibration.displacement[thinned_lines(record.vibration.time)].T
    units = ["rad" if port.turns else "m" for port in record.ports]
    return ShownCurves([port.name for port in record.ports], units, "time [s]", moved, bands, False)


def curve_bands_told(shown: ShownCurves) -> dict[str, Any]:
    """The largest size of every curve and where it is; the curves themselves are in the CSV file."""
    bands = shown.bands
    place = "largest_at_s" if shown.along.startswith("time") else "largest_at_hz"
    size = np.abs(shown.entered).max(axis=1)
    return {
        "samples": {"count": bands.count + bands.lost, "not_stable": bands.lost},
        "lines": len(bands.place),
        "curves": [
            {"name": name, "unit": unit, "as_entered": size[i], "largest": bands.largest[i], place: bands.largest_at[i]}
            for i, (name, unit) in enumerate(zip(shown.names, shown.units, strict=True))
        ],
    }


def curve_checks(bands: CurveBands) -> list[Check]:
    """Whether all drawn robots came to rest."""
    said = "robots within the tolerances do not rest near this pose at these lengths; their share is left out"
    return [Check.of("drawn robots without a stable rest", bands.lost, 0.0, said if bands.lost else None)]


def curve_bands_text(bands: Mapping[str, Any]) -> list[str]:
    """Table and note for a terminal."""
    return [plain_table(_TITLE, *_rows(bands)), band_note(bands)]


def curve_bands_table(bands: Mapping[str, Any]) -> HtmlTable:
    """The same for the page."""
    return HtmlTable(_TITLE, *_rows(bands), band_note(bands))


def curve_bands_csv(shown: ShownCurves, port: str) -> str:
    """One row a place and curve; port : name of the column that says which curve."""
    bands, along = shown.bands, "time_s" if shown.along.startswith("time") else "frequency_hz"
    columns: dict[str, Any] = {along: np.tile(bands.place, len(shown.names))}
    columns[port] = np.repeat(shown.names, len(bands.place))
    parts = {"as_entered": shown.entered, "low": bands.low, "median": bands.middle, "high": bands.high}
    return csv_text(columns | {name: part.ravel() for name, part in parts.items()})


def curve_bands_plate(shown: ShownCurves, level: float) -> Plate:
    """The picture on the page; level [%]."""
    drawn = Drawing("bands", shown.size, lambda figure: draw_curve_bands(figure, shown))
    what = "instant" if shown.along.startswith("time") else "frequency"
    return Plate("bands", "Within the tolerances", drawn, caption(level, shown.bands.count, what))


def _rows(bands: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    rows = []
    at = "largest_at_s" if "largest_at_s" in bands["curves"][0] else "largest_at_hz"
    for curve in bands["curves"]:
        low, high = curve["largest"]
        rows.append(
            [
                f"{curve['name']} [{curve['unit']}]",
                f"{curve['as_entered']:.4g}",
                f"{low:.4g} .. {high:.4g}",
                words_of_band(curve[at], 3),
            ]
        )
    level = f"{bands['level']:g} % band"
    return ["", "as entered", level, f"{level} of where [{'s' if at.endswith('_s') else 'Hz'}]"], rows

"""The files of a frequency response: CSV, universal file, figure and the report page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.frequency_sweep import ResponseSweep
from cdpr_struct.measurement.universal_file import universal_file
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.curve_bands_told import curve_bands_csv, curve_bands_plate, curve_bands_table
from cdpr_struct.reports.figures import frf
from cdpr_struct.reports.figures.curve_bands import ShownCurves
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.interactive_frf import frf_plot
from cdpr_struct.reports.frf_result import frf_columns
from cdpr_struct.reports.frf_text import RATIO, SILENT, WIDTH, frf_summary, peak_rows
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files


def frf_files(
    sweep: ResponseSweep, result: Mapping[str, Any], within: ShownCurves | None = None
) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name; `result` as `frf_json` gives it, `within` if there are bands."""
    plate = Plate(
        "frf",
        "Frequency response",
        Drawing("frf", frf.SIZE, lambda figure: frf.draw_frf(figure, sweep)),
        frf.frf_caption(sweep),
        frf_plot(sweep),
    )
    plates = [plate] if within is None else [plate, curve_bands_plate(within, result["bands"]["level"])]
    return {
        **({} if within is None else {"frf_band.csv": curve_bands_csv(within, "respond")}),
        "frf.csv": csv_text(frf_columns(sweep)),
        "frf.uff": response_file(sweep, result),
        "modes.csv": csv_text({"frequency_hz": sweep.modes.hertz, "kind": sweep.modes.kinds}),
        **page_files(_page(sweep, result, plates)),
    }


def response_file(sweep: ResponseSweep, result: Mapping[str, Any]) -> bytes:
    """The even lines as a universal file: its format gives a frequency six digits, too few for narrow peaks."""
    axes = sweep.point.rotation if result["frame"] == "platform" else np.eye(3)
    return universal_file(sweep.evenly, sweep.point.entered.name, axes)


def _page(sweep: ResponseSweep, result: Mapping[str, Any], plates: list[Plate]) -> Page:
    robot, (x, y, z) = sweep.point.entered, sweep.point.position
    return Page(
        robot=robot.name,
        title=f"{robot.name}: frequency response",
        subtitle=(
            f"{result['quantity']} under {result['excite']}; {len(robot.cables)} cables, platform "
            f"{robot.platform.mass:g} kg at ({x:.4g}, {y:.4g}, {z:.4g}) m; cable model {result['model']}, damping "
            f"{result['damping']}"
        ),
        verdict=[frf_summary(result), result["damping_note"]],
        holds=bool(result["count_certified"]),
        facts=[
            (f"{len(result['natural_frequencies_hz'])}", "eigenfrequencies in the band"),
            *((_highest(r), f"highest peak of {r['respond']}") for r in result["responses"]),
        ],
        plates=plates,
        tables=[
            *(_table(result, response) for response in result["responses"]),
            *([curve_bands_table(result["bands"])] if "bands" in result else []),
        ],
        notes=[("How it was computed", _NOTES)],
    )


_NOTES = (
    "H(ω) = (−ω² M + K(ω))⁻¹ of eq. (3.25) with the cables' dynamic stiffness K(ω); velocity is iω H, "
    "acceleration −ω² H (eqs 3.28, 3.29). Damping acts in the cables only and enters their stiffness before the "
    "inversion; the law and its formula are in docs/damping.md.",
    "Eigenfrequencies are those of the undamped robot, found by counting (Wittrick-Williams) and bisection, so that "
    "none is missed. Peaks are local maxima at a mode that stand out by 5 %, refined between the lines: neither "
    "frequency nor height depends on the step of the band. The half-power width lies between the frequencies on both "
    "sides at which the magnitude is that of the peak over √2; the damping ratio is width / (2 frequency), that of a "
    "single mode of this width. A dash: a neighbour or the end of the band hides a flank.",
    "Assumed: small vibrations about the rest pose, rigid platform, fixed frame anchors, winches that hold their "
    "lengths.",
)


def _highest(response: Mapping[str, Any]) -> str:
    if len(response["peaks_hz"]) == 0:
        return "none"
    if np.isinf(response["peak_magnitudes"]).any():
        return "unbounded"
    return f"{response['peaks_hz'][int(np.argmax(response['peak_magnitudes']))]:.3f} Hz"


def _table(result: Mapping[str, Any], response: Mapping[str, Any]) -> HtmlTable:
    columns = ["peak [Hz]", f"magnitude [{response['unit']}]", WIDTH, RATIO, "nearest mode [Hz]", "kind"]
    note = f"{response['respond']} {SILENT}." if response["silent"] else ""
    return HtmlTable(f"Peaks of {response['respond']}", columns, peak_rows(result, response), note)

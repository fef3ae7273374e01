"""The files of a predicted or measured vibration: CSV, figure and the report page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.vibration_record import VibrationRecord
from cdpr_struct.measurement.spectrogram import Spectrogram, spectrogram
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.curve_bands_told import curve_bands_csv, curve_bands_plate, curve_bands_table
from cdpr_struct.reports.figures import spectrogram as figure
from cdpr_struct.reports.figures.curve_bands import ShownCurves
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.interactive_vibration import vibration_plot
from cdpr_struct.reports.figures.style import Draw
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.transient_result import transient_columns
from cdpr_struct.reports.transient_text import PORT_COLUMNS, port_rows, transient_summary


def transient_files(
    record: VibrationRecord,
    result: Mapping[str, Any],
    window: float | None = None,
    within: ShownCurves | None = None,
) -> dict[str, str | bytes]:
    """Contents of every file of the report, by name; `result` as `transient_json` gives it, within : bands."""
    shown = _shown(record, window)
    drawing = Drawing("vibration", figure.SIZE, lambda f: figure.draw_vibration(f, shown))
    caption = figure.vibration_caption(shown.spectrum)
    plate = Plate("vibration", "Acceleration of the platform", drawing, caption, vibration_plot(shown))
    plates = [plate] if within is None else [plate, curve_bands_plate(within, result["bands"]["level"])]
    return {
        **({} if within is None else {"transient_band.csv": curve_bands_csv(within, "port")}),
        "transient.csv": csv_text(transient_columns(record)),
        "spectrogram.csv": spectrogram_csv(shown.spectrum, record.highest_hertz),
        "modes.csv": csv_text({"frequency_hz": record.modes.hertz, "kind": record.modes.kinds}),
        **page_files(_page(record, result, plates)),
    }


def vibration_figure(record: VibrationRecord, window: float | None = None) -> tuple[Draw, tuple[float, float]]:
    """What draws accelerations and spectrogram into an empty figure, and its size [inch]."""
    shown = _shown(record, window)
    return lambda f: figure.draw_vibration(f, shown), figure.SIZE


def _shown(record: VibrationRecord, window: float | None) -> figure.Vibration:
    time, signal = record.vibration.time, record.vibration.acceleration[:, :3]
    names = [port.name for port in record.ports[:3]]
    spectrum = spectrogram(time, signal, window)
    return figure.Vibration(time, signal, names, spectrum, record.modes, record.highest_hertz)


def spectrogram_csv(spectrum: Spectrogram, highest_hertz: float) -> str:
    """time_s, frequency_hz, density of all channels together [(m/s^2)^2/Hz]."""
    shown = spectrum.hertz <= highest_hertz
    density = spectrum.total()[shown]
    return csv_text(
        {
            "time_s": np.tile(spectrum.time, density.shape[0]),
            "frequency_hz": np.repeat(spectrum.hertz[shown], density.shape[1]),
            "density": density.ravel(),
        }
    )


def _page(record: VibrationRecord, result: Mapping[str, Any], plates: list[Plate]) -> Page:
    robot, (x, y, z) = record.point.entered, record.point.position
    summary = transient_summary(result)
    return Page(
        robot=robot.name,
        title=f"{robot.name}: vibration in time",
        subtitle=(
            f"{len(robot.cables)} cables, platform {robot.platform.mass:g} kg at ({x:.4g}, {y:.4g}, {z:.4g}) m; "
            f"cable model {result['model']}, damping {result['damping']}"
        ),
        verdict=[summary, result["damping_note"]],
        holds=bool(result["count_certified"]),
        facts=[
            (f"{result['dominant_hz']:.3f} Hz", "dominant frequency of the platform"),
            (f"{len(result['natural_frequencies_hz'])}", f"modes up to {result['highest_hz']:g} Hz"),
            (f"{100.0 * result['energy_share']:.2f} %", "of the excitation's energy held by these modes"),
        ],
        plates=plates,
        tables=[
            HtmlTable("Vibration", PORT_COLUMNS, port_rows(result)),
            *([curve_bands_table(result["bands"])] if "bands" in result else []),
        ],
        notes=[("How it was computed", _NOTES)],
    )


_NOTES = (
    "Superposition of the robot's modes, platform and cables together, with the damped (complex) modes of the given "
    "law. A law that is no differential equation in time (hysteretic, frequency-dependent) damps each mode as at its "
    "own frequency.",
    "Emergency stop: at time zero the platform has the given velocity, each piece of cable the share of it that is "
    "linear in its place along the cable, and the lengths are locked. Along a trajectory the vibration is driven by "
    "the inertia of the nominal motion, M q'' + C q' + K q = -M a(t), linearised at one pose; a trajectory that ends "
    "moving is stopped there.",
    "Assumed: small vibrations about the rest pose, rigid platform, fixed frame anchors, linear elastic cables.",
)

"""Measured accelerations beside the predicted modes: result, text and files."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel, cable_dynamics
from cdpr_struct.dynamics.frequency_sweep import ModesInBand, modes_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.measurement.spectrogram import Spectrogram, dominant_frequency, spectrogram
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import spectrogram as figure
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.figures.interactive_vibration import vibration_plot
from cdpr_struct.reports.figures.style import Draw
from cdpr_struct.reports.html import HtmlTable, Page, Plate, page_files
from cdpr_struct.reports.text import place
from cdpr_struct.reports.transient_page import spectrogram_csv
from cdpr_struct.robot.pose import angles_from_rotation

_CHANNELS = ("ax", "ay", "az")


def measured_json(
    time: np.ndarray, acceleration: np.ndarray, point: OperatingPoint, model: CableModel, highest_hertz: float
) -> dict[str, Any]:
    """Dominant frequencies of the record and the eigenfrequencies of the robot up to `highest_hertz`."""
    cables = cable_dynamics(point, model, 2.0 * np.pi * highest_hertz)
    modes = modes_below(point, cables, highest_hertz)
    dominant = dominant_frequency(time, acceleration)
    known = len(modes.hertz) > 0 and np.isfinite(dominant)
    nearest = float(modes.hertz[np.abs(modes.hertz - dominant).argmin()]) if known else float("nan")
    return {
        "robot": point.entered.name,
        "pose": [*point.position, *np.degrees(angles_from_rotation(point.rotation))],
        "model": model,
        "samples": len(time),
        "sample_rate_hz": (len(time) - 1) / float(time[-1] - time[0]),
        "highest_hz": highest_hertz,
        "dominant_hz": dominant,
        "nearest_mode_hz": nearest,
        "channels": {name: dominant_frequency(time, acceleration[:, [i]]) for i, name in enumerate(_CHANNELS)},
        "natural_frequencies_hz": modes.hertz,
        "kinds": modes.kinds,
        "count_certified": modes.certified,
    }


def measured_text(result: Mapping[str, Any]) -> str:
    """The dominant frequencies in sentences."""
    channels = ", ".join(f"{name} {_hertz(hertz)}" for name, hertz in result["channels"].items())
    return (
        f"{result['samples']} samples at {result['sample_rate_hz']:.6g} Hz: mainly {result['dominant_hz']:.3f} Hz "
        f"({channels}).\nThe nearest of the {len(result['natural_frequencies_hz'])} predicted eigenfrequencies is "
        f"{result['nearest_mode_hz']:.4f} Hz."
    )


def measured_files(
    time: np.ndarray, acceleration: np.ndarray, result: Mapping[str, Any], window: float | None
) -> dict[str, str | bytes]:
    """Spectrogram as SVG and CSV, the modes, and the report page."""
    shown = _shown(time, acceleration, result, window)
    plate = Plate(
        "spectrogram",
        "Measured acceleration and predicted modes",
        Drawing("spectrogram", figure.SIZE, lambda f: figure.draw_vibration(f, shown)),
        f"Above: the record. Below: {figure.vibration_caption(shown.spectrum)} Bright lines without a mark beside them "
        "are vibrations that the model does not predict.",
        vibration_plot(shown),
    )
    return {
        "spectrogram.csv": spectrogram_csv(shown.spectrum, float(result["highest_hz"])),
        "modes.csv": csv_text(measured_mode_columns(result)),
        **page_files(_page(result, shown.spectrum, plate)),
    }


def measured_mode_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of modes.csv, one row a predicted mode."""
    return {"frequency_hz": result["natural_frequencies_hz"], "kind": result["kinds"]}


def measured_figure(
    time: np.ndarray, acceleration: np.ndarray, result: Mapping[str, Any], window: float | None
) -> tuple[Draw, tuple[float, float]]:
    """What draws record and spectrogram into an empty figure, and its size [inch]."""
    shown = _shown(time, acceleration, result, window)
    return lambda f: figure.draw_vibration(f, shown), figure.SIZE


def _shown(
    time: np.ndarray, acceleration: np.ndarray, result: Mapping[str, Any], window: float | None
) -> figure.Vibration:
    modes = ModesInBand(result["natural_frequencies_hz"], result["kinds"], result["count_certified"], True)
    spectrum = spectrogram(time, acceleration, window)
    return figure.Vibration(time, acceleration, _CHANNELS, spectrum, modes, float(result["highest_hz"]))


def _page(result: Mapping[str, Any], spectrum: Spectrogram, plate: Plate) -> Page:
    return Page(
        robot=result["robot"],
        title=f"{result['robot']}: measured vibration",
        subtitle=(
            f"{result['samples']} samples in {_duration(result):.4g} s, robot at {place(result['pose'][:3])}; "
            f"cable model {result['model']}"
        ),
        verdict=[measured_sentence(result)],
        holds=bool(result["count_certified"]),
        facts=[
            (_hertz(result["dominant_hz"]), "dominant frequency of the record"),
            (_hertz(result["nearest_mode_hz"]), "nearest predicted eigenfrequency"),
            (f"{len(result['natural_frequencies_hz'])}", f"eigenfrequencies up to {result['highest_hz']:g} Hz"),
            (f"{result['sample_rate_hz']:.6g} Hz", "sampling rate"),
            (f"{spectrum.window:.3g} s", "analysis window"),
        ],
        plates=[plate],
        tables=[_channel_table(result), _mode_table(result)],
        notes=[("How it was computed", _NOTES)],
    )


_NOTES = (
    "Dominant frequency: the highest peak of the power spectrum (Hann window over the whole record, means taken out), "
    "of all channels together or of one.",
    "Eigenfrequencies: those of the undamped robot at rest at this pose, found by counting (Wittrick and Williams) and "
    "bisection, so that none is missed. A measured frequency near one is no proof that it is this mode: "
    "cable modes lie close together, and the table shows which others are as near.",
)


def measured_sentence(result: Mapping[str, Any]) -> str:
    """The record's dominant frequency, and the predicted mode next to it."""
    dominant, nearest = result["dominant_hz"], result["nearest_mode_hz"]
    if not np.isfinite(dominant):
        return "The record holds no vibration: all channels are constant."
    if not np.isfinite(nearest):
        return f"The record vibrates mainly at {dominant:.3f} Hz; no eigenfrequency is predicted in the band shown."
    kind = result["kinds"][int(np.abs(np.asarray(result["natural_frequencies_hz"]) - nearest).argmin())]
    return (
        f"The record vibrates mainly at {dominant:.3f} Hz; the nearest predicted eigenfrequency is {nearest:.3f} Hz "
        f"({kind}), {_off(dominant, nearest, 1.0 / _duration(result))}."
    )


def _off(dominant: float, nearest: float, resolution: float) -> str:
    """Distance in words, with no more digits than the record's length allows."""
    if abs(dominant - nearest) < resolution:
        return f"closer than the record resolves ({resolution:.2g} Hz)"
    off = 100.0 * (dominant / nearest - 1.0)
    return f"{abs(off):.2g} % {'lower' if off > 0.0 else 'higher'}"


def _duration(result: Mapping[str, Any]) -> float:
    """Length of the record [s]."""
    return float((result["samples"] - 1) / result["sample_rate_hz"])


def _hertz(value: float) -> str:
    return f"{value:.3f} Hz" if np.isfinite(value) else "none"


def _channel_table(result: Mapping[str, Any]) -> HtmlTable:
    rows = [[name, _hertz(hertz)] for name, hertz in result["channels"].items()]
    return HtmlTable("Channels", ["channel", "dominant frequency"], rows)


def _mode_table(result: Mapping[str, Any]) -> HtmlTable:
    dominant, hertz = result["dominant_hz"], np.asarray(result["natural_frequencies_hz"], dtype=float)
    nearest_first = np.argsort(np.abs(hertz - dominant), kind="stable")
    rows = [
        [str(i + 1), f"{hertz[i]:.4f}", *_distance(dominant, hertz[i]), result["kinds"][i]]
        for i in nearest_first.tolist()
    ]
    columns = ["mode", "frequency [Hz]", "dominant minus mode [Hz]", "relative [%]", "kind"]
    note = (
        "Nearest to the record's dominant frequency first. The record tells frequencies apart that are "
        f"{1.0 / _duration(result):.2g} Hz apart or more."
    )
    return HtmlTable("Predicted eigenfrequencies", columns, rows, note, prose=frozenset({4}))


def _distance(dominant: float, hertz: float) -> list[str]:
    if not np.isfinite(dominant):
        return ["-", "-"]
    return [f"{dominant - hertz:+.4f}", f"{100.0 * (dominant / hertz - 1.0):+.2f}"]

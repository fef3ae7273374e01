"""Measured accelerations beside the predicted modes: result, text and files."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel, cable_dynamics
from cdpr_struct.dynamics.frequency_sweep import ModesInBand, modes_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.measurement.spectrogram import dominant_frequency, spectrogram
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import spectrogram as figure
from cdpr_struct.reports.figures.style import svg
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
    nearest = float(modes.hertz[np.abs(modes.hertz - dominant).argmin()]) if len(modes.hertz) else float("nan")
    return {
        "robot": point.robot.name,
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
    channels = ", ".join(f"{name} {hertz:.3f} Hz" for name, hertz in result["channels"].items())
    return (
        f"{result['samples']} samples at {result['sample_rate_hz']:.6g} Hz: mainly {result['dominant_hz']:.3f} Hz "
        f"({channels}).\nThe nearest of the {len(result['natural_frequencies_hz'])} predicted eigenfrequencies is "
        f"{result['nearest_mode_hz']:.4f} Hz."
    )


def measured_files(
    time: np.ndarray, acceleration: np.ndarray, result: Mapping[str, Any], window: float | None
) -> dict[str, str | bytes]:
    """Spectrogram as SVG and CSV, and the modes."""
    spectrum = spectrogram(time, acceleration, window)
    highest = float(result["highest_hz"])
    modes = ModesInBand(result["natural_frequencies_hz"], result["kinds"], result["count_certified"], True)
    text = svg(
        "spectrogram",
        figure.SIZE,
        lambda f: figure.draw_vibration(f, time, acceleration, _CHANNELS, spectrum, modes, highest),
    )
    return {
        "spectrogram.svg": text,
        "spectrogram.csv": spectrogram_csv(spectrum, highest),
        "modes.csv": csv_text({"frequency_hz": modes.hertz, "kind": modes.kinds}),
    }

"""Bands of frequency responses and vibrations, from robots drawn within the tolerances."""

from typing import Any

import numpy as np

from cdpr_struct.bands.drawn_curves import response_bands, vibration_bands
from cdpr_struct.dynamics.damping import Damping
from cdpr_struct.dynamics.frequency_sweep import ResponseSweep
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.dynamics.vibration_record import VibratingRobot, VibrationRecord
from cdpr_struct.interface.bands import AskedBand, band_head, spread_of
from cdpr_struct.reports.curve_bands_told import curve_bands_told, curve_checks, response_curves, vibration_curves
from cdpr_struct.reports.figures.curve_bands import ShownCurves
from cdpr_struct.reports.trust import Check
from cdpr_struct.statics.trajectory import Trajectory

RESPONSES, VIBRATIONS = 200, 100
"""Robots that are drawn if `samples` does not say: a response takes some milliseconds, a vibration some tens."""


def banded_response(sweep: ResponseSweep, law: Damping, asked: AskedBand, assembly: Assembly) -> ShownCurves:
    """Magnitudes of all responses of a sweep, with their bands."""
    spread, samples = spread_of(sweep.point.entered), asked.samples or RESPONSES
    return response_curves(sweep, response_bands(sweep, law, spread, asked.level, samples, assembly))


def banded_vibration(
    vibrating: VibratingRobot, record: VibrationRecord, cause: np.ndarray | Trajectory, asked: AskedBand
) -> ShownCurves:
    """Displacements of all ports of a record, with their bands; cause : velocity that is stopped (6,), or motion."""
    spread, samples = spread_of(record.point.entered), asked.samples or VIBRATIONS
    seconds = float(record.vibration.time[-1])

    def again(robot: VibratingRobot) -> np.ndarray:
        return robot.motion(cause, record.ports, seconds).displacement

    return vibration_curves(record, vibration_bands(vibrating, record, again, spread, asked.level, samples))


def told_of_curves(
    shown: ShownCurves | None, asked: AskedBand | None, sweep: ResponseSweep | VibrationRecord
) -> tuple[dict[str, Any], list[Check]]:
    """Key `bands` of a result about curves, nothing if no band was asked for, and what is to be doubted."""
    if shown is None or asked is None:
        return {}, []
    head = band_head(asked, sweep.point.entered)
    return {"bands": head | curve_bands_told(shown)}, curve_checks(shown.bands)

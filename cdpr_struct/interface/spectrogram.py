"""Measured accelerations over time and frequency, with the predicted modes drawn in."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import read_robot, real
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.vibration_model import dropped_by, read_model, require_valid
from cdpr_struct.measurement.time_series import read_accelerations
from cdpr_struct.reports import transient_measured
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.trust_of_modes import mode_checks

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SpectrogramResult(Result):
    """A measured vibration beside predicted modes.

    time : (n,) [s];  acceleration : (n, 3) [m/s^2];  window : of the analysis [s], None: what suits the record
    """

    time: np.ndarray
    acceleration: np.ndarray
    window: float | None = None

    @property
    def title(self) -> str:
        """Whose vibration."""
        return f"{self.answer['robot']}: measured vibration"

    def text(self) -> str:
        """The dominant frequencies."""
        return transient_measured.measured_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """The dominant frequency and the mode next to it."""
        return [transient_measured.measured_sentence(self.answer)]

    def columns(self) -> Mapping[str, Any]:
        """Columns of modes.csv."""
        return transient_measured.measured_mode_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Accelerations over time, and their spectrogram."""
        return transient_measured.measured_figure(self.time, self.acceleration, self.answer, self.window)

    def files(self) -> Files:
        """Tables, figure and page."""
        return transient_measured.measured_files(self.time, self.acceleration, self.answer, self.window)


@answered
def spectrogram(
    file: str | os.PathLike[str],
    robot: RobotLike,
    pose: PoseLike | None = None,
    *,
    lengths: Numbers | None = None,
    start: PoseLike | None = None,
    free: FreeAngles | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    highest: float = 25.0,
    window: float | None = None,
    model: str = "exact",
    force: bool = False,
) -> SpectrogramResult:
    """Show measured accelerations over time and frequency, beside the robot's certified eigenfrequencies.

    Parameters
    ----------
    file : path of a CSV file with columns time_s, ax, ay, az [s, m/s^2]
    robot : Robot, built-in name, or path of a robot file, whose modes are drawn in
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    highest : top of the picture [Hz];  window : of the analysis [s]
    model : static, dsm or exact;  force : dsm outside its validity limits, too

    Raises
    ------
    InputError : an unusable argument or file.
    CdprError : the robot cannot be at rest there, or dsm is outside its limits.
    """
    time, acceleration = read_accelerations(Path(file))
    half_rate = 0.5 * (len(time) - 1) / (time[-1] - time[0])
    expected = f"a frequency up to half of the sampling rate, {half_rate:.6g} Hz"
    if not 0.0 < real(highest, "highest", expected) <= half_rate:
        raise InputError("highest", "", highest, expected)
    if window is not None and not 8.0 <= real(window, "window", "a time in s") * 2.0 * half_rate <= len(time):
        raise InputError("window", "", window, f"between {4.0 / half_rate:.4g} and {time[-1] - time[0]:.4g} s")
    cable_model, machine = (
        read_model(model),
        read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True),
    )
    state = rest(machine, pose, lengths, start, free)
    require_valid(cable_model, state.point, force)
    with state.advised():
        told = transient_measured.measured_json(time, acceleration, state.point, cable_model, highest)
    told |= state.told(
        *dropped_by(cable_model, machine), *mode_checks(told["natural_frequencies_hz"], told["count_certified"])
    )
    return SpectrogramResult(with_extensions(told, machine, "spectrogram", cable_model), time, acceleration, window)

"""Measured against predicted at once: each reading in its band or not."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.bands.compared import assigned, compared, seen_on_platform
from cdpr_struct.bands.frequency_bands import frequency_bands
from cdpr_struct.bands.rest_bands import pose_by_motion, rest_bands
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_robot
from cdpr_struct.interface.bands import AskedBand, Banded, known_from, read_band
from cdpr_struct.interface.enough_modes import enough_modes
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.modes import ASSEMBLIES
from cdpr_struct.interface.operating_point import pose_in_degrees, rest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.vibration_model import dropped_by, read_model, require_valid
from cdpr_struct.measurement.campaign_rows import POSE
from cdpr_struct.measurement.compared_readings import Reading, read_readings
from cdpr_struct.reports import compare_told as told
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.tolerances_told import of_a_robot

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

_ROOM = 1.1  # times the highest reading, up to which there may be its mode


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CompareResult(Result):
    """Readings against their bands.

    holds : whether all readings together agree with the robot within its tolerances and the sensors' noise
    """

    holds: bool

    @property
    def title(self) -> str:
        """Whose readings."""
        return f"{self.answer['robot']}: measured against predicted"

    def text(self) -> str:
        """Every reading with its band, and the verdict on all."""
        return told.compare_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """How many lie inside, and whether all agree."""
        return told.compare_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of readings.csv."""
        return told.compare_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Every reading against its band, in sigmas."""
        from cdpr_struct.reports.figures import readings_in_bands

        draw = readings_in_bands.draw_readings
        return lambda figure: draw(figure, self.answer), readings_in_bands.size(self.answer)

    def files(self) -> Files:
        """Table, figure and page."""
        return told.compare_files(self.answer)


@answered
def compare(
    robot: RobotLike,
    measured: str | os.PathLike[str],
    pose: PoseLike | None = None,
    *,
    lengths: Numbers | None = None,
    start: PoseLike | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    free: FreeAngles | None = None,
    model: str = "exact",
    assembly: str = "consistent",
    force: bool = False,
    band: float = 90.0,
) -> CompareResult:
    """Compare readings of one state of rest with predictions: each in its band or not, and all of them together.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file; its [tolerances] make the bands
    measured : CSV file with columns frequency_hz (and mode), tension_N and cable, x_m .. rz_deg; and sigma
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg], which the winches were set for; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    model : static, dsm or exact;  assembly : consistent, or thesis (eq. 3.8 as printed)
    force : dsm outside its validity limits, too;  band : level of each band [%]

    Raises
    ------
    InputError : an unusable argument or file.
    CdprError : the robot cannot be at rest there, or dsm is outside its limits.
    """
    way, name = one_of(assembly, "assembly", ASSEMBLIES), read_model(model)
    asked = read_band(band) or AskedBand(0.9)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True)
    readings = read_readings(Path(measured), len(machine.cables))
    state = rest(machine, pose, lengths, start, free)
    require_valid(name, state.point, force)
    banded = Banded.at(state.point, asked, True, assembly=way)
    with state.advised():
        numbers, predicted, ends, rates = _predicted(banded, readings, name, os.fspath(measured))
    values, noise = np.array([[one.measured, one.sigma] for one in readings]).T
    scatter = banded.spread.scatter * predicted * [one.column == "frequency_hz" for one in readings]
    found = compared(values, noise, predicted, ends, rates, banded.spread, asked.level, scatter)
    answer = {
        "robot": machine.name,
        "pose": pose_in_degrees(state.point),
        "model": name,
        "assembly": way,
        "level": 100.0 * asked.level,
        **told.compare_json(readings, numbers, predicted, found),
        "known_from": known_from(machine),
        "tolerances": of_a_robot(machine.tolerances),
        **state.told(*dropped_by(name, machine)),
    }
    holds = found.p_value >= told.DOUBTFUL
    return CompareResult(with_extensions(answer, machine, "compare", name), holds)


def _predicted(
    banded: Banded, readings: list[Reading], model: CableModel, file: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Of n readings, in their units: mode or cable (n,), prediction (n,), ends of its band (n, 2), rates (p, n)."""
    numbers = np.array([one.number for one in readings])
    vibrating = np.array([one.column == "frequency_hz" for one in readings])
    values, ends = np.zeros(len(readings)), np.zeros((len(readings), 2))
    rates = np.zeros((len(banded.spread.root), len(readings)))
    if vibrating.any():
        own = [one for one in readings if one.column == "frequency_hz"]
        mode, *rest_of = _frequencies(banded, own, model, file)
        numbers[vibrating] = mode
        values[vibrating], ends[vibrating], rates[:, vibrating] = rest_of
    point = banded.point
    still = rest_bands(point, banded.response, banded.spread, banded.asked.level)
    scale = np.where(np.arange(6) < 3, 1.0, np.degrees(1.0))
    pose = pose_in_degrees(point)
    motion = banded.response.pose @ pose_by_motion(point.rotation).T * scale
    for i, one in enumerate(readings):
        if one.column == "tension_N":
            k = one.number - 1
            values[i], ends[i] = point.cables.tension_at_platform[k], still.tension[k]
            rates[:, i] = banded.response.tension[:, k]
        elif one.column in POSE:
            k = POSE.index(one.column)
            values[i], ends[i], rates[:, i] = pose[k], still.pose[k] * scale[k], motion[:, k]
    return numbers, values, ends, rates


def _frequencies(
    banded: Banded, readings: list[Reading], model: CableModel, file: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The same of readings of frequencies."""
    measured, labels = np.array([one.measured for one in readings]), np.array([one.number for one in readings])
    highest = _ROOM * float(measured.max())
    hertz, energy = enough_modes(banded, model, int(labels.max()), lambda found, _: bool(found[-1] > highest))
    if int(labels.max()) > len(hertz):
        raise InputError(file, "mode", int(labels.max()), f"the model {model} has {len(hertz)} modes here")
    found = banded.rates(hertz, model)
    bands = frequency_bands(found, banded.spread, banded.asked.level)
    free = np.setdiff1d(seen_on_platform(energy), labels - 1)
    unknown = labels == 0
    if unknown.sum() > len(free):
        free = np.setdiff1d(np.arange(len(hertz)), labels - 1)
    if unknown.sum() > len(free):
        raise InputError(
            file, "frequency_hz", f"{len(measured)} readings", f"at most {len(hertz)}: there are no more modes"
        )
    mode = labels - 1
    mode[unknown] = free[assigned(measured[unknown], hertz[free], bands.sigma[free])]
    ends = np.stack([bands.low, bands.high], axis=-1)[mode]
    return mode + 1, hertz[mode], ends, found.own[:, mode] * hertz[mode]

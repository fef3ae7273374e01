"""Vibration after an emergency stop, or along a trajectory."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.dynamics.vibration_record import VibratingRobot, VibrationRecord
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of, read_numbers, read_robot, real, text_of
from cdpr_struct.interface.banded_curves import banded_vibration, told_of_curves
from cdpr_struct.interface.bands import read_band
from cdpr_struct.interface.damping_law import read_damping, read_end_friction
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, Progress, RobotLike, TrajectoryLike
from cdpr_struct.interface.modes import ASSEMBLIES
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.interface.ports import read_ports
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.trajectory import read_trajectory
from cdpr_struct.interface.vibration_model import dropped_by, read_model, require_valid
from cdpr_struct.interface.winches import require_locked_lengths, require_own_winches
from cdpr_struct.reports.curve_bands_told import curve_bands_text
from cdpr_struct.reports.damping_note import ENDLESS_VIBRATION, damping_note, friction_note
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.figures.curve_bands import ShownCurves
from cdpr_struct.reports.text import paragraphs
from cdpr_struct.reports.transient_result import transient_columns, transient_json
from cdpr_struct.reports.transient_text import transient_summary, transient_text
from cdpr_struct.reports.trust_of_modes import mode_checks
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.statics.trajectory import Trajectory

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

_MOST_SAMPLES = 2_000_000
_FEWEST = 4  # rows of a trajectory file, for the rates of its accelerations
_PLATFORM = "x,y,z,rx,ry,rz"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TransientResult(Result):
    """A vibration in time.

    record : point, ports, vibration (time (n,), displacement, velocity, acceleration (n, ports)), modes
    window : of the spectrogram [s]; None: what suits the record
    within : displacements with their bands, None if none were asked for
    """

    record: VibrationRecord
    window: float | None = None
    within: ShownCurves | None = None

    @property
    def title(self) -> str:
        """Whose vibration."""
        return f"{self.record.point.entered.name}: vibration in time"

    def text(self) -> str:
        """Largest motion and dominant frequency of every port; bands if there are any."""
        more = curve_bands_text(self.answer["bands"]) if "bands" in self.answer else []
        return paragraphs(transient_text(self.answer), *more)

    def sentences(self) -> Sequence[str]:
        """Dominant frequency, and the damping that acts."""
        return [transient_summary(self.answer), self.answer["damping_note"]]

    def columns(self) -> Mapping[str, Any]:
        """Columns of transient.csv."""
        return transient_columns(self.record)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Acceleration over time, and its spectrogram."""
        from cdpr_struct.reports.transient_page import vibration_figure

        return vibration_figure(self.record, self.window)

    def files(self) -> Files:
        """Tables, figure and page."""
        from cdpr_struct.reports.transient_page import transient_files

        return transient_files(self.record, self.answer, self.window, self.within)

    def universal_file(self) -> bytes:
        """Accelerations of all ports as a universal file: dataset 58, time responses."""
        from cdpr_struct.measurement.universal_file import motion_file

        record = self.record
        axes = record.point.rotation if self.answer["frame"] == "platform" else np.eye(3)
        vibration, name = record.vibration, record.point.entered.name
        return motion_file(vibration.time, vibration.acceleration, record.ports, name, axes)


@answered
def transient(
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
    initial_velocity: Numbers | None = None,
    trajectory: TrajectoryLike | None = None,
    duration: float | None = None,
    highest: float = 25.0,
    watch: str | Iterable[str] | None = None,
    window: float | None = None,
    model: str = "exact",
    damping: str = "viscous",
    end_friction: str | None = None,
    frame: str = "world",
    at: Numbers | None = None,
    assembly: str = "consistent",
    force: bool = False,
    band: float | None = None,
    samples: int | None = None,
    progress: Progress = silent,
) -> TransientResult:
    """Predict the vibration after an emergency stop, or along a trajectory, by modal superposition.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose, or where the trajectory ends
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    initial_velocity : before the stop, 3 or 6 numbers [m/s, rad/s], world axes
    trajectory : Trajectory, "helix", or path of a CSV file: vibration along this motion, in place of the velocity
    duration : to predict [s];  highest : modes up to this frequency [Hz]
    watch : degrees of freedom to record besides those of the platform, like "cable5@0.3:z"
    window : of the spectrogram [s];  model : static, dsm or exact
    damping : law with its numbers, like "viscous:0.005" or "modal:0.01,0.012"
    end_friction : dry friction at the ends of the cables, like "platform:0.0001,0.003": moment over tension [m], and
        angle over which it builds up [rad]; frame, platform or both, with ";" between two of them
    frame : axes, world or platform;  at : point of the platform (3,) [m, platform frame]; default: its origin
    assembly : consistent, or thesis (eq. 3.8 as printed);  force : dsm outside its validity limits, too
    band : level of a band about every displacement [%], like 90: of robots drawn within the tolerances, winches locked
    samples : with band, so many robots; default: 100
    progress : called with the name of each step

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there, or dsm is outside its limits.
    """
    if (initial_velocity is None) == (trajectory is None):
        given = "nothing" if initial_velocity is None else initial_velocity
        raise InputError("initial_velocity", "", given, "give either `initial_velocity` or `trajectory`")
    cable_model, way = read_model(model), one_of(assembly, "assembly", ASSEMBLIES)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, winches=True)
    if trajectory is not None:
        require_locked_lengths(machine, "along a trajectory all winches hold lengths; initial_velocity is computed")
        require_own_winches(machine, "along a trajectory each cable has its winch; initial_velocity is computed")
        if free is not None:
            raise InputError("free", "", free, "leave it out: a trajectory says the angles at its end")
    law = read_damping(damping, machine, cable_model == "static")
    rubbing = None if end_friction is None else read_end_friction(end_friction)
    motion, assumed = (None, []) if trajectory is None else read_trajectory(trajectory, None, _FEWEST)
    seconds, asked = _duration(duration, motion), read_band(band, samples)
    _check_samples(highest, seconds, window)
    if motion is not None and pose is None and lengths is None:
        pose = Pose(motion.position[-1], angles_from_rotation(motion.rotation[-1]))
    state = rest(machine, pose, lengths, start, free)
    require_valid(cable_model, state.point, force)
    ports = read_ports(_PLATFORM, "watch", state.point, frame, at)
    ports += () if not watch else read_ports(watch, "watch", state.point, frame, at)
    vibrating = VibratingRobot(state.point, cable_model, law, highest, way, rubbing)
    progress("modes and motion")
    cause = _twist(initial_velocity or "") if motion is None else motion
    with state.advised():
        record = (
            vibrating.along(cause, ports, seconds)
            if isinstance(cause, Trajectory)
            else vibrating.after_stop(cause, ports, seconds)
        )
    if asked is not None:
        progress("robots within the tolerances")
    within = None if asked is None else banded_vibration(vibrating, record, cause, asked)
    bands, doubts = told_of_curves(within, asked, record)
    described = {
        "damping": damping,
        "end_friction": end_friction,
        "frame": frame,
        "at_m": "0,0,0" if at is None else text_of(at),
        "assembly": way,
    }
    note = damping_note(law, damping, machine, cable_model == "static", ENDLESS_VIBRATION)
    if rubbing is not None:
        note = f"{friction_note(rubbing)} {note}"
    checks = *dropped_by(cable_model, machine), *mode_checks(record.modes.hertz, record.modes.certified), *doubts
    told = transient_json(record, {**described, "damping_note": note, "command": None}) | bands
    told |= state.told(*checks, warnings=assumed)
    return TransientResult(with_extensions(told, machine, "transient", cable_model), record, window, within)


def _check_samples(highest: float, seconds: float, window: float | None) -> None:
    """Whether the record has enough samples, not too many, and room for the spectrogram's window."""
    expected = f"above zero, with at most {_MOST_SAMPLES} samples (8 per period)"
    real(highest, "highest", expected, 0.0, _MOST_SAMPLES / (8.0 * seconds))
    if highest * seconds < 1.0:
        raise InputError("duration", "", seconds, f"at least one period of `highest`, {1.0 / highest:.3g} s")
    if window is not None and not 0.0 < real(window, "window", "a time in s") <= seconds:
        raise InputError("window", "", window, f"a time between 0 and {seconds:g} s")


def _twist(given: Numbers) -> np.ndarray:
    values = read_numbers(given, "initial_velocity", (3, 6), "velocities in m/s and rad/s")
    if not any(values):
        raise InputError("initial_velocity", "", given, "give a velocity that is not zero")
    return np.array([*values, 0.0, 0.0, 0.0][:6])


def _duration(given: float | None, motion: Trajectory | None) -> float:
    if given is None and motion is not None:
        return float(motion.time[-1] - motion.time[0])
    if given is None:
        raise InputError("duration", "", "nothing", "give the time to predict in s, like 5")
    return real(given, "duration", "give a time in s above zero", 0.0, float("inf"))

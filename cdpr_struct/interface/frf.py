"""Frequency responses between any points of the robot."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.dynamics.frequency_response import QUANTITIES
from cdpr_struct.dynamics.frequency_sweep import ResponseSweep, sweep_response
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of, read_robot, text_of
from cdpr_struct.interface.banded_curves import banded_response, told_of_curves
from cdpr_struct.interface.bands import read_band as read_level
from cdpr_struct.interface.damping_law import read_damping
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, Progress, RobotLike
from cdpr_struct.interface.modes import ASSEMBLIES
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.interface.ports import read_ports
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.vibration_model import dropped_by, read_model, require_valid
from cdpr_struct.reports.curve_bands_told import curve_bands_text
from cdpr_struct.reports.damping_note import damping_note
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.figures.curve_bands import ShownCurves
from cdpr_struct.reports.frf_result import frf_columns, frf_json
from cdpr_struct.reports.frf_text import frf_summary, frf_text
from cdpr_struct.reports.text import paragraphs
from cdpr_struct.reports.trust_of_modes import mode_checks

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

_MOST_FREQUENCIES = 1_000_000


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FrfResult(Result):
    """Frequency responses of a robot at rest.

    sweep : point, response (hertz (f,), response (f, n) complex), peaks of each, modes of the band
    within : magnitudes with their bands, None if none were asked for
    """

    sweep: ResponseSweep
    within: ShownCurves | None = None

    @property
    def title(self) -> str:
        """Whose response."""
        return f"{self.sweep.point.entered.name}: frequency response"

    def text(self) -> str:
        """Damping, peaks of every response, and how they compare with the eigenfrequencies; bands if there are any."""
        more = curve_bands_text(self.answer["bands"]) if "bands" in self.answer else []
        return paragraphs(frf_text(self.answer), *more)

    def sentences(self) -> Sequence[str]:
        """Peaks and modes of the band, and the damping that acts."""
        return [frf_summary(self.answer), self.answer["damping_note"]]

    def columns(self) -> Mapping[str, Any]:
        """Columns of frf.csv."""
        return frf_columns(self.sweep)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Magnitude, eigenfrequencies and phase."""
        from cdpr_struct.reports.figures import frf

        return lambda figure: frf.draw_frf(figure, self.sweep), frf.SIZE

    def files(self) -> Files:
        """Tables, universal file, figure and page."""
        from cdpr_struct.reports.frf_page import frf_files

        return frf_files(self.sweep, self.answer, self.within)

    def universal_file(self) -> bytes:
        """The even lines of all responses as a universal file: dataset 58."""
        from cdpr_struct.reports.frf_page import response_file

        return response_file(self.sweep, self.answer)


@answered
def frf(
    robot: RobotLike,
    *,
    excite: str,
    respond: str | Iterable[str],
    band: Numbers,
    pose: PoseLike | None = None,
    lengths: Numbers | None = None,
    start: PoseLike | None = None,
    free: FreeAngles | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    quantity: str = "acceleration",
    model: str = "exact",
    damping: str = "viscous",
    frame: str = "world",
    at: Numbers | None = None,
    assembly: str = "consistent",
    force: bool = False,
    percent: float | None = None,
    samples: int | None = None,
    progress: Progress = silent,
) -> FrfResult:
    """Compute frequency responses, with the certified eigenfrequencies beside their peaks.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    excite : where the force acts, like "fz";  respond : answers, like "x,z,cable5@0.3:z" or ["x", "z"]
    band : first and last frequency and step [Hz], like (0.5, 12, 0.01) or "0.5:12:0.01"
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    quantity : acceleration, velocity or displacement;  model : static, dsm or exact
    damping : law with its numbers, like "viscous:0.005" or "modal:0.01,0.012"
    frame : axes, world or platform;  at : point of the platform (3,) [m, platform frame]; default: its origin
    assembly : consistent, or thesis (eq. 3.8 as printed);  force : dsm outside its validity limits, too
    percent : level of a band about every magnitude, like 90: of robots drawn within the tolerances, winches locked
    samples : with percent, so many robots; default: 200
    progress : called with the name of each step

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there, or dsm is outside its limits.
    """
    hertz, asked = read_band(band), read_level(percent, samples, "percent")
    cable_model, way = read_model(model), one_of(assembly, "assembly", ASSEMBLIES)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True)
    law, massless = read_damping(damping, machine, cable_model == "static"), cable_model == "static"
    what = one_of(quantity, "quantity", QUANTITIES)
    state = rest(machine, pose, lengths, start, free)
    point = state.point
    require_valid(cable_model, point, force)
    source = read_ports(excite, "excite", point, frame, at)
    if len(source) != 1:
        raise InputError("excite", "", excite, "give one degree of freedom")
    if massless and source[0].name.startswith("cable"):
        raise InputError("excite", "", excite, "massless cables cannot be shaken; use `model` dsm or exact")
    targets = read_ports(respond, "respond", point, frame, at)
    progress("response, eigenfrequencies and peaks")
    with state.advised():
        sweep = sweep_response(point, cable_model, law, source[0], targets, hertz, what, way)
    described = {"damping": damping, "frame": frame, "at_m": "0,0,0" if at is None else text_of(at), "assembly": way}
    described |= {"band_hz": band_text(band), "damping_note": damping_note(law, damping, machine, massless)}
    if asked is not None:
        progress("robots within the tolerances")
    within = None if asked is None else banded_response(sweep, law, asked, way)
    bands, doubts = told_of_curves(within, asked, sweep)
    checks = mode_checks(sweep.modes.hertz, sweep.modes.certified, sweep.modes.complete)
    trust = state.told(*dropped_by(cable_model, machine), *checks, *doubts)
    told = frf_json(sweep, {**described, "command": None}) | bands | trust
    return FrfResult(with_extensions(told, machine, "frf", cable_model), sweep, within)


def band_text(band: Numbers) -> str:
    """First and last frequency and step as the text of the option."""
    return band if isinstance(band, str) else text_of(band).replace(",", ":")


def read_band(given: Numbers) -> np.ndarray:
    """Frequencies F0, F0 + DF, .. up to F1 [Hz].

    Raises
    ------
    InputError : not three numbers, not ascending, or too many steps.
    """
    expected = "give F0:F1:DF in Hz with 0 <= F0 < F1 and DF > 0, like 0.5:20:0.01"
    try:
        first, last, step = (float(part) for part in (given.split(":") if isinstance(given, str) else given))
    except (TypeError, ValueError) as error:
        raise InputError("band", "", given, expected) from error
    if not (0.0 <= first < last < float("inf") and 0.0 < step <= last - first):
        raise InputError("band", "", given, expected)
    if (last - first) / step > _MOST_FREQUENCIES:
        raise InputError("band", "", given, f"at most {_MOST_FREQUENCIES} frequencies")
    return first + step * np.arange(int((last - first) / step * (1.0 + 1e-12)) + 1)

"""Eigenfrequencies of the whole robot, none missing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from cdpr_struct.crosscheck.mode_motion import ModeMotion, mode_motion
from cdpr_struct.crosscheck.robot_modes import MODELS, RobotModes, robot_modes
from cdpr_struct.dynamics.backbone import BackboneCurves, backbone_curves
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.platform_directions import direction_shares
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_numbers, read_robot, whole
from cdpr_struct.interface.bands import Banded, read_band
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.operating_point import pose_in_degrees, rest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.vibration_model import dropped_by, require_valid
from cdpr_struct.reports.backbone_text import backbone_checks, backbone_told
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.mode_words import motion_words
from cdpr_struct.reports.modes_text import modes_columns, modes_sentence, modes_text
from cdpr_struct.reports.trust_of_modes import mode_checks
from cdpr_struct.robot.robot_arrays import RobotArrays

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

MOST_AMPLITUDES = 20
ASSEMBLIES: tuple[Assembly, ...] = get_args(Assembly)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ModesResult(Result):
    """Eigenfrequencies of a robot at rest.

    point : the robot at rest;  modes : hertz (k,) [Hz], platform (k, 6), energies, kinds(), count_certified
    motion : how cables (k, m, p, 3) and platform (k, 6) move, the largest component of each mode 1
    """

    point: OperatingPoint
    modes: RobotModes
    motion: ModeMotion

    @property
    def title(self) -> str:
        """Whose frequencies."""
        return f"{self.point.entered.name}: eigenfrequencies"

    def text(self) -> str:
        """Table of modes, and whether the count is certified."""
        return modes_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """Range of the frequencies, and whether their count is certified."""
        return [modes_sentence(self.answer)]

    def columns(self) -> Mapping[str, Any]:
        """Columns of modes.csv."""
        return modes_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The platform's share over frequency, crowding, and tensions."""
        from cdpr_struct.reports.figures import mode_ladder

        return lambda figure: mode_ladder.draw_ladder(figure, self.answer), mode_ladder.SIZE

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.modes_page import modes_files

        return modes_files(self.point, self.answer, self.motion)

    def universal_file(self) -> bytes:
        """Shapes of platform and cables as a universal file: datasets 15, 82 and 55.

        Raises
        ------
        InputError : the modes are those of the finite elements, whose cables' shapes are not kept.
        """
        from cdpr_struct.reports.universal_shapes import shapes_file

        model, way = self.answer["model"], self.answer["assembly"]
        if model == "fem":
            raise InputError("model", "", model, "static, dsm or exact, for mode shapes in a universal file")
        return shapes_file(self.point, certified_modes(self.point, model, len(self.modes.hertz), way))


@answered
def modes(
    robot: RobotLike,
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
    model: str = "exact",
    assembly: str = "consistent",
    elements: int = 80,
    count: int = 40,
    force: bool = False,
    free: FreeAngles | None = None,
    amplitude: Numbers | None = None,
    band: float | None = None,
    samples: int | None = None,
) -> ModesResult:
    """Compute the eigenfrequencies of a robot at rest, none missing, with their kind.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    model : static, dsm, exact or fem;  assembly : consistent, or thesis (eq. 3.8 as printed)
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    elements : a cable, for fem;  count : how many eigenfrequencies;  force : dsm outside its validity limits, too
    amplitude : up to 20, of the cables' platform end that moves most [m]; adds `large_motion`: frequencies of the
        platform's modes when each swings alone with these amplitudes
    band : level of a band about each frequency [%], like 90: within the robot's tolerances, winches locked
    samples : with band, so many robots drawn within the tolerances check it

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there, or dsm is outside its limits.
    """
    whole(count, "count", 1, 500)
    whole(elements, "elements", 2, 2000)
    asked = read_band(band, samples)
    way, name = one_of(assembly, "assembly", ASSEMBLIES), one_of(model, "model", MODELS)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True)
    state = rest(machine, pose, lengths, start, free)
    point = state.point
    require_valid(name, point, force)
    with state.advised():
        most = 6 - len(machine.guided) if name == "static" else count
        found = robot_modes(point, name, min(count, most), way, elements)
    motion, shares = mode_motion(point, found), direction_shares(point, found.platform)
    curves = None if amplitude is None else _curves(point, found, amplitude)
    bands, checks = (
        ({}, []) if asked is None else Banded.at(point, asked, True, assembly=way).frequencies(found.hertz, name)
    )
    told = {
        "robot": machine.name,
        "pose": pose_in_degrees(point),
        "model": name,
        "assembly": way,
        "frequencies_hz": found.hertz,
        "count_certified": found.count_certified,
        "kinds": found.kinds(),
        "platform_energy": found.platform_energy,
        "cable_energy": found.cable_energy,
        "motion": motion.platform,
        "platform_directions": shares,
        "motion_words": motion_words(found.platform_energy, shares),
        "tensions_N": point.cables.tension_at_platform,
        "lengths_m": RobotArrays.of(machine).reading(point.cables.paid_out),
        **({} if curves is None else {"large_motion": backbone_told(curves)}),
        **({"bands": bands} if bands else {}),
        **state.told(
            *dropped_by(name, machine),
            *mode_checks(found.hertz, found.count_certified),
            *backbone_checks(curves),
            *checks,
        ),
    }
    return ModesResult(with_extensions(told, machine, "modes", name), point, found, motion)


def _curves(point: OperatingPoint, found: RobotModes, amplitude: Numbers) -> BackboneCurves:
    """Frequencies of the platform's modes at the amplitudes asked for."""
    asked = read_numbers(amplitude, "amplitude", None, "amplitudes in m")
    if not 0 < len(asked) <= MOST_AMPLITUDES or min(asked) <= 0.0:
        raise InputError("amplitude", "", asked, f"give 1 to {MOST_AMPLITUDES} amplitudes in m, all above zero")
    return backbone_curves(point, found.hertz, found.platform, found.platform_energy, np.array(asked))

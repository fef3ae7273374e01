"""Does a robot within its tolerances meet requirements, and how surely?"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.bands.chances import DrawnRest, chance
from cdpr_struct.bands.frequency_bands import chance_above, frequency_bands
from cdpr_struct.bands.mode_rates import ModeRates
from cdpr_struct.crosscheck.robot_modes import OutsideValidityError
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of, read_robot
from cdpr_struct.interface.bands import AskedBand, Banded, known_from
from cdpr_struct.interface.enough_modes import enough_modes
from cdpr_struct.interface.given import Numbers, Progress, RobotLike
from cdpr_struct.interface.modes import ASSEMBLIES
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.interface.requirements import Requirements, RequirementTable, read_requirements
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.vibration_model import read_model, require_valid
from cdpr_struct.reports import accept_told as told
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.tolerances_told import of_a_robot
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

_LEVEL = 0.9  # of the bands that are drawn
_HALF = 0.5  # of the kinetic energy: a mode of the platform
_OF_MODES = ("frequency", "platform_frequency")  # quantities


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AcceptResult(Result):
    """Verdicts on requirements.

    holds : whether none fails
    """

    holds: bool

    @property
    def title(self) -> str:
        """Whose acceptance."""
        return f"{self.answer['robot']}: requirements"

    def text(self) -> str:
        """Every requirement with its verdict and the pose that decides."""
        return told.accept_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """How many pass, fail, or cannot be said."""
        return told.accept_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of requirements.csv."""
        return told.accept_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Predictions with bands over the poses, and the limits."""
        from cdpr_struct.reports.figures import limits_kept

        return lambda figure: limits_kept.draw_limits(figure, self.answer), limits_kept.size(self.answer)

    def files(self) -> Files:
        """Table, figure and page."""
        return told.accept_files(self.answer)


@answered
def accept(
    robot: RobotLike,
    requirements: str | os.PathLike[str],
    *,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    model: str = "exact",
    assembly: str = "consistent",
    force: bool = False,
    progress: Progress = silent,
) -> AcceptResult:
    """Say whether a robot within its tolerances meets requirements: pass, fail, or cannot be said.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file; its [tolerances] make the probabilities
    requirements : TOML file with poses or a grid and [[requirement]] tables
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    model : static, dsm or exact;  assembly : consistent, or thesis (eq. 3.8 as printed)
    force : dsm outside its validity limits, too
    progress : called once a pose, with its place in words

    Raises
    ------
    InputError : an unusable argument or file.
    CdprError : dsm is outside its limits.
    """
    way, name = one_of(assembly, "assembly", ASSEMBLIES), read_model(model)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True)
    asked = read_requirements(requirements, machine)
    found = []
    for number, pose in enumerate(asked.poses, start=1):
        progress(f"pose {number} of {len(asked.poses)}")
        found.append(_AtPose.of(machine, pose, asked, name, way, force))
    rows = [told.verdict_row(one, [at.kept[i] for at in found]) for i, one in enumerate(asked.limits)]
    answer = {
        "robot": machine.name,
        "model": name,
        "assembly": way,
        "level": 100.0 * _LEVEL,
        "poses": [one.pose for one in found],
        "requirements": rows,
        "not_held": [{"pose": one.pose, "why": one.why} for one in found if one.why],
        "known_from": known_from(machine),
        "tolerances": of_a_robot(machine.tolerances),
        "warnings": [],
    }
    holds = all(row["verdict"] != "fail" for row in rows)
    return AcceptResult(with_extensions(answer, machine, "accept", name), holds)


@dataclass(frozen=True, slots=True, eq=False)
class _AtPose:
    """One pose: in m and deg, what each requirement finds there, and why it is not held, if it is not."""

    pose: list[float]
    kept: list[told.Kept]
    why: str = ""

    @classmethod
    def of(
        cls, robot: Robot, pose: Pose, asked: Requirements, model: CableModel, assembly: Any, force: bool
    ) -> "_AtPose":  # fmt: skip
        """The robot at one pose."""
        place = pose.in_degrees()
        try:
            state = rest(robot, pose, None)
            require_valid(model, state.point, force)
            banded = Banded.at(state.point, AskedBand(_LEVEL), True, assembly=assembly)
            drawn = DrawnRest.of(banded.point, banded.response, banded.spread, banded.origin)
            modes = _modes(banded, asked, model)
        except (OutsideValidityError, InputError):
            raise
        except CdprError as error:
            return cls(place, [told.Kept.nowhere(place) for _ in asked.limits], str(error))
        return cls(place, [_kept(one, banded, drawn, modes, place) for one in asked.limits])


@dataclass(frozen=True, slots=True, eq=False)
class _Modes:
    rates: ModeRates
    low: np.ndarray
    high: np.ndarray
    of_platform: np.ndarray


def _modes(banded: Banded, asked: Requirements, model: CableModel) -> _Modes | None:
    """The modes that the requirements are about, None if they are about none."""
    count, platform = (max((one.mode for one in asked.limits if one.quantity == kind), default=0) for kind in _OF_MODES)
    if not count + platform:
        return None
    hertz, energy = enough_modes(banded, model, count, lambda _, share: int((share >= _HALF).sum()) >= platform)
    of_platform = np.flatnonzero(energy >= _HALF)
    hertz = hertz[: max(count, int(of_platform[:platform].max(initial=0)) + 1)]
    rates = banded.rates(hertz, model)
    bands = frequency_bands(rates, banded.spread, _LEVEL)
    return _Modes(rates, bands.low, bands.high, of_platform)


def _kept(
    one: RequirementTable, banded: Banded, drawn: DrawnRest, modes: _Modes | None, place: list[float]
) -> told.Kept:
    """What a requirement finds at a pose."""
    if one.quantity in _OF_MODES:
        if modes is None:
            raise AssertionError("modes are computed wherever a requirement is about them")
        index = one.mode - 1
        if one.quantity == "platform_frequency":
            if index >= len(modes.of_platform):
                return told.Kept.nowhere(place)
            index = int(modes.of_platform[index])
        above = chance_above(modes.rates, banded.spread, index, max(one.limit, 1e-12))
        ends = (float(modes.low[index]), float(modes.high[index]))
        return told.Kept(place, float(modes.rates.hertz[index]), ends, above if one.at_most is None else 1.0 - above)
    values, now = _drawn_values(one, banded, drawn)
    worst = values.min(axis=1) if one.at_most is None else values.max(axis=1)
    low, high = np.quantile(worst, [0.5 - 0.5 * _LEVEL, 0.5 + 0.5 * _LEVEL])
    return told.Kept(place, now, (float(low), float(high)), chance(values, one.at_least, one.at_most))


def _drawn_values(one: RequirementTable, banded: Banded, drawn: DrawnRest) -> tuple[np.ndarray, float]:
    """Draws (n, k) of a quantity, and what the robot as entered has of it, the most critical cable's."""
    if one.quantity == "position_error":
        return drawn.position_error[:, None], 0.0
    if one.quantity == "rotation_error":
        return np.degrees(drawn.rotation_error)[:, None], 0.0
    cables = slice(None) if one.cable is None else slice(one.cable - 1, one.cable)
    tension = banded.point.cables.tension_at_platform
    now = tension if one.quantity == "tension" else tension / banded.point.cables.axial_stiffness
    values = (drawn.tension if one.quantity == "tension" else drawn.strain)[:, cables]
    return values, float(now[cables].min() if one.at_most is None else now[cables].max())

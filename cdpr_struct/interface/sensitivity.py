"""What moves frequencies, pose and tensions, and what to change for another frequency."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.bands.designs import KNOBS, LEAST_TENSION, Change, Design
from cdpr_struct.bands.likeliest_robot import at_the_means
from cdpr_struct.bands.locked_response import locked_response
from cdpr_struct.bands.mode_rates import mode_rates
from cdpr_struct.bands.rest_bands import pose_by_motion
from cdpr_struct.bands.sensitivities import Mover, movers, of_equal_modes, rates_of, variance_shares
from cdpr_struct.crosscheck.robot_modes import robot_modes
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import NOTHING, CdprError, InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_robot, real, whole
from cdpr_struct.interface.bands import known_from, spread_of, vibrating_like
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.modes import ASSEMBLIES
from cdpr_struct.interface.operating_point import AtRest, pose_in_degrees, rest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.vibration_model import read_model, require_valid
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports import sensitivity_told as told
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.tolerances_told import of_a_robot
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import FREEDOMS
from cdpr_struct.robot.tolerances import Spread

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

_RAISE = re.compile(r"(?:mode:)?([1-9]\d{0,2})")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SensitivityResult(Result):
    """What moves the predictions of a robot at rest.

    point : the robot at rest
    """

    point: OperatingPoint

    @property
    def title(self) -> str:
        """Whose sensitivities."""
        return f"{self.point.entered.name}: what moves its frequencies"

    def text(self) -> str:
        """Changes for round numbers, what moves one mode most, and shares of the variance."""
        return told.sensitivity_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """What moves the chosen mode most."""
        return told.sensitivity_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of frequencies.csv."""
        return told.row_columns(self.answer["frequencies"])

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """What moves one mode most, and where the variance of every number comes from."""
        from cdpr_struct.reports.figures import tornado

        return lambda figure: tornado.draw_tornado(figure, self.answer), tornado.SIZE

    def files(self) -> Files:
        """Tables, figure and page."""
        from cdpr_struct.reports.sensitivity_page import sensitivity_files

        return sensitivity_files(self.answer)


@answered
def sensitivity(
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
    free: FreeAngles | None = None,
    model: str = "exact",
    assembly: str = "consistent",
    count: int = 6,
    mode: int = 1,
    force: bool = False,
    raise_mode: str | int | None = None,
    to: float | None = None,
) -> SensitivityResult:
    """Tell what moves frequencies, pose and tensions of a robot at rest, and what to change for another frequency.

    Rates are those of a robot whose winches stay where they are. `raise_mode` changes a design: the pose is held anew.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    model : static, dsm or exact;  assembly : consistent, or thesis (eq. 3.8 as printed)
    count : how many eigenfrequencies;  mode : of which the largest movers are listed, from 1
    force : dsm outside its validity limits, too
    raise_mode : number of a mode, like 1 or "mode:1", whose frequency is to become `to` [Hz]

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there, or dsm is outside its limits.
    """
    whole(count, "count", 1, 100)
    whole(mode, "mode", 1, count)
    wanted = _wanted(raise_mode, to)
    way, name = one_of(assembly, "assembly", ASSEMBLIES), read_model(model)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True)
    require_locked_lengths(machine, "rates are those of locked lengths")
    state = rest(machine, pose, lengths, start, free)
    require_valid(name, state.point, force)
    with state.advised():
        most = 6 - len(machine.guided) if name == "static" else count
        hertz = robot_modes(state.point, name, min(count, most), way, 0).hertz
    if not (hertz > 0.0).all():
        raise CdprError("a neutral freedom has no frequency that anything could move; guide it, or load the platform")
    answer = {
        "robot": machine.name,
        "pose": pose_in_degrees(state.point),
        "model": name,
        "assembly": way,
        "frequencies_hz": hertz,
        "mode": min(mode, len(hertz)),
        **_moved(state.point, hertz, name, way, min(mode, len(hertz))),
        **({} if wanted is None else {"raise": _raised(state, wanted, name, way)}),
        **state.told(),
    }
    return SensitivityResult(with_extensions(answer, machine, "sensitivity", name), state.point)


def _moved(
    entered: OperatingPoint, hertz: np.ndarray, model: CableModel, assembly: Assembly, mode: int
) -> dict[str, Any]:
    """All rates of the likeliest robot, those that move one mode most, and shares of the variance.

    hertz : (k,) of the robot as entered [Hz]
    """
    cables, count = entered.arrays.cable_count, len(hertz)
    point, spread = at_the_means(entered, spread_of(entered.entered))
    if point is not entered:
        hertz = robot_modes(point, model, count, assembly, 0).hertz
    response = locked_response(point, assembly, spread=spread)
    found = mode_rates(point, hertz, response, spread, assembly, vibrating_like(model))
    own = of_equal_modes(found.hertz, found.own)[:, :count]
    pose = response.pose @ pose_by_motion(point.rotation).T * np.where(np.arange(6) < 3, 1e3, 180.0 / np.pi)
    moving = [one for one in movers(cables) if _present(point, one)]
    every = np.concatenate([own, pose, response.tension], axis=1)
    numbers = range(1, cables + 1)
    names = [*(f"mode {i + 1}" for i in range(count)), *FREEDOMS, *(f"tension {i}" for i in numbers)]
    units = ["mm"] * 3 + ["deg"] * 3
    sigma = spread.sigma(every)
    sigmas = [f"{100.0 * s:.2g} %" for s in sigma[:count]]
    sigmas += [f"{s:.2g} {u}" for s, u in zip(sigma[count:], [*units, *["N"] * cables], strict=True)]
    return {
        "frequencies": list(told.frequency_rows(moving, own)),
        "poses": list(told.rate_rows(moving, pose, "component", FREEDOMS, units)),
        "tensions": list(told.rate_rows(moving, response.tension, "tension_of_cable", numbers, ["N"] * cables)),
        "largest": _largest(moving, own[:, mode - 1], spread),
        "shares": told.share_rows(variance_shares(every, spread, cables), names, sigmas),
        "known_from": known_from(entered.entered),
        "tolerances": of_a_robot(entered.entered.tolerances),
    }


def _present(point: OperatingPoint, mover: Mover) -> bool:
    """Whether the robot has such a number: without pulleys there is no radius."""
    if mover.varied.field != "pulley_radius":
        return True
    radius = point.arrays.pulley_radius
    return bool((radius if mover.cable is None else radius[mover.cable - 1]).any())


def _largest(moving: Sequence[Mover], own: np.ndarray, spread: Spread) -> list[dict[str, Any]]:
    """Single numbers by how far one sigma of each moves ln f, the largest first [%]."""
    sigma = np.linalg.norm(spread.root, axis=1)
    rows = [
        {**told.place_of(one), "change_percent": 100.0 * float(rates_of(own, one)) * float(sigma[one.index[0]])}
        for one in moving
        if len(one.index) == 1
    ]
    return sorted(rows, key=lambda row: -abs(row["change_percent"]))


def _wanted(mode: str | int | None, to: float | None) -> tuple[int, float] | None:
    """Number of a mode from 1 and the frequency wanted for it [Hz].

    Raises
    ------
    InputError : one without the other, or not to be read.
    """
    if mode is None and to is None:
        return None
    matched = None if mode is None else _RAISE.fullmatch(str(mode))
    if matched is None:
        raise InputError("raise", "", NOTHING if mode is None else mode, "the number of a mode, like mode:1")
    expected = "the frequency in Hz, above zero, that the mode should have"
    if to is None:
        raise InputError("to", "", NOTHING, expected)
    return int(matched[1]), real(to, "to", expected, 0.0)


def _raised(state: AtRest, wanted: tuple[int, float], model: CableModel, assembly: Assembly) -> dict[str, Any]:
    point, (mode, goal) = state.point, wanted
    pose = Pose(point.position, angles_from_rotation(point.rotation))
    design = Design(point.entered, pose, mode - 1, model, assembly)
    ways = {name: design.alone(name, goal) for name in KNOBS}
    ways[LEAST_TENSION] = design.by_tension(goal)
    ways["cheapest_combination"] = design.together(goal)
    return {
        "mode": mode,
        "from_hz": design.frequency({}),
        "to_hz": goal,
        "held": "pose",
        "ways": [
            {"change": name, "to": _told_change(change), "frequency_hz": change.hertz} for name, change in ways.items()
        ],
    }


def _told_change(change: Change) -> dict[str, dict[str, float]] | None:
    if change.factors is None:
        return None
    return {name: {"N" if name == LEAST_TENSION else "factor": value} for name, value in change.factors.items()}

"""Cable forces along a trajectory."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.bands.force_bands import ForceBands
from cdpr_struct.dynamics.trajectory_distribution import (
    BOUND_RULES,
    THESIS_B,
    BoundRule,
    TrajectoryDistribution,
    distribute_along,
)
from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of, read_numbers, read_robot, real
from cdpr_struct.interface.banded_forces import with_force_bands
from cdpr_struct.interface.bands import BANDED_MODELS, AskedBand, read_band
from cdpr_struct.interface.free_angles import FreeAngles, read_free, told_on_way
from cdpr_struct.interface.given import Numbers, Progress, RobotLike, TrajectoryLike
from cdpr_struct.interface.inverse import MODELS
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.interface.trajectory import read_trajectory
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports.distribution_result import distribution_json, force_columns
from cdpr_struct.reports.distribution_text import distribution_text, sentences
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.force_bands_told import force_bands_text
from cdpr_struct.reports.text import paragraphs
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.hanging_trajectory import hanging_along
from cdpr_struct.statics.tension_cost import Centre, EuclideanNorm, Middle, PowerNorm, TensionCost

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

COSTS = ("norm", "p-norm", "middle", "centre")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DistributeResult(Result):
    """Cable forces along a trajectory.

    found : one distribution a lower bound, that which was asked for first
    within : bands of the first, None if none were asked for
    """

    found: tuple[TrajectoryDistribution, ...]
    within: ForceBands | None = None

    @property
    def title(self) -> str:
        """Whose forces."""
        return f"{self.found[0].robot.name}: cable forces along a trajectory"

    def text(self) -> str:
        """Largest forces, and what every lower bound led to; bands if there are any."""
        more = force_bands_text(self.answer["bands"]) if "bands" in self.answer else []
        return paragraphs(distribution_text(self.found), *more)

    def sentences(self) -> Sequence[str]:
        """What the lower bound that was asked for led to."""
        return sentences(self.found[0])

    def columns(self) -> Mapping[str, Any]:
        """Columns of the CSV file of the lower bound that was asked for."""
        return force_columns(self.found[0])

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Force of each cable over time."""
        from cdpr_struct.reports.figures import distribution

        return lambda figure: distribution.draw_together(figure, self.found[0]), distribution.ENERGY_SIZE

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.distribution_page import distribution_files

        return distribution_files(self.found, self.within, self.answer.get("bands"))


@answered
def distribute(
    robot: RobotLike,
    trajectory: TrajectoryLike,
    *,
    bound: str = "pose-dependent",
    b: float = THESIS_B,
    cost: str = "norm",
    weights: Numbers | None = None,
    power: float = 4.0,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    longest: float = math.inf,
    model: str = "sagging",
    max_speed: float = math.inf,
    max_acceleration: float = math.inf,
    instants: int | None = None,
    compare: str | Iterable[str] = (),
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    free: FreeAngles | None = None,
    band: float | None = None,
    samples: int | None = None,
    progress: Progress = silent,
) -> DistributeResult:
    """Distribute cable forces of least cost along a trajectory, above a lower bound.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    trajectory : Trajectory, "helix", "line:START:END:SECONDS", or path of a CSV file
    bound : lower bound, fixed, pose-dependent or frequency;  b : lowest cable frequency wanted [rad/s]
    cost : what is made least, norm, p-norm, middle or centre;  weights : (m,) of the squares in the norm
    power : p of the p-norm, 1.1 to 6
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    longest : unstrained cable length [m];  model : sagging, spring or ideal cables
    max_speed, max_acceleration : to check [m/s, m/s^2];  instants : of a built-in trajectory or line
    compare : other lower bounds to compute beside
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    free : angles that the platform takes by hanging along the apparent gravity, some of rx, ry, rz
    band : level of a band about every tension [%], like 90: within the robot's tolerances, lengths as commanded
    samples : with band, so many robots drawn within the tolerances check it at some instants
    progress : called once a lower bound

    Raises
    ------
    InputError : an unusable argument.
    UnholdablePoseError : an instant has no distribution within the bounds.
    TrajectoryLimitError : the motion is faster than it may be.
    """
    asked = distribute_question(
        robot, bound=bound, b=b, cost=cost, weights=weights, power=power, lower_bound=lower_bound,
        upper_bound=upper_bound, longest=longest, model=model, max_speed=max_speed,
        max_acceleration=max_acceleration, instants=instants, compare=compare, payload=payload, mass=mass,
        wrench=wrench, temperature=temperature, free=free, band=band, samples=samples,
    )  # fmt: skip
    return asked.along(trajectory, progress)


@dataclass(frozen=True, slots=True, eq=False)
class DistributeQuestion:
    """What is asked of any trajectory; names and units are those of `distribute`, free : (3,) bool or None.

    asked : the band, or None
    """

    robot: Robot
    rules: tuple[BoundRule, ...]
    b: float
    cost: TensionCost
    longest: float
    model: str
    max_speed: float
    max_acceleration: float
    instants: int | None
    free: np.ndarray | None = None
    asked: AskedBand | None = None

    def along(self, trajectory: TrajectoryLike, progress: Progress = silent) -> DistributeResult:
        """The result of one trajectory."""
        path, assumed = read_trajectory(trajectory, self.instants)
        path.require_within(self.max_speed, self.max_acceleration)
        hung = None if self.free is None else hanging_along(self.robot, path, self.free, self.model)
        path = path if hung is None else hung.trajectory
        found = []
        for rule in self.rules:
            progress(f"{rule} bound")
            found.append(
                distribute_along(self.robot, path, rule, self.b, longest=self.longest, cost=self.cost, model=self.model)
            )
        told: dict[str, Any] = distribution_json(found[0], found[1:]) | {"warnings": assumed}
        if hung is not None and self.free is not None:
            told = told_on_way(told, self.free.tolist(), path.rotation, float(hung.left_out.max()))
        told, within = with_force_bands(told, found[0], self.asked)
        return DistributeResult(with_extensions(told, self.robot, "distribute", self.model), tuple(found), within)


@answered
def distribute_question(
    robot: RobotLike,
    *,
    bound: str,
    b: float,
    cost: str,
    weights: Numbers | None,
    power: float,
    lower_bound: float | None,
    upper_bound: float | None,
    longest: float,
    model: str,
    max_speed: float,
    max_acceleration: float,
    instants: int | None,
    compare: str | Iterable[str],
    payload: float,
    mass: float | None,
    wrench: Numbers | None,
    temperature: float | None,
    free: FreeAngles | None = None,
    band: float | None = None,
    samples: int | None = None,
) -> DistributeQuestion:
    """What the arguments of `distribute` ask of any trajectory.

    Raises
    ------
    InputError : an unusable argument.
    """
    rules = _rules(bound, compare)
    real(b, "b", "give a number above zero", 0.0, math.inf)
    for name, value in (("longest", longest), ("max_speed", max_speed), ("max_acceleration", max_acceleration)):
        if value != math.inf:
            real(value, name, "give a number above zero", 0.0, math.inf)
    chosen, asked = one_of(model, "model", MODELS), read_band(band, samples)
    if asked is not None:
        one_of(chosen, "model", BANDED_MODELS)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature)
    require_locked_lengths(machine, "distribute chooses the tensions of all cables itself")
    price = _cost(cost, weights, power, machine)
    hung = None
    if free is not None:
        if len(machine.cables) < 6:
            raise InputError("free", "", free, "forces are distributed among six cables or more; leave it out")
        if {"rx", "ry", "rz"} & set(machine.guided):
            raise InputError("free", "", free, "leave it out: a guide holds rotations along the trajectory")
        hung = read_free(free, machine, np.zeros(3))[0]
    return DistributeQuestion(
        machine, tuple(rules), b, price, longest, chosen, max_speed, max_acceleration, instants, hung, asked
    )


def _rules(bound: str, compare: str | Iterable[str]) -> list[BoundRule]:
    others = [name for name in compare.split(",") if name] if isinstance(compare, str) else list(compare)
    given = [one_of(bound, "bound", BOUND_RULES), *(one_of(name, "compare", BOUND_RULES) for name in others)]
    return list(dict.fromkeys(given))


def _cost(name: str, weights: Numbers | None, power: float, robot: Robot) -> TensionCost:
    one_of(name, "cost", COSTS)
    if weights is not None and name != "norm":
        raise InputError("weights", "", weights, "weights belong to `cost` norm")
    if name in ("middle", "centre") and not (robot.force_max < math.inf).all():
        hint = f"`cost` {name} needs a finite upper bound, here or as force_max in the robot file"
        raise InputError("upper_bound", "", "nothing", hint)
    if name == "p-norm":
        if not 1.1 <= real(power, "power", "give a number from 1.1 to 6") <= 6.0:
            raise InputError("power", "", power, "give a number from 1.1 to 6")
        return PowerNorm(power)
    if name != "norm":
        return Middle() if name == "middle" else Centre()
    if weights is None:
        return EuclideanNorm()
    values = np.array(read_numbers(weights, "weights", (len(robot.cables),), "weights, one per cable"))
    if not (values > 0.0).all():
        raise InputError("weights", "", weights, "weights must be above zero")
    return EuclideanNorm(values)

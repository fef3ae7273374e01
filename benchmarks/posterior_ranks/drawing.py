"""Causes whose size is drawn from the prior that the diagnosis has of it, beside tolerances, as a static campaign."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.fem_reference import FemError
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.hypothesis import SCALES
from tests.blind.case_drawing import Case, CaseKind, truth_record
from tests.blind.deviations import Deviations, tolerance_columns
from tests.blind.entered_robot import EnteredRobot, entered_robot
from tests.blind.measuring_plan import PlanSize, drawn_plan
from tests.blind.observation import SlackStateError, observed
from tests.blind.sensors import Noise, filed

ROBOTS = ("thesis-3-1", "cogiro")
_SIZE = PlanSize(static_states=8, locks=2, loads_per_lock=3, frequency_states=0)
_ATTEMPTS = 60
_LEAST_MASS = 0.5  # of the platform

Filled = Callable[[np.ndarray, EnteredRobot], np.ndarray]


def _as_it_is(theta: np.ndarray, robot: EnteredRobot) -> np.ndarray:
    return theta


def _common(theta: np.ndarray, robot: EnteredRobot) -> np.ndarray:
    return np.full(robot.cables, theta[0])


def _mass(theta: np.ndarray, robot: EnteredRobot) -> np.ndarray:
    return robot.mass * np.expm1(theta)


def _tilt(theta: np.ndarray, robot: EnteredRobot) -> np.ndarray:
    """Gravity's share along x and y, as a rotation of it."""
    return np.array([theta[1], -theta[0]])


@dataclass(frozen=True, slots=True)
class Sized:
    """A cause as the study draws it.

    carrier : "cable" if one cable has it, of which it is the `numbers` numbers, else ""
    filled : its field of the true robot from the numbers;  common : it is what all cables have together
    """

    cause: str
    filled: Filled = field(default=_as_it_is)
    carrier: str = ""
    common: bool = False

    def pattern(self, cable: int) -> str:
        """Label of the diagnosis."""
        return f"cable {cable + 1} alone" if self.carrier else "all alike" if self.common else ""


CAUSES = (
    Sized("axial_stiffness", _common, common=True),
    Sized("cable_linear_density", _common, common=True),
    Sized("platform_mass", _mass),
    Sized("drum_scale", lambda theta, robot: np.expm1(theta), common=True),
    Sized("temperature"),
    Sized("unstrained_length_offset", carrier="cable"),
    Sized("center_of_mass"),
    Sized("external_force"),
    Sized("gravity_tilt", _tilt),
    Sized("frame_anchor_position", carrier="cable"),
)


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """A campaign with its cause.

    label : of the pattern in which it occurs;  theta : (d,) whole change, tolerances of the same numbers included, the
        mean of all cables where these are alike
    chosen : the number, from 0, whose rank counts;  scale : of the prior from which it was drawn
    """

    case: Case
    cause: str
    label: str
    theta: np.ndarray
    chosen: int
    scale: float
    passed_over: int


def drawn(seed: int) -> Drawn:
    """The first campaign of a seed that the true robot can make; causes take turns.

    Raises
    ------
    RuntimeError : none of many is.
    """
    for attempt in range(_ATTEMPTS):
        try:
            return _attempt(seed, attempt)
        except (SlackStateError, FemError, RuntimeError):
            continue
    raise RuntimeError(f"seed {seed}: none of {_ATTEMPTS} campaigns can be made")


def _attempt(seed: int, attempt: int) -> Drawn:
    sized = CAUSES[seed % len(CAUSES)]
    rng = np.random.default_rng([seed, attempt, 36])
    robot = entered_robot(ROBOTS[seed // len(CAUSES) % len(ROBOTS)])
    cable = int(rng.integers(robot.cables))
    prior = np.array([p.prior for p in LIBRARY[sized.cause].parameters])
    scale = float(rng.choice(SCALES))
    theta = scale * prior * rng.standard_normal(len(prior))
    deviations, beside = _tolerances(robot, sized, cable, rng)
    deviations = deviations.plus(sized.cause, _field(sized, robot, cable, theta))
    if robot.mass + deviations["platform_mass"][0] < _LEAST_MASS * robot.mass:
        raise SlackStateError
    plan = drawn_plan(robot, rng, deviations, _SIZE)
    seen = observed(robot, deviations, plan)
    whole = np.log1p(deviations["platform_mass"] / robot.mass) if sized.filled is _mass else theta + beside
    kind = CaseKind("single", ((sized.cause, 0.0),), statics=True, size=_SIZE, robot=robot.name)
    case = Case(
        robot, filed(plan, seen, deviations, Noise(rng, "white"), True), truth_record(kind, robot, [], deviations)
    )
    return Drawn(case, sized.cause, sized.pattern(cable), whole, int(rng.integers(len(whole))), scale, attempt)


def _field(sized: Sized, robot: EnteredRobot, cable: int, theta: np.ndarray) -> np.ndarray:
    if not sized.carrier:
        return sized.filled(theta, robot)
    change = np.zeros((robot.cables, len(theta)))
    change[cable] = theta
    return change.ravel()


def _tolerances(
    robot: EnteredRobot, sized: Sized, cable: int, rng: np.random.Generator
) -> tuple[Deviations, np.ndarray]:
    """One robot as it may leave the workshop, and what of it changes the very numbers of the cause."""
    drawn, numbers = Deviations.none(robot.cables), len(LIBRARY[sized.cause].parameters)
    beside = np.zeros(numbers)
    for name, change in tolerance_columns(robot.cables):
        if name == "pulley_radius" and robot.pulley_radius is None:
            continue
        off = float(rng.standard_normal()) * change
        drawn = drawn.plus(name, off)
        if name == sized.cause:
            beside = beside + _of_the_cause(off.reshape(-1, numbers), sized, cable)
    return drawn, beside


def _of_the_cause(off: np.ndarray, sized: Sized, cable: int) -> np.ndarray:
    """(d,) of changes (carriers, d): those of one cable, or the mean of all, which is the size of what they share."""
    return np.asarray(off[cable] if sized.carrier else off.mean(axis=0))

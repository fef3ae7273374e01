"""Which change of a robot brings one of its frequencies to a wanted value, the pose held?

A design is changed, not a robot that stands: at each trial the cables hold the pose anew, with the tensions of least
norm, and the frequency is that of `modes`. So what is found stands when the changed robot is entered.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import inverse

_STEPS = 0.02 * 2.0 ** np.arange(8)  # of ln p: up to a factor of 13
_CLOSE = 1e-9  # relative, of the frequency that is reached
_CLOSEST = 1e-13  # of ln p
_SLOPE = 1e-3  # step of ln p to either side for a slope
_ROUNDS = 30  # of the search for a combination


def _stiffness(robot: Robot, factor: float) -> Robot:
    cables = (replace(cable, axial_stiffness=cable.axial_stiffness * factor) for cable in robot.cables)
    return replace(robot, cables=tuple(cables))


def _density(robot: Robot, factor: float) -> Robot:
    cables = (replace(cable, linear_density=cable.linear_density * factor) for cable in robot.cables)
    return replace(robot, cables=tuple(cables))


def _mass(robot: Robot, factor: float) -> Robot:
    return robot.with_load(mass=robot.platform.mass * factor)


def _inertia(robot: Robot, factor: float) -> Robot:
    return replace(robot, platform=replace(robot.platform, inertia=robot.platform.inertia * factor))


def _platform(robot: Robot, factor: float) -> Robot:
    return replace(robot, platform_anchors=robot.platform_anchors * factor)


def _frame(robot: Robot, factor: float) -> Robot:
    middle = robot.frame_anchors.mean(axis=0)
    return replace(robot, frame_anchors=middle + factor * (robot.frame_anchors - middle))


KNOBS: dict[str, Callable[[Robot, float], Robot]] = {
    "axial_stiffness": _stiffness,
    "linear_density": _density,
    "platform_mass": _mass,
    "platform_inertia": _inertia,
    "platform_anchors": _platform,
    "frame_anchors": _frame,
}
"""What may be scaled: of all cables alike, of the platform, places of the anchors about origin and middle."""
LEAST_TENSION = "lower_bound"
"""The smallest tension at the platform, which is raised for more preload [N]."""


@dataclass(frozen=True, slots=True)
class Change:
    """Parameters by name and the factors on them (the bound in N), and the frequency there; None: not reached, and
    `hertz` is the nearest of the trials."""

    factors: dict[str, float] | None
    hertz: float


@dataclass(frozen=True, slots=True, eq=False)
class Design:
    """One frequency of a robot that holds a pose.

    mode : from 0, counted from the lowest;  model, assembly : static, dsm or exact, as for `modes`
    """

    robot: Robot
    pose: Pose
    mode: int
    model: CableModel
    assembly: Assembly

    def frequency(self, factors: dict[str, float]) -> float:
        """Of the robot with factors on some of `KNOBS` and perhaps the bound [Hz].

        Raises
        ------
        CdprError, ValueError : this robot does not hold the pose, or cannot be.
        """
        changed = self.changed(factors)
        held = inverse(changed, self.pose.position, self.pose.rotation)
        point = OperatingPoint(changed, self.pose.position, self.pose.rotation, held.cables)
        found = certified_modes(point, self.model, self.mode + 1, self.assembly)
        return float(found.frequencies.hertz[self.mode])

    def changed(self, factors: dict[str, float]) -> Robot:
        """The robot with these factors."""
        robot = self.robot
        for name, factor in factors.items():
            robot = robot.with_force_limits(factor) if name == LEAST_TENSION else KNOBS[name](robot, factor)
        return robot

    def alone(self, name: str, wanted: float) -> Change:
        """Factor on one parameter that brings the frequency to `wanted` [Hz]."""
        places = np.concatenate([-_STEPS[::-1], [0.0], _STEPS])
        return self._reached(lambda place: {name: float(np.exp(place))}, places, 0.0, wanted)

    def by_tension(self, wanted: float) -> Change:
        """Bound of the tensions that brings the frequency to `wanted` [Hz]."""
        held = inverse(self.robot, self.pose.position, self.pose.rotation)
        least = max(float(held.tensions.min()), 1e-3 * float(held.tensions.max()))
        places = np.log(least) + np.concatenate([[0.0], np.geomspace(0.02, 4.0, 14)])
        return self._reached(lambda place: {LEAST_TENSION: float(np.exp(place))}, places, float(places[0]), wanted)

    def _reached(
        self, factors: Callable[[float], dict[str, float]], places: np.ndarray, origin: float, wanted: float
    ) -> Change:
        """On the way of one parameter through `places`, ascending: of all brackets the one nearest to the origin."""

        def off(place: float) -> float:
            return float(np.log(self.frequency(factors(place)) / wanted))

        found = np.array([_tried(off, float(place)) for place in places])
        brackets = np.flatnonzero(found[1:] * found[:-1] <= 0.0)
        if not len(brackets):
            known = found[np.isfinite(found)]
            return Change(None, wanted * float(np.exp(known[np.argmin(np.abs(known))])) if len(known) else np.nan)
        middle = 0.5 * (places[brackets] + places[brackets + 1])
        first = int(brackets[np.argmin(np.abs(middle - origin))])
        place = float(brentq(off, places[first], places[first + 1], xtol=_CLOSEST, rtol=_CLOSEST))
        return Change(factors(place), self.frequency(factors(place)))

    def together(self, wanted: float, names: Sequence[str] = tuple(KNOBS)) -> Change:
        """Factors on several parameters of least sum of squared logarithms: a per cent costs the same of each.

        Where modes change places, slopes mislead: from the nearest point that they led to, all changes are then raised
        in proportion.
        """
        place, hertz = np.zeros(len(names)), self.frequency({})
        for _ in range(_ROUNDS):
            if abs(hertz / wanted - 1.0) <= _CLOSE:
                return Change(dict(zip(names, np.exp(place).tolist(), strict=True)), hertz)
            slope = self._slope(names, place)
            goal = slope * ((np.log(wanted / hertz) + slope @ place) / max(float(slope @ slope), 1e-300))
            there, found = self._stepped(names, place, goal, hertz, wanted)
            if found == hertz:
                break
            place, hertz = there, found

        def raised(share: float) -> dict[str, float]:
            return dict(zip(names, np.exp(share * place).tolist(), strict=True))

        return self._reached(raised, 1.0 + _STEPS, 1.0, wanted) if place.any() else Change(None, hertz)

    def _slope(self, names: Sequence[str], place: np.ndarray) -> np.ndarray:
        """(k,) d ln f / d ln p, by central differences of whole solutions."""
        ways = _SLOPE * np.eye(len(names))
        above, below = (np.array([self._at(names, place + side * way) for way in ways]) for side in (1.0, -1.0))
        return np.asarray(np.log(above / below) / (2.0 * _SLOPE))

    def _stepped(
        self, names: Sequence[str], place: np.ndarray, goal: np.ndarray, hertz: float, wanted: float
    ) -> tuple[np.ndarray, float]:
        """As far towards a goal as brings the frequency nearer to the wanted one, or no step."""
        for share in 0.5 ** np.arange(12):
            there = place + share * (goal - place)
            found = _tried(lambda s, at=there: self._at(names, at), 0.0)  # type: ignore[misc]
            if np.isfinite(found) and abs(np.log(found / wanted)) < abs(np.log(hertz / wanted)):
                return there, found
        return place, hertz

    def _at(self, names: Sequence[str], place: np.ndarray) -> float:
        return self.frequency(dict(zip(names, np.exp(place).tolist(), strict=True)))


def _tried(value: Callable[[float], float], place: float) -> float:
    """A value, nan where the robot cannot be or does not hold the pose."""
    try:
        return value(place)
    except (CdprError, ValueError):
        return float("nan")

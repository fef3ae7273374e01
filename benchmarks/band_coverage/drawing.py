"""Robots with tolerances, and poses that they hold, drawn from a seed; and of which predictions the study takes one."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

import cdpr_struct as cs
from cdpr_struct import Pose, Robot
from cdpr_struct.errors import CdprError
from cdpr_struct.interface.inverse import InverseResult
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_file import builtin_names
from cdpr_struct.robot.tolerances import Tolerances
from tests.random_robots import random_positions, random_robot

FREQUENCIES = 6
_SMALLEST, _LARGEST = 0.3, 2.0  # times the default of each tolerance
_ATTEMPTS = 400
_TURN = np.radians(5.0)


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """robot : with its tolerances;  held : at rest at a pose, by the robot's own numbers;  free : angles that hang
    frequency, component, cable : numbers, from 0, of the predictions that count for limits, drawn beforehand
    passed_over : robots and poses drawn before that no cables hold, or only unstably;  rng : for the true robot
    """

    seed: int
    kind: str
    robot: Robot
    held: InverseResult
    free: str | None
    frequency: int
    component: int
    cable: int
    passed_over: int
    rng: np.random.Generator

    @property
    def pose(self) -> Pose:
        """Where the robot rests as entered."""
        return self.held.pose


def drawn(seed: int) -> Case:
    """The first robot and pose of a seed that are held.

    Raises
    ------
    RuntimeError : none of many is.
    """
    rng = np.random.default_rng([seed, 35])
    kind = str(rng.choice(list(KINDS), p=[0.2, 0.35, 0.3, 0.15]))
    free = "rx,ry,rz" if kind == FEW else None
    for attempt in range(_ATTEMPTS):
        robot, pose = KINDS[kind](rng)
        robot = replace(robot, tolerances=_sizes(rng))
        try:
            held = cs.inverse(robot, pose, free=free)
        except CdprError:
            continue
        if held.answer["stable"] and not held.answer["neutral_freedoms"]:
            mode, component, cable = (int(rng.integers(count)) for count in (FREQUENCIES, 6, len(robot.cables)))
            return Case(seed, kind, robot, held, free, mode, component, cable, attempt, rng)
    raise RuntimeError(f"seed {seed}: none of {_ATTEMPTS} robots of kind {kind!r} is held")


def _sizes(rng: np.random.Generator) -> dict[str, float]:
    """Tolerances of a robot file, each larger or smaller than its default."""
    span = np.log([_SMALLEST, _LARGEST])
    return {
        field.name: getattr(Tolerances(), field.name) * float(np.exp(rng.uniform(*span)))
        for field in fields(Tolerances)
    }


def _built_in(rng: np.random.Generator) -> tuple[Robot, Pose]:
    robot = cs.load_robot(str(rng.choice(builtin_names())))
    extent = np.ptp(robot.frame_anchors, axis=0)
    home = np.zeros(3) if robot.home is None else robot.home.position
    place = home + rng.uniform(-0.15, 0.15, 3) * extent
    return robot, Pose(place, rng.uniform(-_TURN, _TURN, 3))


def _random(rng: np.random.Generator) -> tuple[Robot, Pose]:
    robot = random_robot(rng)
    weight = robot.platform.mass * robot.gravity
    if robot.force_min.any():  # preloaded, from a fifth of the weight to twice of it
        least = weight * 10.0 ** rng.uniform(-0.7, 0.3)
        robot = replace(robot, cables=tuple(replace(cable, force_min=least) for cable in robot.cables))
    return robot, Pose(random_positions(rng, robot, 1)[0], rng.uniform(-_TURN, _TURN, 3))


def _over_pulleys(rng: np.random.Generator) -> tuple[Robot, Pose]:
    robot, pose = _random(rng)
    radius, lean = rng.uniform(0.02, 0.1), rng.uniform(-0.3, 0.3, (len(robot.cables), 2)) * (rng.random() < 0.5)
    return replace(robot, pulleys=tuple(Pulley(radius, np.array([*each, 1.0])) for each in lean)), pose


def _few(rng: np.random.Generator) -> tuple[Robot, Pose]:
    """Three to five cables from above; half of them over pulleys."""
    robot, pose = (_random if rng.random() < 0.5 else _over_pulleys)(rng)
    count = int(rng.integers(3, 6))
    kept = np.round(np.arange(count) * len(robot.cables) / count).astype(int)
    frame = robot.frame_anchors[kept].copy()
    frame[:, 2] = robot.frame_anchors[:, 2].max() + rng.uniform(-0.4, 0.0, count)
    return replace(
        robot,
        cables=tuple(replace(robot.cables[i], force_min=0.0) for i in kept),
        pulleys=tuple(robot.pulleys[i] for i in kept) if any(robot.pulleys) else (),
        frame_anchors=frame,
        platform_anchors=robot.platform_anchors[kept],
    ), pose


FEW = "3 to 5 cables"
KINDS: dict[str, Callable[[np.random.Generator], tuple[Robot, Pose]]] = {
    "built-in": _built_in,
    "random, 6 to 12 cables": _random,
    "random, pulleys": _over_pulleys,
    FEW: _few,
}

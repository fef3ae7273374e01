"""Which states are visited: drawn from a seed inside the workspace of each robot."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference import FemError
from tests.blind.controller import commanded_lengths, hanging, intended_tensions, null_directions
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot, plain_name, wheelless
from tests.blind.true_robot import Command


@dataclass(frozen=True)
class Workspace:
    """Where a robot is sent.

    low, high    : corners of the box of positions [m]
    tilt_deg     : largest angle about each axis
    payloads     : [kg] hung at the platform origin
    most_tension : [N] that the controller allows
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    tilt_deg: float
    payloads: tuple[float, ...]
    most_tension: float


WORKSPACES = {
    "thesis-3-1": Workspace((-2.0, -1.5, 0.3), (2.0, 1.5, 1.5), 10.0, (0.0, 10.0, 20.0), 800.0),
    "cogiro": Workspace((-3.0, -2.0, 0.8), (3.0, 2.0, 2.2), 10.0, (0.0, 25.0, 50.0), 1000.0),
    "thesis-5": Workspace((-3.0, -2.0, 1.5), (3.0, 2.0, 3.5), 2.5, (0.0, 10.0, 20.0), 2000.0),
}
HANGING = (0.0, 5.0, 10.0)  # kg
WORKSPACES |= {
    "two-cables": Workspace((-1.2, 0.45, 1.6), (1.2, 0.45, 2.9), 0.0, HANGING, 800.0),
    "three-cables": Workspace((-0.9, -0.9, 1.2), (0.9, 0.9, 2.6), 0.0, HANGING, 800.0),
    "four-cables": Workspace((-1.2, -1.0, 1.3), (1.2, 1.0, 2.8), 0.0, HANGING, 800.0),
    "six-cables": Workspace((-0.9, -0.9, 1.0), (0.9, 0.9, 2.4), 5.0, HANGING, 800.0),
    "five-cables": Workspace((-1.0, -0.8, 1.3), (1.0, 0.8, 2.4), 0.0, HANGING, 800.0),
}
LEAST_HANGING = 15.0  # N in every cable of a robot that hangs


@dataclass(frozen=True)
class PlanSize:
    """How much is measured."""

    static_states: int = 15
    locks: int = 3
    loads_per_lock: int = 4
    frequency_states: int = 3


@dataclass(frozen=True, eq=False)
class Plan:
    """Commands of every state; the first static states are also those where frequencies are measured.

    statics : one Command a state
    locks   : for each lock the Commands that differ in payload, and in time, alone
    frequency_states : how many of the static states
    """

    statics: tuple[Command, ...]
    locks: tuple[tuple[Command, ...], ...]
    frequency_states: int


def drawn_plan(
    robot: EnteredRobot,
    rng: np.random.Generator,
    deviations: Deviations | None = None,
    size: PlanSize | None = None,
    one_sided: bool = False,
) -> Plan:
    """A plan for one campaign; of the deviations only the controller's own (internal force) matter here."""
    size = size or PlanSize()
    internal = np.zeros(2) if deviations is None else deviations["internal_force"]
    space = workspace(robot)
    statics = []
    for number in range(size.static_states):
        payload = space.payloads[number % len(space.payloads)]
        statics.append(_command(robot, rng, payload, internal, one_sided))
    locks = []
    for _ in range(size.locks):
        empty = _command(robot, rng, 0.0, internal, one_sided)
        step = space.payloads[-1] / (size.loads_per_lock - 1)
        loads = [step * number for number in range(size.loads_per_lock)]
        locks.append(tuple(_reloaded(empty, load) for load in loads))
    return _dated(Plan(tuple(statics), tuple(locks), size.frequency_states))


def _dated(plan: Plan) -> Plan:
    """The same plan with the time of every state: one after the other as they are filed, evenly spaced."""
    first = len(plan.statics)
    last = max(first + sum(len(lock) for lock in plan.locks) - 1, 1)
    statics = tuple(replace(command, day=number / last) for number, command in enumerate(plan.statics))
    locks = []
    for lock in plan.locks:
        locks.append(tuple(replace(command, day=number / last) for number, command in enumerate(lock, start=first)))
        first += len(lock)
    return Plan(statics, tuple(locks), plan.frequency_states)


def workspace(robot: EnteredRobot) -> Workspace:
    """Where a robot is sent, whatever reads its pose."""
    return WORKSPACES[wheelless(plain_name(robot.name))]


def _command(
    robot: EnteredRobot, rng: np.random.Generator, payload: float, internal: np.ndarray, one_sided: bool
) -> Command:
    if robot.hangs:
        return _hung(robot, rng, payload)
    position, rotation, tensions = _reachable(robot, rng, payload)
    tensions = tensions + null_directions(robot, position, rotation) @ internal
    sides = rng.choice([-1.0, 1.0], robot.cables)
    approach = np.ones(robot.cables) if one_sided else sides
    lengths = commanded_lengths(robot, position, rotation, payload, tensions)
    return Command(lengths, payload, approach, position, rotation)


def _hung(robot: EnteredRobot, rng: np.random.Generator, payload: float) -> Command:
    """Lengths of a level platform near which the robot comes to rest, all its cables taut."""
    space = workspace(robot)
    while True:
        wanted = rng.uniform(space.low, space.high)
        approach = rng.choice([-1.0, 1.0], robot.cables)
        try:
            lengths, position, rotation, tensions = hanging(robot, wanted, payload)
        except FemError:
            continue
        if tensions.min() >= LEAST_HANGING and tensions.max() <= space.most_tension:
            return Command(lengths, payload, approach, position, rotation)


def _reachable(
    robot: EnteredRobot, rng: np.random.Generator, payload: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A pose, most of them tilted, that tensions within the bounds hold."""
    space = workspace(robot)
    while True:
        position = rng.uniform(space.low, space.high)
        angles = rng.uniform(-space.tilt_deg, space.tilt_deg, 3) * (rng.random() < 0.7)
        rotation = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
        tensions = intended_tensions(robot, position, rotation, payload)
        if tensions is not None and tensions.max() <= space.most_tension:
            return position, rotation, tensions


def _reloaded(command: Command, payload: float) -> Command:
    return Command(command.lengths, payload, command.approach, command.position, command.rotation)


def angles_deg(rotation: np.ndarray) -> np.ndarray:
    """(rx, ry, rz) [deg] with R = Rz Ry Rx."""
    rx = math.atan2(rotation[2, 1], rotation[2, 2])
    ry = math.atan2(-rotation[2, 0], math.hypot(rotation[2, 1], rotation[2, 2]))
    rz = math.atan2(rotation[1, 0], rotation[0, 0])
    return np.degrees([rx, ry, rz])

"""What there is to be seen of the real robot, before any sensor: poses, end tensions, frequencies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.fem_reference import CableEquilibrium, RobotEquilibrium, Wrap
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import UP, EnteredRobot
from tests.blind.measuring_plan import Plan
from tests.blind.true_robot import Command, at_rest
from tests.blind.vibrations import in_plane_frequencies, robot_frequencies

ELEMENTS = 40  # bars a cable
SLACK = 10.0  # N, below which the generator draws again


@dataclass(frozen=True, eq=False)
class Rest:
    """One state at rest.

    position, rotation : (3,) [m], (3, 3)
    tensions           : (m,) [N] at the platform
    exit_angles        : (m,) [rad] by which a cable that comes up from its winch turns at its exit
    """

    position: np.ndarray
    rotation: np.ndarray
    tensions: np.ndarray
    exit_angles: np.ndarray

    @classmethod
    def of(cls, equilibrium: RobotEquilibrium) -> Rest:
        """What is seen of an equilibrium."""
        tensions = np.array([np.linalg.norm(cable.end_force) for cable in equilibrium.cables])
        angles = np.array([_turn(cable) for cable in equilibrium.cables])
        return cls(equilibrium.position, equilibrium.rotation, tensions, angles)


def _turn(cable: CableEquilibrium) -> float:
    """Angle [rad] of a cable's pull at its exit from the upward axis: over a pulley, what it wraps."""
    if isinstance(cable.wrap, Wrap):
        return cable.wrap_angle
    return float(np.arccos(-cable.start_force @ UP / np.linalg.norm(cable.start_force)))


@dataclass(frozen=True, eq=False)
class Observation:
    """statics, locks : as in the plan. cable_hz : (states, m, 4). robot_hz, shares : (states, k).
    robot_shapes : (states, k, 6) motion of the platform [m, rad], modal mass 1 kg."""

    statics: tuple[Rest, ...]
    locks: tuple[tuple[Rest, ...], ...]
    cable_hz: np.ndarray
    robot_hz: np.ndarray
    shares: np.ndarray
    robot_shapes: np.ndarray


class SlackStateError(Exception):
    """A cable of the real robot hangs slack at a planned state: the campaign is drawn again."""


def observed(robot: EnteredRobot, deviations: Deviations, plan: Plan, elements: int = ELEMENTS) -> Observation:
    """Everything that the plan asks for, noise free."""
    rests = [at_rest(robot, deviations, command, elements) for command in plan.statics]
    loaded = tuple(tuple(Rest.of(at_rest(robot, deviations, c, elements)) for c in lock) for lock in plan.locks)
    seen = tuple(Rest.of(rest) for rest in rests)
    if min(float(rest.tensions.min()) for rest in seen) < SLACK:
        raise SlackStateError
    cables, robots, shares, shapes = [], [], [], []
    for number in range(plan.frequency_states):
        cable, whole, share, shape = _frequencies(robot, deviations, plan.statics[number], rests[number])
        cables.append(cable)
        robots.append(whole)
        shares.append(share)
        shapes.append(shape)
    found = (np.array(own) for own in (cables, robots, shares, shapes))
    return Observation(seen, loaded, *found)


def _frequencies(
    robot: EnteredRobot, deviations: Deviations, command: Command, fine: RobotEquilibrium
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Cable frequencies, extrapolated from meshes of n and n / 2 bars; robot frequencies, energy shares and shapes."""
    if np.any(deviations["accelerometer_mass"]):  # sensors hang on the platform while it vibrates, and pull at it
        command = replace(command, payload=command.payload + float(deviations["accelerometer_mass"][0]))
        fine = at_rest(robot, deviations, command, fine.elements)
    coarse = at_rest(robot, deviations, command, fine.elements // 2)
    cable = [in_plane_frequencies(rest) for rest in (fine, coarse)]
    return (4.0 * cable[0] - cable[1]) / 3.0, *robot_frequencies(robot, deviations, fine)

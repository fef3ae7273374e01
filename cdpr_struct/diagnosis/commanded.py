"""What the simulation commands where no encoder was read: lengths, and the null space in which tensions may differ."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

_STEP = 1e-4  # [m, rad]
_REACH = 2e-3  # [m, rad]: so far may the commanded pose be from the measured one
_MOST_BEND = 3e-4  # [m]: beyond, another cable is at its lower bound there, and the command says little
_TAUT = 3.0  # times the weight of a cable: below this tension its length says little of its tension


@dataclass(frozen=True, slots=True, eq=False)
class Commanded:
    """Of each held state (k); zero where lengths were read.

    null_space (k, m, q) : of the structure matrix, orthonormal; zero too where the command is uncertain
    lengths (k, m) : that the simulation commands [m]
    rate (k, q, q) : change of these along the null space a newton of an internal force alike everywhere [m/N]
    slope (k, q, 6) : change of these along the null space with the pose that is commanded [m/m, m/rad]
    """

    null_space: np.ndarray
    lengths: np.ndarray
    rate: np.ndarray
    slope: np.ndarray


def commanded(campaign: Campaign, held: np.ndarray) -> Commanded:
    """Commands at the held states of a campaign, of a controller that knows nothing of the robot's extensions."""
    campaign = replace(campaign, robot=campaign.robot.without_extensions())
    states, robot = campaign.states, campaign.robot
    m = len(robot.cables)
    q = max(m - 6, 0)
    shapes = ((m, q), (m,), (q, q), (q, 6))
    found = Commanded(*(np.zeros((len(held), *shape)) for shape in shapes))
    turn = Readings.of(states).rotation
    free = np.flatnonzero(~states.has_length[held]) if q else np.zeros(0, dtype=int)
    if free.size:
        reference = null_space(robot, states.position[held[free[0]]], turn[held[free[0]]])
    for load in np.unique(states.payload[held[free]]):
        own = free[states.payload[held[free]] == load]
        around = _around(campaign, load, states.position[held[own]], turn[held[own]])
        for k, near in zip(own, around, strict=True):
            null = null_space(robot, states.position[held[k]], turn[held[k]])
            found.lengths[k] = near.lengths
            taut = near.tensions > _TAUT * robot.linear_density * robot.gravity * near.lengths
            if taut.all() and np.abs(null.T @ near.bend).max() < _MOST_BEND:
                left, _, right = np.linalg.svd(null @ null.T @ reference, full_matrices=False)
                found.null_space[k] = null
                found.rate[k] = null.T @ (near.rate[:, None] * (left @ right)) * np.sqrt(m)
                found.slope[k] = null.T @ near.slope
    return found


def simulated(campaign: Campaign, payload: float, position: np.ndarray, rotation: np.ndarray) -> InverseSolution:
    """The simulation's lengths and tensions at poses (...) with a payload."""
    robot = campaign.robot.with_load(float(payload))
    return inverse(robot, position, rotation, campaign.cable_model, lower_bound=campaign.lower_bound, allow_unheld=True)


@dataclass(frozen=True, slots=True, eq=False)
class _Near:
    """Commands at a pose: lengths, tensions and `length_rate` (m,), and how the lengths change with the pose.

    slope (m, 6) : per metre and radian;  bend (m, 6) : by how much they bend within `_REACH`
    """

    lengths: np.ndarray
    tensions: np.ndarray
    rate: np.ndarray
    slope: np.ndarray
    bend: np.ndarray


def _around(campaign: Campaign, payload: float, position: np.ndarray, rotation: np.ndarray) -> list[_Near]:
    """At poses (k, 3), (k, 3, 3) with one payload."""
    steps = np.concatenate([np.zeros((1, 6)), *(s * np.eye(6) for s in (_STEP, -_STEP, _REACH, -_REACH))])
    turned = rotation_from_vector(steps[:, 3:]) @ rotation[:, None]
    solution = simulated(campaign, payload, position[:, None] + steps[:, :3], turned)
    rates = length_rate(solution.cables)
    found = []
    for lengths, tensions, rate in zip(solution.lengths, solution.tensions, rates, strict=True):
        middle, up, down, far, back = lengths[:1], *np.split(lengths[1:], 4)
        slope, bend = (up - down).T / (2.0 * _STEP), (far + back - 2.0 * middle).T
        found.append(_Near(lengths[0], tensions[0], rate[0], slope, bend))
    return found


def null_space(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(m, m - 6) orthonormal internal forces of straight cables at a pose."""
    arms = robot.platform_anchors @ rotation.T
    away = robot.frame_anchors - position - arms
    unit = away / np.linalg.norm(away, axis=1, keepdims=True)
    matrix = np.concatenate([unit, np.cross(arms, unit)], axis=1).T
    result: np.ndarray = np.linalg.svd(matrix)[2][6:].T
    return result


def length_rate(cables: CableStates) -> np.ndarray:
    """(..., m) change of unstrained length a newton of tension between fixed ends, sag as a parabola [m/N]."""
    across = cables.weight * np.cos(cables.inclination) * cables.chord
    result: np.ndarray = -cables.chord * (1.0 / cables.axial_stiffness + across**2 / (12.0 * cables.tension**3))
    return result

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
    turn, reference = Readings.of(states).rotation, np.zeros((m, q))
    for k, i in enumerate(held):
        if states.has_length[i] or not q:
            continue
        null = null_space(robot, states.position[i], turn[i])
        reference = reference if reference.any() else null
        solution = simulated(campaign, int(i), states.position[i], turn[i])
        found.lengths[k] = solution.lengths
        slope, bend = _pose_slope(campaign, int(i), states.position[i], turn[i])
        taut = solution.tensions > _TAUT * robot.linear_density * robot.gravity * solution.lengths
        if taut.all() and np.abs(null.T @ bend).max() < _MOST_BEND:
            left, _, right = np.linalg.svd(null @ null.T @ reference, full_matrices=False)
            found.null_space[k] = null
            found.rate[k] = null.T @ (length_rate(solution.cables)[:, None] * (left @ right)) * np.sqrt(m)
            found.slope[k] = null.T @ slope
    return found


def simulated(campaign: Campaign, state: int, position: np.ndarray, rotation: np.ndarray) -> InverseSolution:
    """The simulation's lengths and tensions at poses (...) with a state's payload."""
    robot = campaign.robot.with_load(float(campaign.states.payload[state]))
    return inverse(robot, position, rotation, campaign.cable_model, lower_bound=campaign.lower_bound, allow_unheld=True)


def _pose_slope(
    campaign: Campaign, state: int, position: np.ndarray, rotation: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(m, 6) change of the commanded lengths with the pose, and by how much (m, 6) it bends within `_REACH`."""
    steps = np.concatenate([np.zeros((1, 6)), *(s * np.eye(6) for s in (_STEP, -_STEP, _REACH, -_REACH))])
    lengths = simulated(campaign, state, position + steps[:, :3], rotation_from_vector(steps[:, 3:]) @ rotation).lengths
    middle, up, down, far, back = lengths[:1], *np.split(lengths[1:], 4)
    return (up - down).T / (2.0 * _STEP), (far + back - 2.0 * middle).T


def null_space(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(m, m - 6) orthonormal internal forces of straight cables at a pose."""
    arms = robot.platform_anchors @ rotation.T
    away = robot.frame_anchors - position - arms
    unit = away / np.linalg.norm(away, axis=1, keepdims=True)
    matrix = np.concatenate([unit, np.cross(arms, unit)], axis=1).T
    result: np.ndarray = np.linalg.svd(matrix)[2][6:].T
    return result


def length_rate(cables: CableStates) -> np.ndarray:
    """(m,) change of unstrained length a newton of tension between fixed ends, sag as a parabola [m/N]."""
    across = cables.weight * np.cos(cables.inclination) * cables.chord
    result: np.ndarray = -cables.chord * (1.0 / cables.axial_stiffness + across**2 / (12.0 * cables.tension**3))
    return result

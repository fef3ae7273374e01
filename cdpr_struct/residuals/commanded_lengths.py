"""What the simulation commands where no encoder was read: lengths, as far as they say anything of the tensions.

The commanded pose is not known: the platform missed it by as much as robot and simulation differ. So a commanded length
is a reading whose error follows the pose by six numbers; what these cannot make is internal force.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

MISSED = np.repeat([5e-3, 5e-3], 3)
"""One sigma of how far a robot misses what it is sent to, [m] and [rad]: millimetres, as calibrated robots do."""
SIGMA = 2e-4  # m, of a commanded length: the distribution is straight within this over the poses that may be meant
_STEP = 1e-4  # [m, rad]
_REACH = 2e-3  # [m, rad]: so far may the commanded pose be from the measured one
_TAUT = 3.0  # times the weight of a cable: below this tension its length says little of its tension


@dataclass(frozen=True, slots=True, eq=False)
class Commanded:
    """Of S states; nan and zero where lengths were read, or a command says nothing.

    lengths (S, m) [m];  slope (S, m, 6) : their change with the pose that is meant [m/m, m/rad]
    internal (S, m, q) : their change a newton of internal force along q directions, alike everywhere, of norm sqrt(m)
    """

    lengths: np.ndarray
    slope: np.ndarray
    internal: np.ndarray

    @property
    def known(self) -> np.ndarray:
        """(S,) bool."""
        return np.isfinite(self.lengths).all(axis=1)


def commanded(campaign: Campaign, position: np.ndarray, rotation: np.ndarray) -> Commanded:
    """At the measured poses (S, 3), (S, 3, 3), by a controller that knows nothing of the robot's extensions."""
    return commanded_at(campaign, position, rotation, ~np.isfinite(campaign.states.length).any(axis=1))


def commanded_at(campaign: Campaign, position: np.ndarray, rotation: np.ndarray, some: np.ndarray) -> Commanded:
    """The same for some (S,) bool of the static states, encoders read or not."""
    states, robot = campaign.states, campaign.robot.without_extensions()
    s, m = states.tension.shape
    q = max(m - 6, 0)
    found = Commanded(np.full((s, m), np.nan), np.zeros((s, m, 6)), np.zeros((s, m, q)))
    read = np.isfinite(states.tension).any(axis=1) & np.isfinite(states.position).all(axis=1)
    free = np.flatnonzero(states.static & read & some & (q > 0))
    if not len(free):
        return found
    plain = replace(campaign, robot=robot)
    reference = null_space(robot, position[free[0]], rotation[free[0]])
    for load in np.unique(states.payload[free]):
        own = free[states.payload[free] == load]
        for k, near in zip(own, _around(plain, load, position[own], rotation[own]), strict=True):
            null = null_space(robot, position[k], rotation[k])
            taut = near.tensions > _TAUT * robot.linear_density * robot.gravity * near.lengths
            # where they bend more, another cable is at its lower bound nearby, and the command says little
            if taut.all() and np.abs(null.T @ near.bend).max() < SIGMA:
                found.lengths[k], found.slope[k] = near.lengths, near.slope
                found.internal[k] = near.rate[:, None] * aligned(null, reference)
    return found


def aligned(null: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(m, q) basis of internal forces `null` turned as near to `reference` (m, q) as the pose allows, of norm sqrt(m).

    So one newton along a direction is one newton rms over the cables, and means the same at every pose.
    """
    left, _, right = np.linalg.svd(null @ null.T @ reference, full_matrices=False)
    return np.asarray(left @ right * np.sqrt(len(null)))


@dataclass(frozen=True, slots=True, eq=False)
class _Near:
    """At a pose: lengths, tensions and change of length a newton (m,), and how the lengths change with the pose.

    slope (m, 6) : per metre and radian;  bend (m, 6) : by how much they are off a straight line within `_REACH`
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
    solution = _simulated(campaign, payload, position[:, None] + steps[:, :3], turned)
    rates, found = _length_rate(solution.cables), []
    for lengths, tensions, rate in zip(solution.lengths, solution.tensions, rates, strict=True):
        middle, up, down, far, back = lengths[:1], *np.split(lengths[1:], 4)
        slope, bend = (up - down).T / (2.0 * _STEP), 0.5 * (far + back - 2.0 * middle).T
        found.append(_Near(lengths[0], tensions[0], rate[0], slope, bend))
    return found


def _simulated(campaign: Campaign, payload: float, position: np.ndarray, rotation: np.ndarray) -> InverseSolution:
    robot = campaign.robot.with_load(float(payload))
    return inverse(robot, position, rotation, campaign.cable_model, lower_bound=campaign.lower_bound, allow_unheld=True)


def null_space(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(m, m - 6) orthonormal internal forces of straight cables at a pose."""
    arms = robot.platform_anchors @ rotation.T
    away = robot.frame_anchors - position - arms
    unit = away / np.linalg.norm(away, axis=1, keepdims=True)
    matrix = np.concatenate([unit, np.cross(arms, unit)], axis=1).T
    return np.asarray(np.linalg.svd(matrix)[2][6:].T)


def _length_rate(cables: CableStates) -> np.ndarray:
    """(..., m) change of unstrained length a newton of tension between fixed ends, sag as a parabola [m/N]."""
    across = cables.weight * np.cos(cables.inclination) * cables.chord
    return np.asarray(-cables.chord * (1.0 / cables.axial_stiffness + across**2 / (12.0 * cables.tension**3)))

"""Where a robot could be measured next: poses about the campaign's middle that it holds with all cables taut."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.readings import LEAST_TENSION
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

STEP = 0.15  # of the frame's width, and of the platform's mass: a step to another pose, or of a payload
RAISED, STEP_LOAD = 2.0 * STEP, 2.0 * STEP  # of the height below the frame anchors, of the platform's mass
PAYLOADS, LOCKED = (STEP, 2.0 * STEP, 3.0 * STEP), (0.0, STEP, 2.0 * STEP)  # of a series, and at locked lengths
TILT = np.radians(10.0)
AXES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
CORNERS = ((1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1), (0, 0, 1), (0, 0, -1))


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A pose with a payload: position (3,) [m], angles (3,) rx, ry, rz [rad], payload [kg]."""

    position: np.ndarray
    angles: np.ndarray
    payload: float


def home_of(campaign: Campaign) -> Place:
    """The pose of the state nearest to the mean position, without payload."""
    states = campaign.states
    posed = np.flatnonzero(np.isfinite(states.position).all(axis=1) & np.isfinite(states.angles).all(axis=1))
    position = states.position[posed]
    nearest = posed[int(np.linalg.norm(position - position.mean(axis=0), axis=1).argmin())]
    return Place(states.position[nearest], states.angles[nearest], 0.0)


def moved(campaign: Campaign, home: Place, directions: Sequence[Sequence[int]]) -> list[Place]:
    """Home shifted by a step along each axis times (-1, 0 or 1)."""
    anchors = campaign.robot.frame_anchors
    width, above = np.ptp(anchors, axis=0), abs(float(anchors[:, 2].mean() - home.position[2]))
    steps = np.array([STEP * width[0], STEP * width[1], RAISED * above])
    return [Place(home.position + steps * np.array(way), home.angles, 0.0) for way in directions]


def tilted(home: Place) -> list[Place]:
    """Home turned by 10 degrees either way about each axis."""
    ways = [sign * axis for axes in (np.eye(3)[:2], np.eye(3)[2:]) for sign in (1.0, -1.0) for axis in axes]
    return [Place(home.position, home.angles + TILT * way, 0.0) for way in ways]


def loaded(campaign: Campaign, home: Place, shares: Sequence[float]) -> list[Place]:
    """Home with payloads, two digits of these shares of the platform's mass."""
    return [Place(home.position, home.angles, float(f"{share * campaign.robot.platform.mass:.2g}")) for share in shares]


def held(campaign: Campaign, places: Sequence[Place]) -> tuple[np.ndarray, InverseSolution]:
    """Whether each place (S,) is held with all cables taut, and how."""
    robot = RobotArrays.of(campaign.robot).with_point_masses(np.array([[p.payload] for p in places]), np.zeros(3))
    turn = np.array([rotation(*p.angles) for p in places])
    found = inverse(
        robot, np.array([p.position for p in places]), turn, campaign.cable_model, lower_bound=campaign.lower_bound,
        allow_unheld=True,
    )  # fmt: skip
    return found.held & (found.tensions.min(axis=-1) > LEAST_TENSION), found


def angles_of(turn: np.ndarray) -> np.ndarray:
    """rx, ry, rz [rad] of R = Rz Ry Rx."""
    return np.array(
        [np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(np.clip(turn[2, 0], -1.0, 1.0)),
         np.arctan2(turn[1, 0], turn[0, 0])]
    )  # fmt: skip

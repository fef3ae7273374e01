"""Where a robot could be measured next: poses about the campaign's middle that it holds with all cables taut."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

ASIDE, RAISED = 0.15, 0.25  # of the frame's width, of the height below the frame anchors: steps to another pose
TILT = np.radians(10.0)
STEP_LOAD = 0.25  # of the platform's mass
PAYLOADS, LOCKED = (0.15, 0.3, 0.45), (0.0, 0.15, 0.3)  # likewise, of a series, and of one at locked lengths
AXES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
CORNERS = ((1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1), (0, 0, 1), (0, 0, -1))
_LEAST = 0.02  # of the platform's weight: tension that every cable must have


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
    steps = np.array([ASIDE * width[0], ASIDE * width[1], RAISED * above])
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
    weight = campaign.robot.platform.mass * campaign.robot.gravity
    return found.held & (found.tensions.min(axis=-1) > _LEAST * weight), found


def angles_of(turn: np.ndarray) -> np.ndarray:
    """rx, ry, rz [rad] of R = Rz Ry Rx."""
    return np.array(
        [np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(np.clip(turn[2, 0], -1.0, 1.0)),
         np.arctan2(turn[1, 0], turn[0, 0])]
    )  # fmt: skip

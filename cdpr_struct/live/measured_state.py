"""What a campaign measured in a state, beside what the robot's model predicts there."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.errors import CdprError
from cdpr_struct.live.controls import Controls
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.readings import cell_reading
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredState:
    """Readings of one state of a robot with m cables; nan where nothing was read or nothing can be predicted.

    controls : the measured pose and payload
    tension, predicted_tension, tension_sigma : (m,) at the platform [N]
    length, predicted_length, length_sigma    : (m,) unstrained, as the encoders say [m]
    missed : (3,) measured position less that computed at the measured lengths, world [m]
    """

    name: str
    controls: Controls
    tension: np.ndarray
    predicted_tension: np.ndarray
    tension_sigma: np.ndarray
    length: np.ndarray
    predicted_length: np.ndarray
    length_sigma: np.ndarray
    missed: np.ndarray

    @property
    def tension_residual(self) -> np.ndarray:
        """(m,) measured less predicted [N]."""
        return self.tension - self.predicted_tension

    @property
    def length_residual(self) -> np.ndarray:
        """(m,) measured less predicted [m]."""
        return self.length - self.predicted_length

    @property
    def in_sigmas(self) -> np.ndarray:
        """(m,) residual over its sigma: of the tension, or of the length where no tension was read [-]."""
        return np.where(
            np.isfinite(self.tension_residual),
            self.tension_residual / self.tension_sigma,
            self.length_residual / self.length_sigma,
        )


def shown_states(campaign: Campaign) -> dict[str, int]:
    """Name and number of each state whose position was measured."""
    known = np.isfinite(campaign.states.position).all(axis=1)
    return {name: i for i, name in enumerate(campaign.states.names) if known[i]}


def measured_state(robot: Robot, campaign: Campaign, index: int) -> MeasuredState:
    """State `index` of the campaign (from 0) beside the prediction for this robot.

    Tensions and lengths are predicted at the measured pose as the campaign's simulation distributes them, the position
    at the measured lengths. Gains and offsets of load cells are the robot's; friction on the pulleys is left out.
    """
    states = campaign.states
    angles = np.where(np.isfinite(states.angles[index]), states.angles[index], 0.0)
    where, payload = Pose(states.position[index], angles), float(states.payload[index])
    loaded = robot.with_load(payload)
    tension, length = _predicted(loaded, campaign, where)
    return MeasuredState(
        states.names[index], Controls(tuple(where.in_degrees()), payload),
        states.tension[index], tension, states.tension_sigma[index],
        states.length[index], length, states.length_sigma[index],
        _missed(loaded, campaign, where, states.length[index]),
    )  # fmt: skip


def _predicted(robot: Robot, campaign: Campaign, where: Pose) -> tuple[np.ndarray, np.ndarray]:
    model, nothing = campaign.cable_model, np.full(len(robot.cables), np.nan)
    try:
        found = inverse(robot, where.position, where.rotation, model, lower_bound=campaign.lower_bound)
    except CdprError:
        return nothing, nothing
    still = np.zeros(len(robot.cables))
    return cell_reading(RobotArrays.of(robot), found.tensions, still, still), found.lengths


def _missed(robot: Robot, campaign: Campaign, where: Pose, lengths: np.ndarray) -> np.ndarray:
    if not np.isfinite(lengths).all():
        return np.full(3, np.nan)
    found = forward(robot, lengths, where.position, where.rotation, campaign.cable_model)
    return np.where(found.stable, where.position - found.position, np.nan)

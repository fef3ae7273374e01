"""Which swivel angles of pulleys were read, and where did their encoders begin?

Encoders begin anywhere unless a tolerance of their zeros is stated: readings are then less their zero as far as the
poses that were filled in tell it, so that what is left is small; the rest of the zero is a number of the tolerances.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import rest
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.swivel_angle import swivel_angle, swivel_reference, within_turn


@dataclass(frozen=True, slots=True, eq=False)
class Swivels:
    """Swivel angles that were read, w of them.

    state, cable : (w,) from 0;  angle : (w,) [rad], within a turn, less a zero that is unknown;  sigma : (w,) [rad]
    reference : (m, 3) directions of angle zero, world
    """

    state: np.ndarray
    cable: np.ndarray
    angle: np.ndarray
    sigma: np.ndarray
    reference: np.ndarray

    def __len__(self) -> int:
        return len(self.angle)

    def of(self, angles: np.ndarray) -> np.ndarray:
        """(..., w) of angles (..., S, m): those that were read."""
        return np.asarray(angles[..., self.state, self.cable])

    def missed(self, angles: np.ndarray) -> np.ndarray:
        """(..., w) measured less computed angles (..., S, m) [rad], within half a turn."""
        return within_turn(self.angle - self.of(angles))


def swivels(campaign: Campaign, arrays: RobotArrays, known: Circumstances, readings: Readings) -> Swivels:
    """The swivel angles of a campaign whose readings are filled."""
    states = campaign.states
    state, cable = np.nonzero(np.isfinite(states.swivel))
    reference = swivel_reference(arrays.pulley_axis)
    found = Swivels(state, cable, states.swivel[state, cable], states.swivel_sigma[state, cable], reference)
    if not len(found) or "swivel_deg" in campaign.stated:
        return found
    pull = rest(arrays, readings, known).cables.force_at_frame
    gap = found.missed(swivel_angle(pull, arrays.pulley_axis, reference) + arrays.swivel_zero)
    zero = np.zeros(len(found))
    for own in (cable == i for i in np.unique(cable)):
        middle = np.angle(np.exp(1j * gap[own]).sum())
        zero[own] = middle + np.median(within_turn(gap[own] - middle))
    return Swivels(state, cable, within_turn(found.angle - zero), found.sigma, reference)

"""What would sensors say in every frame of a diagnosed campaign, and in readings that were not fitted?"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.later_lengths import require_same_robot
from cdpr_struct.diagnosis.virtual_sensors import VirtualSensors, opened, refitted, virtual_sensors
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.recorded import Recorded, recorded


@dataclass(frozen=True, slots=True, eq=False)
class PredictedFrames:
    """Of the campaign's states, all frames of a motion among them, and of a later campaign; None without one."""

    own: VirtualSensors
    later: VirtualSensors | None


def predicted_frames(found: Diagnosis, measured: Campaign, later: Campaign | None = None) -> PredictedFrames:
    """By the robot with the causes of the verdict, or with tolerances alone where it names none.

    measured : the campaign that was diagnosed, with all its frames.  Of corrected data, the states that were fitted.

    Raises
    ------
    InputError : a later campaign of another robot, or one that holds nothing that can be judged.
    """
    data = opened(found.explained.search.data)
    pulled = bool(data.read[:, 6 : 6 + data.cables].all())
    chosen = found.chosen if pulled else refitted(found.chosen, data)
    zeros = _zeros(found, data)
    every = found.campaign.frames is not None and found.correction is None
    whole = _with_zeros(measured, zeros) if every else data
    fitted = np.isin(whole.campaign.states.names, data.campaign.states.names)
    own = virtual_sensors(chosen, whole, fitted, zeros)
    if later is None:
        return PredictedFrames(own, None)
    require_same_robot(measured, later)
    other = _with_zeros(later, zeros)
    return PredictedFrames(own, virtual_sensors(chosen, other, np.zeros(other.states, dtype=bool), zeros))


def _zeros(found: Diagnosis, data: Recorded) -> np.ndarray:
    """(m,) [m] that were taken off the readings of relative encoders; zero of absolute ones."""
    if not found.campaign.relative_lengths:
        return np.zeros(data.cables)
    taken = found.campaign.states.length - data.campaign.states.length
    return np.array([np.median(own[np.isfinite(own)]) if np.isfinite(own).any() else 0.0 for own in taken.T])


def _with_zeros(campaign: Campaign, zeros: np.ndarray) -> Recorded:
    """Another campaign's readings, relative encoders less the zeros of the one that was diagnosed."""
    states = replace(campaign.states, length=campaign.states.length - zeros)
    return opened(recorded(replace(campaign, states=states, relative_lengths=False)))

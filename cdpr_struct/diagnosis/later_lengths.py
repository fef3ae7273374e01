"""Who predicts the cable lengths of readings that nothing was fitted to: the robot as entered, or with the causes?"""

import numpy as np

from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.recording import LengthErrors
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.residuals.recorded import recorded


def require_same_robot(campaign: Campaign, later: Campaign) -> None:
    """Refuse another campaign whose robot cannot be that of a first one.

    Raises
    ------
    InputError : another number of cables.
    """
    m = len(campaign.robot.cables)
    if len(later.robot.cables) != m:
        raise InputError(later.source, "robot", f"{len(later.robot.cables)} cables", f"the robot diagnosed, {m} cables")


def later_lengths(found: Diagnosis, later: Campaign) -> LengthErrors:
    """Errors of the lengths of another campaign of the same robot, at its measured poses.

    Raises
    ------
    InputError : the other campaign has another number of cables, or no lengths at measured poses.
    """
    require_same_robot(found.campaign, later)
    every = AllFrames.read(recorded(later))
    if not len(every.frames):
        raise InputError(later.source, "measurement", "no lengths at measured poses", "states with poses and lengths")
    rows = (every.errors(one) for one in (None, found.null, found.chosen))
    return LengthErrors(len(every.frames), *(np.sqrt(np.nanmean(one**2, axis=0)) for one in rows))

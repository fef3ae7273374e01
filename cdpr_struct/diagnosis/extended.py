"""The robot with the causes that a decision names, at their whole sizes, for every other command."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.posterior_spread import posterior_spread
from cdpr_struct.diagnosis.random_law import random_law
from cdpr_struct.diagnosis.whole_sizes import WholeSize
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.observation.circumstances import first_time
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays


def extended_robot(data: Recorded, sizes: Sequence[WholeSize], causes: Sequence[str], found: Judged) -> Robot:
    """The campaign's robot with causes put in, no tolerances; what belongs to single states or sits in the data
    alone is no part of a robot.

    causes : names for the file, those of corrected data among them;  found : the fit, which says how sure it is
    """
    arrays, entered = extended_arrays(data, sizes), data.campaign.robot
    named = tuple(dict.fromkeys([*entered.extensions.causes, *causes]))
    robot = robot_from_arrays(entered, arrays, named)
    return replace(robot, posterior=posterior_spread(data, found, arrays), remainder=None)


def unexplained_robot(data: Recorded, where: Layout, null: Judged) -> Robot:
    """The campaign's robot after `unknown`: as entered, with what the readings say of its numbers beside a random law.

    null : nothing wrong, as it was fitted
    """
    law = random_law(data, where, null)
    return replace(
        data.campaign.robot, posterior=posterior_spread(data, law.judged, data.arrays), remainder=law.remainder
    )


def extended_arrays(data: Recorded, sizes: Sequence[WholeSize]) -> RobotArrays:
    """The robot as entered with causes at their whole sizes; hose and elasticity refer to the campaign's states."""
    arrays = replace(
        data.arrays,
        hose_center=data.known.center,
        reference_tension=np.asarray(float(data.known.mean_tension)),
        clock_start=np.asarray(first_time(data.campaign.states)),
    )
    for size in sizes:
        if size.part.cause.carrier != "state":
            arrays = size.part.cause.apply(arrays, (size.part.pattern.basis @ size.mean)[None])
    return arrays

"""The robot as a diagnosis leaves it: with its numbers at their means, at rest with the winches where they are.

An extended robot has its causes and nothing of what the readings say of its tolerances. These may move tensions by ten
of their sigmas, so that modes change places for certain. Rates are taken where the robot most probably is.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.tolerances import Spread, changed
from cdpr_struct.statics.forward_kinematics import forward


def at_the_means(point: OperatingPoint, spread: Spread, model: str) -> tuple[OperatingPoint, Spread]:
    """The robot of an operating point with its numbers at their means, and the spread about them.

    model : of the cables, sagging or spring

    Raises
    ------
    CdprError : it does not come to rest.
    """
    if not spread.mean.any():
        return point, spread
    entered, arrays = point.entered, RobotArrays.of(point.entered)
    moved = changed(arrays, spread.mean, spread.varied)
    robot = replace(robot_from_arrays(entered, moved, entered.extensions.causes), posterior=None, remainder=None)
    rest = forward(robot, arrays.reading(point.cables.paid_out), point.position, point.rotation, model)
    if not rest.stable:
        raise CdprError("there is no band: with its likeliest numbers the platform does not come to rest there")
    centred = replace(spread, mean=np.zeros_like(spread.mean))
    return OperatingPoint(robot, rest.position, rest.rotation, rest.cables), centred

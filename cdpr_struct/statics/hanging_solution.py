"""Lengths and tensions of platforms that hang freely, in the form of other poses."""

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.free_orientation import FreeOrientation
from cdpr_struct.statics.inverse_kinematics import InverseSolution, InverseStatus


def hung_solution(robot: Robot | RobotArrays, hung: FreeOrientation) -> InverseSolution:
    """The tensions (k, m) of platforms that hang freely."""
    status = np.where(hung.found, InverseStatus.HELD, InverseStatus.UNHOLDABLE)
    lengths = RobotArrays.of(robot).reading(hung.cables.total_length)
    return InverseSolution(hung.cables, lengths, hung.wrench, status, np.zeros(len(status), dtype=int))

"""The static equilibrium about which the robot vibrates."""

from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.stiffening import in_small_motion


@dataclass(frozen=True, slots=True, eq=False)
class OperatingPoint:
    """A robot at rest.

    robot    : as entered, or as arrays with batch axes (...)
    position : (..., 3) r [m]
    rotation : (..., 3, 3) platform to world
    cables   : `CableStates` of shape (..., m) in equilibrium with the platform's load; kept here as they are in small
        motion, see `in_small_motion`
    arrays   : the robot's, in small motion; made here
    """

    robot: Robot | RobotArrays
    position: np.ndarray
    rotation: np.ndarray
    cables: CableStates
    arrays: RobotArrays = field(init=False)

    def __post_init__(self) -> None:
        arrays, cables = in_small_motion(RobotArrays.of(self.robot), self.cables)
        object.__setattr__(self, "arrays", arrays)
        object.__setattr__(self, "cables", cables)

    @property
    def end_stiffness(self) -> np.ndarray:
        """(..., m, 3, 3) static stiffness of the cables' platform ends, with pulleys and what is in line, world [N/m].

        Its symmetric part, that of an energy: statics leaves out the weight of the cable on a wheel, and the rest, w R
        per turn of the exit at most, has no meaning in vibration.
        """
        stiffness = end_stiffness(self.arrays, self.cables)
        if not self.arrays.has_yielding_frame_ends:
            return stiffness
        return np.asarray(0.5 * (stiffness + np.swapaxes(stiffness, -1, -2)))

    @property
    def entered(self) -> Robot:
        """The robot with its name and all that arrays leave out.

        Raises
        ------
        TypeError : the point was made from arrays.
        """
        if isinstance(self.robot, RobotArrays):
            raise TypeError("this operating point was made from RobotArrays, which have no name, home or description")
        return self.robot

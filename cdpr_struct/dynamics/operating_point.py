"""The static equilibrium about which the robot vibrates."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates


@dataclass(frozen=True, slots=True, eq=False)
class OperatingPoint:
    """A robot at rest.

    position : (..., 3) r [m]
    rotation : (..., 3, 3) platform to world
    cables   : `CableStates` of shape (..., m) in equilibrium with the platform's load
    """

    robot: Robot
    position: np.ndarray
    rotation: np.ndarray
    cables: CableStates

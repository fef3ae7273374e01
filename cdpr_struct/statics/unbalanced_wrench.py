"""How much of the forces on a platform is left unbalanced?"""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, platform_radius
from cdpr_struct.statics.guides import free_part

MOST_UNBALANCED = 1e-7
"""Share from which on a platform does not count as balanced; searches end below 1e-8."""


def unbalanced_share(
    arrays: RobotArrays, position: np.ndarray, rotation: np.ndarray, states: CableStates
) -> np.ndarray:
    """(...) norm of the wrench that is left over, in shares of load and tensions together [-].

    position, rotation : (..., 3) [m], (..., 3, 3) platform to world;  states : of cables (..., m)

    Moments count as forces at the platform's radius. What a guide takes is left out. 0 where nothing pulls at all.
    """
    arms = PlatformArms.at(arrays, position, rotation)
    unit = np.repeat([1.0, platform_radius(arrays)], 3)
    load = load_wrench(arrays, arms)
    left = np.linalg.norm(free_part(cable_wrench(states, arms) + load, arrays) / unit, axis=-1)
    size = np.linalg.norm(load / unit, axis=-1) + states.tension_at_platform.sum(axis=-1)
    return np.asarray(left / np.where(size > 0.0, size, 1.0))

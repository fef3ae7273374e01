"""What does a guide hold, and with which wrench?

A guide holds some of the six freedoms of the platform, world axes at its origin. Of balance and stiffness the free
directions alone are left; in place of the others stands a stiffness that is coupled with nothing.
"""

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench


def free_part(vector: np.ndarray, arrays: RobotArrays) -> np.ndarray:
    """(..., 6) wrench or motion without what a guide holds."""
    return vector * arrays.free if arrays.has_guides else vector


def guide_part(vector: np.ndarray, arrays: RobotArrays) -> np.ndarray:
    """(..., 6) what a guide holds of a wrench or motion; zero without one."""
    return np.asarray(vector * arrays.guided)


def behind_guides(matrix: np.ndarray, arrays: RobotArrays, held: float = 1.0) -> np.ndarray:
    """(..., 6, 6) stiffness or mass that the free motions feel; held directions have `held` on the diagonal alone."""
    if not arrays.has_guides:
        return matrix
    free = arrays.free
    kept = matrix * free[..., :, None] * free[..., None, :]
    return np.asarray(kept + held * arrays.guided[..., None] * np.eye(6))


def free_axes(arrays: RobotArrays) -> np.ndarray:
    """Numbers (f,) of the freedoms that no guide holds; a batch of robots has the same guides."""
    return np.flatnonzero(arrays.free.reshape(-1, 6)[0])


def free_block(matrix: np.ndarray, arrays: RobotArrays) -> np.ndarray:
    """(..., f, f) of the free directions of a matrix whose first six rows and columns are the platform's; the rest,
    if any, stays."""
    if not arrays.has_guides:
        return matrix
    kept = np.concatenate([free_axes(arrays), np.arange(6, matrix.shape[-1])])
    return np.asarray(matrix[..., kept[:, None], kept])


def guide_reaction(
    arrays: RobotArrays, position: np.ndarray, rotation: np.ndarray, states: CableStates, wrench: np.ndarray
) -> np.ndarray:
    """(..., 6) wrench of the guide on the platform about its origin, world axes [N, N m]; zero without a guide.

    wrench : (..., 6) on the platform beside its weight
    """
    arms = PlatformArms.at(arrays, position, rotation)
    return -guide_part(cable_wrench(states, arms) + load_wrench(arrays, arms) + wrench, arrays)

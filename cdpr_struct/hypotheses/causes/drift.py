"""Load cells that drift: a random walk of each cell's zero over the order of the states, zero at the first.

Without it a drift is a wrong cause; that it begins at zero tells it from a bias of the cell.
"""

import numpy as np

from cdpr_struct.robot.changed_arrays import plus
from cdpr_struct.robot.robot_arrays import RobotArrays

WAVES = 3  # Karhunen-Loeve functions: the rest of a walk is 7 % of its variance, and looks like noise
AMPLITUDES = ((0.0, 0.6), (1.0, 0.2), (3.0, 0.2))
"""Size at the last state, in sigmas of a reading, and its probability: load cells are bought not to drift."""


def walk(states: int) -> np.ndarray:
    """(S, WAVES) Karhunen-Loeve functions of a random walk that is zero at the first state and unity at the last."""
    time = np.arange(states) / max(states - 1, 1)
    rate = (np.arange(WAVES) + 0.5) * np.pi
    return np.asarray(np.sqrt(2.0) * np.sin(time[:, None] * rate) / rate)


def drifted(arrays: RobotArrays, theta: np.ndarray, waves: np.ndarray) -> RobotArrays:
    """The robot whose cells read theta (..., 1, m * WAVES) times the waves (S, WAVES) more in state after state [N]."""
    own = theta.reshape((*theta.shape[:-1], -1, WAVES))
    return plus(arrays, cell_bias=np.einsum("...mw,sw->...sm", own[..., 0, :, :], waves))

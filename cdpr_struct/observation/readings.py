"""Readings of the static sensors as arrays, and the truth that they mean for sensors of a robot."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import rotation_from_vector

LEAST_TENSION = 1.0  # [N] a reading that means less is taken as this: a slack cable has no direction


@dataclass(frozen=True, slots=True, eq=False)
class Readings:
    """What trackers, load cells and encoders said in S states; leading axes (...) are a batch.

    position (..., S, 3) [m], rotation (..., S, 3, 3), tension (..., S, m) [N], length (..., S, m) [m]; all filled:
    where nothing was read stands an estimate.
    """

    position: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray
    length: np.ndarray

    def less(self, pose: np.ndarray, tension: np.ndarray, length: np.ndarray) -> "Readings":
        """Readings with errors taken off: pose (..., S, 6) shift and turn in world axes [m, rad], [N], [m]."""
        return Readings(
            self.position - pose[..., :3],
            rotation_from_vector(-pose[..., 3:]) @ self.rotation,
            self.tension - tension,
            self.length - length,
        )


def true_pose(arrays: RobotArrays, readings: Readings) -> tuple[np.ndarray, np.ndarray]:
    """Position (..., S, 3) and rotation (..., S, 3, 3) that the tracker's readings mean."""
    turn = rotation_from_vector(arrays.tracker[..., 3:])
    position = (turn @ readings.position[..., None])[..., 0] + arrays.tracker[..., :3]
    return position, turn @ readings.rotation


def true_tension(arrays: RobotArrays, readings: Readings, known: Circumstances) -> np.ndarray:
    """(..., S, m) tensions at the platform that the load cells' readings mean [N]."""
    read = (readings.tension - arrays.cell_bias) / arrays.cell_gain
    return np.maximum(read * np.exp(-arrays.friction * known.approach * known.wrap), LEAST_TENSION)


def paid_out(arrays: RobotArrays, readings: Readings, known: Circumstances) -> np.ndarray:
    """(..., S, m) unstrained length that the encoders' readings mean [m]."""
    return arrays.paid_out(readings.length) + arrays.slip * known.hours[:, None] * arrays.thermal_growth


def cell_reading(arrays: RobotArrays, tension: np.ndarray, approach: np.ndarray, wrap: np.ndarray) -> np.ndarray:
    """(..., m) what load cells say at tensions (..., m) at the platform [N]: the inverse of `true_tension`."""
    last = np.where(np.isfinite(approach), approach, 0.0)
    return np.asarray(tension * np.exp(arrays.friction * last * wrap) * arrays.cell_gain + arrays.cell_bias)

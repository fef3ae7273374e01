"""Readings of the static sensors as arrays, and the truth that they mean for sensors of a robot."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import rotation_from_vector

_STUCK = 0.99  # b of a bearing, bound: at 1 a wheel no longer turns whatever the tensions
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
    later = readings.tension + _later(arrays, arrays.cell_delay, known, known.pull)
    read = (later - arrays.cell_bias) / arrays.cell_gain - arrays.pulley_drag * known.approach
    return np.maximum(read * np.exp(-known.approach * _pulley_friction(arrays, known.wrap)), LEAST_TENSION)


def _pulley_friction(arrays: RobotArrays, wrap: np.ndarray) -> np.ndarray:
    """(..., m) ln of a wheel's larger over its smaller tension, at a wrap (..., m) [right angles].

    Of a cable that slips, friction times wrap (Euler and Eytelwein). Of a bearing with b = mu r / R, the balance of
    moments (T1 - T2) R = mu r F with F the resultant of both, F^2 = T1^2 + T2^2 - 2 T1 T2 cos(angle), is solved by
    ln(T1 / T2) = 2 asinh(b sin(angle / 2) / sqrt(1 - b^2)).
    """
    slips = arrays.friction * wrap
    if not arrays.bearing_friction.any():
        return np.asarray(slips)
    angle = 0.5 * np.pi * wrap
    b = np.clip(arrays.bearing_friction, -_STUCK, _STUCK)
    return np.asarray(slips + 2.0 * np.arcsinh(b * np.sin(0.5 * angle) / np.sqrt(1.0 - b**2)))


def paid_out(arrays: RobotArrays, readings: Readings, known: Circumstances) -> np.ndarray:
    """(..., S, m) unstrained length that the encoders' readings mean [m].

    A drive with play lags behind its encoder by half of the play: the drum has wound in less, or paid out less.
    """
    more = (
        arrays.slip * known.hours[:, None]
        + _later(arrays, arrays.encoder_delay, known, known.rate)
        + 0.5 * arrays.backlash * known.approach
    )
    return arrays.paid_out(readings.length) + more * arrays.thermal_growth


def _later(arrays: RobotArrays, delay: np.ndarray, known: Circumstances, rate: np.ndarray) -> np.ndarray:
    """(..., S, m) by how much readings with rates (S, m, 2) change until the time of the poses, to second order.

    delay : (..., m) by which they are older [s]; less where the clock of the poses has gained
    """
    if not arrays.clock_drift.any() and not delay.any():
        return np.zeros(1)
    older = delay - arrays.clock_drift[..., None] * known.clock[:, None]
    return np.asarray(older * rate[..., 0] + 0.5 * older**2 * rate[..., 1])


def cell_reading(arrays: RobotArrays, tension: np.ndarray, approach: np.ndarray, wrap: np.ndarray) -> np.ndarray:
    """(..., m) what load cells say at tensions (..., m) at the platform [N]: the inverse of `true_tension`."""
    last = np.where(np.isfinite(approach), approach, 0.0)
    pulled = tension * np.exp(last * _pulley_friction(arrays, wrap)) + last * arrays.pulley_drag
    return np.asarray(pulled * arrays.cell_gain + arrays.cell_bias)

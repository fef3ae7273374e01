"""Sensors that drift: a random walk of their zeros over the order of the states, zero at the first.

Without it a drift is a wrong cause; that it begins at zero tells it from a constant offset.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.residuals.linearised import Term
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.robot.changed_arrays import plus
from cdpr_struct.robot.robot_arrays import RobotArrays

WAVES = 3  # Karhunen-Loeve functions: the rest of a walk is 7 % of its variance, and looks like noise
CELLS, TRACKER, ENCODERS = "load_cells", "tracker", "encoders"


@dataclass(frozen=True, slots=True, order=True)
class Drift:
    """A kind of sensor whose zeros walk, and how far they are at the last state, in sigmas of a reading."""

    sensor: str
    amplitude: float

    def term(self, data: Recorded) -> Term:
        """What it changes of the robot's sensors in state after state."""
        walk_of, sigma = _WALKS[self.sensor](data)
        count = len(sigma)
        return Term(walk_of, np.eye(count * WAVES), self.amplitude * np.repeat(sigma, WAVES))


NO_DRIFT = 0.5  # probability
DRIFTS = {
    Drift(CELLS, 1.0): 0.16, Drift(CELLS, 3.0): 0.16,
    Drift(TRACKER, 2.0): 0.05, Drift(TRACKER, 6.0): 0.04,
    Drift(ENCODERS, 3.0): 0.05, Drift(ENCODERS, 10.0): 0.04,
}  # fmt: skip
"""Drifts with their probabilities: sensors are bought not to drift, load cells do so most; one kind at most drifts.

Sigmas of encoders are small, a tenth of a millimetre, against what belts, ropes on drums and warmth do in a day.
"""


def drifts(data: Recorded) -> list[Drift]:
    """Those of sensors that were read in two or more states."""
    states, count = data.campaign.states, 6 + data.cables
    read = {
        CELLS: data.read[:, 6:count].any(axis=1),
        TRACKER: data.read[:, :6].all(axis=1),
        ENCODERS: np.isfinite(states.length).any(axis=1),
    }
    return [one for one in DRIFTS if read[one.sensor].sum() > 1]


def probability(drift: Drift | None) -> float:
    """Of a drift, or of none."""
    return NO_DRIFT if drift is None else DRIFTS[drift]


def walk(states: int) -> np.ndarray:
    """(S, WAVES) Karhunen-Loeve functions of a random walk that is zero at the first state and unity at the last."""
    time = np.arange(states) / max(states - 1, 1)
    rate = (np.arange(WAVES) + 0.5) * np.pi
    return np.asarray(np.sqrt(2.0) * np.sin(time[:, None] * rate) / rate)


def walked(theta: np.ndarray, waves: np.ndarray) -> np.ndarray:
    """(..., S, n) zeros of n sensors in state after state from numbers (..., n * WAVES) and waves (S, WAVES)."""
    return np.einsum("...nw,sw->...sn", theta.reshape((*theta.shape[:-1], -1, WAVES)), waves)


_Walk = tuple[Callable[[RobotArrays, np.ndarray], RobotArrays], np.ndarray]


def _cells(data: Recorded) -> _Walk:
    """Zeros of the load cells [N], from state to state."""
    waves = walk(data.states)

    def drifted(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
        return plus(arrays, cell_bias=walked(theta[..., 0, :], waves))

    return drifted, np.median(data.sigma[:, 6 : 6 + data.cables], axis=0)


def _tracker(data: Recorded) -> _Walk:
    """The tracker's frame, which shifts, and turns about the middle of the poses [m, rad]."""
    waves, middle = walk(data.states), data.readings.position.mean(axis=0)

    def drifted(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
        shift, turn = np.split(walked(theta[..., 0, :], waves), 2, axis=-1)
        return plus(arrays, tracker=np.concatenate([shift - np.cross(turn, middle), turn], axis=-1))

    return drifted, np.median(data.sigma[:, :6], axis=0)


def _encoders(data: Recorded) -> _Walk:
    """Zeros of the encoders [m], from one reading of lengths to the next: states of a lock share one."""
    waves = np.zeros((data.states, WAVES))
    for own, value in zip(data.blocks, walk(len(data.blocks)), strict=True):
        waves[own] = value

    def drifted(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
        return plus(arrays, length_offset=walked(theta[..., 0, :], waves))

    return drifted, np.median(data.sigma[:, 6 + data.cables :], axis=0)


_WALKS: dict[str, Callable[[Recorded], _Walk]] = {CELLS: _cells, TRACKER: _tracker, ENCODERS: _encoders}

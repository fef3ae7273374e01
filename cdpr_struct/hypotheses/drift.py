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
        sigma, waves, change = self._sigma(data), self._waves(data), _CHANGES[self.sensor](data)
        return Term(
            lambda arrays, theta: change(arrays, _walked(theta[..., 0, :], waves)), np.eye(len(sigma)), sigma
        )  # fmt: skip

    def zeros(self, data: Recorded, z: np.ndarray) -> np.ndarray:
        """(S, n) zeros of the n sensors [N, m, rad] by the numbers z of the term; of a tracker, about the middle."""
        return _walked(z * self._sigma(data), self._waves(data))

    @property
    def probability(self) -> float:
        """Of this drift."""
        return DRIFTS[self]

    def _sigma(self, data: Recorded) -> np.ndarray:
        own = np.median(data.sigma[:, _columns(self.sensor, data.cables)], axis=0)
        return self.amplitude * np.repeat(own, WAVES)

    def _waves(self, data: Recorded) -> np.ndarray:
        """(S, WAVES); of encoders from one reading of lengths to the next: states of a lock share one."""
        if self.sensor != ENCODERS:
            return walk(data.states)
        waves = np.zeros((data.states, WAVES))
        for own, value in zip(data.blocks, walk(len(data.blocks)), strict=True):
            waves[own] = value
        return waves


DRIFTS = {
    Drift(CELLS, 1.0): 0.16, Drift(CELLS, 3.0): 0.16,
    Drift(TRACKER, 2.0): 0.05, Drift(TRACKER, 6.0): 0.04,
    Drift(ENCODERS, 3.0): 0.05, Drift(ENCODERS, 10.0): 0.04,
}  # fmt: skip
"""Drifts with their probabilities, half together: sensors are bought not to drift, load cells do so most; one kind at
most drifts.

Sigmas of encoders are small, a tenth of a millimetre, against what belts, ropes on drums and warmth do in a day.
"""

_SHORTEST = 0.1  # h: in it a walk comes a sixth as far as in four hours, most of them within a sigma


def drifts(data: Recorded) -> list[Drift]:
    """Those of sensors that were read in two or more states; none where all were read within minutes.

    The variance of a walk grows with time, and the table is that of a campaign of hours. Three slow waves in a short
    motion would stand for what goes with its place or its speed.
    """
    m, span = data.cables, float(np.ptp(data.known.hours))
    if 0.0 < span < _SHORTEST and np.isfinite(data.campaign.states.time).all():
        return []
    read = {
        CELLS: data.read[:, _columns(CELLS, m)].any(axis=1),
        TRACKER: data.read[:, _columns(TRACKER, m)].all(axis=1),
        ENCODERS: np.isfinite(data.campaign.states.length).any(axis=1),
    }
    return [one for one in DRIFTS if read[one.sensor].sum() > 1]


def walk(states: int) -> np.ndarray:
    """(S, WAVES) Karhunen-Loeve functions of a random walk that is zero at the first state and unity at the last."""
    time = np.arange(states) / max(states - 1, 1)
    rate = (np.arange(WAVES) + 0.5) * np.pi
    return np.asarray(np.sqrt(2.0) * np.sin(time[:, None] * rate) / rate)


def _walked(theta: np.ndarray, waves: np.ndarray) -> np.ndarray:
    """(..., S, n) zeros of n sensors in state after state from numbers (..., n * WAVES) and waves (S, WAVES)."""
    return np.einsum("...nw,sw->...sn", theta.reshape((*theta.shape[:-1], -1, WAVES)), waves)


def _columns(sensor: str, m: int) -> slice:
    """Of 6 + 2 m readings."""
    return {TRACKER: slice(0, 6), CELLS: slice(6, 6 + m), ENCODERS: slice(6 + m, None)}[sensor]


_Change = Callable[[RobotArrays, np.ndarray], RobotArrays]


def _cells(data: Recorded) -> _Change:
    del data
    return lambda arrays, zeros: plus(arrays, cell_bias=zeros)


def _encoders(data: Recorded) -> _Change:
    del data
    return lambda arrays, zeros: plus(arrays, length_offset=zeros)


def _tracker(data: Recorded) -> _Change:
    """The tracker's frame shifts, and turns about the middle of the poses."""
    middle = data.readings.position.mean(axis=0)

    def drifted(arrays: RobotArrays, zeros: np.ndarray) -> RobotArrays:
        shift, turn = np.split(zeros, 2, axis=-1)
        return plus(arrays, tracker=np.concatenate([shift - np.cross(turn, middle), turn], axis=-1))

    return drifted


_CHANGES: dict[str, Callable[[Recorded], _Change]] = {CELLS: _cells, TRACKER: _tracker, ENCODERS: _encoders}

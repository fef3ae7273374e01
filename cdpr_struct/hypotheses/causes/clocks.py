"""What clocks do: sensors that read late against each other along a motion, and clocks that run apart."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import A_MINUTE, Cause, Parameter, Seen, by_carrier
from cdpr_struct.robot.changed_arrays import plus
from cdpr_struct.robot.robot_arrays import RobotArrays

_LATE = 0.04  # s: one picture of a camera at 25 Hz
_RATE = 1e-3  # of a clock that counts samples at a rate that is not quite the nominal one; quartz has 1e-4 at most
_SHORT = A_MINUTE / 6.0  # h, below which a clock of such a rate gains less than what a spline knows of a motion
_SENSES = ("older", "newer")
LENGTHS, TENSIONS, BOTH = "of the lengths alone", "of the tensions alone", "of lengths and tensions, each its own"


def _delay(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """Delays of the poses against all other readings, against the lengths, and against the tensions."""
    poses, lengths, tensions = np.moveaxis(by_carrier(theta, 3), -1, 0)
    return plus(arrays, encoder_delay=-poses - lengths, cell_delay=-poses - tensions)


def _drift(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, clock_drift=theta[..., 0])


def _moving(seen: Seen) -> str:
    return "" if seen.moving or seen.pulling else "needs lengths or tensions with time_s along a motion"


def _lasting(seen: Seen) -> str:
    return _moving(seen) or ("" if seen.hours > _SHORT else "needs a motion of more than ten seconds")


def _two_systems(seen: Seen) -> str:
    return "" if seen.moving and seen.pulling else "needs lengths and tensions along a motion"


CAUSES = (
    Cause(
        "sensor_delay",
        "delay of the poses against the other readings",
        (
            Parameter("delay", "s", _LATE),
            Parameter("delay_of_lengths", "s", _LATE),
            Parameter("delay_of_tensions", "s", _LATE),
        ),
        _delay,
        carrier="cable",
        laws=(("", [0], 0.5), (LENGTHS, [1], 0.2), (TENSIONS, [2], 0.2), (BOTH, [1, 2], 0.1)),
        law_needs={LENGTHS: _two_systems, TENSIONS: _two_systems, BOTH: _two_systems},
        seen_in=("CO", "EQ"),
        needs=_moving,
        in_motion=True,
        sentence="the poses are {size} s {sense} than the other readings that are filed with them",
        senses=_SENSES,
        sign="positive: the poses are older",
        separated_by="the same motion at half the speed; a common trigger",
        extension="encoder_delay",
    ),
    Cause(
        "clock_drift",
        "clock of the poses against that of the other readings",
        (Parameter("drift", "1", _RATE),),
        _drift,
        seen_in=("CO", "EQ"),
        needs=_lasting,
        in_motion=True,
        sentence="the clocks of the poses and of the other readings run apart by {value} s a second from the start on",
        sign="positive: that of the poses is fast, so that they grow older",
        separated_by="a longer recording; a common trigger at its start and at its end",
        extension="clock_drift",
    ),
)

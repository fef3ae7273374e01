"""What accelerometers do to a vibration: to its size by their gain, to its frequencies by their mass."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen
from cdpr_struct.measurement.signal_records import MOTION
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.robot_arrays import RobotArrays

_GAIN = 0.05  # of the logarithm
_MASS = 2.0  # kg: some accelerometers with their cables, a small shaker


def _gain(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """One gain of all directions, then one of each."""
    return times(arrays, accelerometer_gain=np.exp(theta[..., :1] + theta[..., 1:]))


def _mass(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, sensor_mass=theta[..., 0])


def _frequencies(seen: Seen) -> str:
    return "" if seen.kinds & {"CF", "RF"} else "needs frequencies of the cables or of the robot"


def _constants(seen: Seen) -> str:
    return "" if "FA" in seen.kinds else "needs FRFs of the platform, along its axes, with well separated modes"


CAUSES = (
    Cause(
        "accelerometer_gain",
        "gain of the accelerometers, or of the force cell of the excitation",
        tuple(Parameter(name, "ratio", _GAIN, True) for name in ("gain", *(f"gain_{d}" for d in MOTION))),
        _gain,
        seen_in=("FA",),
        sentence="the accelerometers read {percent} of the acceleration",
        needs=_constants,
        separated_by="a shaker of known acceleration; weighing the platform",
        extension="accelerometer_gain",
        shapes=(
            ("all alike", slice(0, 1), 0.5),
            ("each its own", slice(1, None), 0.2),
            *((f"{d} alone", slice(i, i + 1), 0.05) for i, d in enumerate(MOTION, start=1)),
        ),
    ),
    Cause(
        "accelerometer_mass",
        "mass of sensors or a shaker on the platform while vibration was measured, and only then",
        (Parameter("sensor_mass", "kg", _MASS, positive=True),),
        _mass,
        seen_in=("CF", "RF", "FA"),
        sentence="sensors or a shaker of {value} kg were on the platform while vibration was measured",
        needs=_frequencies,
        separated_by="weighing the sensors; reading the tensions with them on the platform",
        extension="sensor_mass",
    ),
)

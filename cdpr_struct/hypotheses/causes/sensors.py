"""What the readings do to the truth."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import A_MINUTE, Cause, Parameter, Seen, by_carrier
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.robot_arrays import RobotArrays

_BEARING = 0.02  # mu r / R: a plain bearing of mu = 0.1 and r / R = 0.2; ball bearings have less
_DRAG = 2.0  # N: a seal of 0.08 N m on a wheel of 40 mm
_PLAY = 2e-3  # m: 2 degrees of a gear on a drum of 60 mm


def _gain(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, cell_gain=np.exp(theta))


def _bias(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, cell_bias=theta)


def _friction(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    slips, bearing, drag = np.moveaxis(by_carrier(theta, 3), -1, 0)
    return plus(arrays, friction=slips, bearing_friction=bearing, pulley_drag=drag)


def _backlash(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, backlash=theta)


def _slip(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, slip=theta)


def _cells(seen: Seen) -> str:
    return "" if seen.tensions else "needs tensions"


def _approach(seen: Seen) -> str:
    return "" if seen.approach else "needs a column approach (+1 or -1)"


def _play(seen: Seen) -> str:
    return _approach(seen) if seen.lengths else "needs lengths from the encoders"


def _times(seen: Seen) -> str:
    return "" if seen.hours > A_MINUTE else "needs time_s"


CAUSES = (
    Cause(
        "load_cell_gain",
        "gain of the load cells",
        (Parameter("gain", "ratio", 0.03, True),),
        _gain,
        carrier="cable",
        seen_in=("EQ", "CO", "CF"),
        sentence="the load cells read {percent} of the tension",
        needs=_cells,
        separated_by="a payload series; cable frequencies; a known weight on one cell",
        extension="cell_gain",
    ),
    Cause(
        "load_cell_bias",
        "zero offset of the load cells",
        (Parameter("bias", "N", 6.0),),
        _bias,
        carrier="cable",
        seen_in=("EQ", "CO", "CF"),
        sentence="the zeros of the load cells are off by {rms} N on average",
        sign="reading = tension + this",
        needs=_cells,
        separated_by="tensions over a range of two or more",
        extension="cell_bias",
    ),
    Cause(
        "pulley_friction",
        "friction between cable and load cell",
        (
            Parameter("friction", "1", 0.03, positive=True),
            Parameter("bearing_friction", "1", _BEARING, positive=True),
            Parameter("drag", "N", _DRAG, positive=True),
        ),
        _friction,
        carrier="cable",
        laws=(
            ("", [0], 0.4),
            ("in the bearings", [1], 0.2),
            ("constant", [2], 0.2),
            ("in the bearings and constant", [1, 2], 0.2),
        ),
        fitted=4,
        seen_in=("EQ", "CO", "CF"),
        sentence="friction at the pulleys changes the tension: {named}",
        needs=_approach,
        separated_by="approaching each pose from both sides",
        extension="friction",
    ),
    Cause(
        "backlash",
        "play of the drives",
        (Parameter("backlash", "m", _PLAY, positive=True),),
        _backlash,
        carrier="cable",
        seen_in=("CO",),
        needs=_play,
        sentence="the drives have a play of {value} m",
        separated_by="approaching each pose from both sides; a dial gauge on the drum while the motor turns back",
        extension="backlash",
    ),
    Cause(
        "brake_slip",
        "slip of a brake or a winch",
        (Parameter("slip", "m/h", 2e-3),),
        _slip,
        carrier="cable",
        seen_in=("CO",),
        needs=_times,
        sentence="a winch slips by {rms} m per hour",
        sign="positive: pays out",
        separated_by="the motor encoder's log",
    ),
)

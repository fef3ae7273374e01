"""Where things are, other than entered."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen, by_carrier
from cdpr_struct.robot.cable import STEEL
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.robot_arrays import RobotArrays

_XYZ = ("x", "y", "z")


def _frame_anchor(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, frame_anchors=by_carrier(theta, 3))


def _platform_anchor(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, platform_anchors=by_carrier(theta, 3))


def _offset(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, length_offset=theta)


def _drum(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, length_scale=np.exp(theta))


def _temperature(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    grown = 1.0 + STEEL * theta
    return times(arrays, length_scale=grown, frame_anchors=grown[..., None])


def _pulley(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    turning = arrays.pulley_radius > 0.0
    return plus(arrays, pulley_radius=np.where(turning, np.maximum(theta, -0.9 * arrays.pulley_radius), 0.0))


def _tracker(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, tracker=theta)


def _tilt(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, tilt=theta)


def _pose(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """A frame of its own for the tracker in each state (..., S * 6)."""
    return plus(arrays, tracker=by_carrier(theta, 6)[..., 0, :, :])


def _wheels(seen: Seen) -> str:
    return "" if seen.wheels else "no cable has a pulley in the robot file; see missing_pulleys"


def _lengths(seen: Seen) -> str:
    return "" if seen.lengths else "needs lengths from the encoders"


def _zeros(seen: Seen) -> str:
    return "the encoders are relative: their zeros are unknown" if seen.relative else _lengths(seen)


def _poses(seen: Seen) -> str:
    return "" if seen.poses else "needs measured poses"


CAUSES = (
    Cause(
        "frame_anchor_position",
        "position of the frame anchors",
        tuple(Parameter(f"frame_anchor_{a}", "m", 5e-3) for a in _XYZ),
        _frame_anchor,
        carrier="cable",
        seen_in=("CO", "NS"),
        sentence="the frame anchors are off by {far} m on average",
        separated_by="platform rotations among the poses; a laser tracker on the pulleys",
        extension="frame_anchors",
    ),
    Cause(
        "platform_anchor_position",
        "position of the platform anchors",
        tuple(Parameter(f"platform_anchor_{a}", "m", 4e-3) for a in _XYZ),
        _platform_anchor,
        carrier="cable",
        seen_in=("EQ", "CO"),
        sentence="the platform anchors are off by {far} m on average",
        separated_by="tilted poses; a caliper on the platform",
        extension="platform_anchors",
    ),
    Cause(
        "unstrained_length_offset",
        "zero offset of the cable lengths",
        (Parameter("length_offset", "m", 4e-3),),
        _offset,
        carrier="cable",
        seen_in=("CO", "NS"),
        sentence="the zero of the cable lengths is off by {rms} m on average",
        sign="paid out = encoder length + this",
        needs=_zeros,
        separated_by="six or more spread poses; homing again",
        extension="length_offset",
    ),
    Cause(
        "drum_scale",
        "cable length per turn of the drum",
        (Parameter("length_scale", "ratio", 1e-3, True),),
        _drum,
        carrier="cable",
        seen_in=("CO",),
        sentence="the winches pay out {percent} of what the encoders say",
        needs=_lengths,
        separated_by="a thermometer; encoder count over a measured metre",
        extension="length_scale",
    ),
    Cause(
        "temperature",
        "cables and frame are warmer or colder than at calibration",
        (Parameter("temperature_change", "K", 15.0, most=60.0),),
        _temperature,
        seen_in=("CO",),
        sentence="the temperature of cables and frame is {value} K off the calibration temperature",
        sign="positive: warmer",
        needs=_lengths,
        separated_by="a thermometer; the same poses at another temperature",
        extension="length_scale",
    ),
    Cause(
        "pulley_radius",
        "radius of the pulleys",
        (Parameter("pulley_radius", "m", 0.01),),
        _pulley,
        carrier="cable",
        seen_in=("CO", "NS"),
        sentence="the pulley radius is off by {value} m",
        sign="positive: larger than entered",
        needs=_wheels,
        separated_by="poses at other heights",
        extension="pulley_radius",
    ),
    Cause(
        "tracker_frame",
        "the coordinate frame of the tracker differs from that of the robot",
        tuple(Parameter(f"shift_{a}", "m", 3e-3) for a in _XYZ)
        + tuple(Parameter(f"turn_{a}", "rad", 3e-3) for a in _XYZ),
        _tracker,
        seen_in=("CO",),
        needs=_poses,
        sentence="the coordinate frame of the tracker is shifted or rotated by {parts}",
        separated_by="common points measured on the frame",
        shapes=(
            ("shifted", slice(0, 3), 0.25),
            ("turned", slice(3, 6), 0.25),
            ("shifted and turned", slice(None), 0.5),
        ),
    ),
    Cause(
        "gravity_tilt",
        "the frame is not level",
        (Parameter("tilt_x", "rad", 6e-3), Parameter("tilt_y", "rad", 6e-3)),
        _tilt,
        seen_in=("EQ",),
        sentence="the frame is out of level by {norm} rad",
        separated_by="a payload series; a spirit level",
        extension="tilt",
    ),
    Cause(
        "pose_mismatch",
        "the pose entered for a state belongs to another state",
        tuple(Parameter(f"shift_{a}", "m", 0.05) for a in _XYZ)
        + tuple(Parameter(f"turn_{a}", "rad", 0.03) for a in _XYZ),
        _pose,
        seen_in=("EQ", "CO"),
        needs=_poses,
        sentence="the pose entered for one state does not belong to its readings",
        separated_by="measuring that pose again",
        carrier="state",
    ),
)

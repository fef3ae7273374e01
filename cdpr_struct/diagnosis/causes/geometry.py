"""Where things are, other than entered."""

import numpy as np

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter, by_cable
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World

STEEL = 1.2e-5  # [1/K], cables and frame
_XYZ = ("x", "y", "z")


def _frame_anchor(world: World, theta: np.ndarray) -> World:
    return world.plus(frame_anchors=by_cable(theta, 3))


def _platform_anchor(world: World, theta: np.ndarray) -> World:
    return world.plus(platform_anchors=by_cable(theta, 3))


def _offset(world: World, theta: np.ndarray) -> World:
    return world.plus(length_offset=theta)


def _drum(world: World, theta: np.ndarray) -> World:
    return world.times(length_scale=np.exp(theta))


def _temperature(world: World, theta: np.ndarray) -> World:
    grown = 1.0 + STEEL * theta
    return world.times(length_scale=grown, frame_anchors=grown[..., None])


def _pulley(world: World, theta: np.ndarray) -> World:
    return world.plus(pulley_radius=np.maximum(theta, -0.9 * world.pulley_radius))


def _tracker(world: World, theta: np.ndarray) -> World:
    return world.plus(tracker=theta)


def _tilt(world: World, theta: np.ndarray) -> World:
    return world.plus(tilt=theta)


def _pose(world: World, theta: np.ndarray) -> World:
    return world.plus(pose_offset=theta)


def _lengths(setting: Setting) -> str:
    return "" if setting.with_length.any() or setting.locked.size else "needs lengths from the encoders"


def _lengths_or_null(setting: Setting) -> str:
    return "" if not _lengths(setting) or setting.sent.null_space.any() else _lengths(setting)


def _states(setting: Setting) -> int:
    return len(setting.campaign.states.names)


CAUSES = (
    Cause(
        "frame_anchor_position",
        "frame anchors are not where entered",
        tuple(Parameter(f"frame_anchor_{a}", "m", 5e-3) for a in _XYZ),
        _frame_anchor,
        True,
        seen_in=("CO", "NS", "LP"),
        sentence="frame anchors are off, by {far} m in the mean",
        separated_by="platform rotations among the poses; a laser tracker on the pulleys",
        extension="frame_anchors",
    ),
    Cause(
        "platform_anchor_position",
        "platform anchors are not where entered",
        tuple(Parameter(f"platform_anchor_{a}", "m", 4e-3) for a in _XYZ),
        _platform_anchor,
        True,
        seen_in=("EQ", "CO", "LP"),
        sentence="platform anchors are off, by {far} m in the mean",
        separated_by="tilted poses; a caliper on the platform",
        extension="platform_anchors",
    ),
    Cause(
        "unstrained_length_offset",
        "zero of the cable lengths",
        (Parameter("length_offset", "m", 4e-3),),
        _offset,
        True,
        seen_in=("CO", "NS", "LP"),
        sentence="the length zero is off, by {rms} m in the mean",
        sign="paid out = encoder length + this",
        needs=_lengths_or_null,
        separated_by="six or more spread poses; homing again",
        extension="length_offset",
    ),
    Cause(
        "drum_scale",
        "length a turn of the drum",
        (Parameter("length_scale", "ratio", 1e-3, True),),
        _drum,
        True,
        seen_in=("CO", "LP"),
        sentence="the winches pay out {percent} of what the encoders say",
        needs=_lengths,
        separated_by="a thermometer; encoder count over a measured metre",
        extension="length_scale",
    ),
    Cause(
        "temperature",
        "cables and frame are warmer or colder than at calibration",
        (Parameter("temperature_change", "K", 15.0),),
        _temperature,
        seen_in=("CO", "LP"),
        sentence="cables and frame are {value} K off their calibration temperature",
        sign="above zero is warmer",
        needs=_lengths,
        separated_by="a thermometer; the same poses at another temperature",
        extension="length_scale",
    ),
    Cause(
        "pulley_radius",
        "radius of the pulleys",
        (Parameter("pulley_radius", "m", 0.01),),
        _pulley,
        True,
        seen_in=("CO", "NS", "LP"),
        sentence="the pulleys' radius is off by {value} m",
        sign="above zero is larger than entered",
        separated_by="poses at other heights",
        extension="pulley_radius",
    ),
    Cause(
        "tracker_frame",
        "the tracker's frame is not the robot's",
        tuple(Parameter(f"shift_{a}", "m", 3e-3) for a in _XYZ)
        + tuple(Parameter(f"turn_{a}", "rad", 3e-3) for a in _XYZ),
        _tracker,
        seen_in=("CO", "LP"),
        sentence="the tracker's frame is shifted or turned, by {parts}",
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
        seen_in=("EQ", "LP"),
        sentence="the frame is out of level by {norm} rad",
        separated_by="a payload series; a spirit level",
        extension="tilt",
    ),
    Cause(
        "pose_mismatch",
        "the pose of a state is not the one that was measured there",
        tuple(Parameter(f"shift_{a}", "m", 0.05) for a in _XYZ)
        + tuple(Parameter(f"turn_{a}", "rad", 0.03) for a in _XYZ),
        _pose,
        seen_in=("EQ", "CO", "LP"),
        sentence="the pose entered for one state is not the one that was measured there",
        separated_by="measuring that pose again",
        count=_states,
    ),
)

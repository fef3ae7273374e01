"""Pulleys that nobody entered: a radius, and the axis about which each swivels.

The effect of a small pulley is proportional to its radius, but not linear in the vector radius times axis: each axis is
a column of its own, and a cable has one of them. `choices.py` finds out which. Winches that were homed by a robot
without pulleys have another zero besides: the cable on the pulley at home counts as none.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen, by_carrier
from cdpr_struct.robot.robot_arrays import RobotArrays

AXES = ("up", "down", "+x", "-x", "+y", "-y", "outwards", "inwards", "left", "right")
"""Along which the cable comes to its pulley, world; outwards of the middle of the frame anchors, left of one who looks
outwards."""
_SIZE = 0.01  # m, one sigma of the radius at the scale 1
_LEAST = 2e-3  # m, radius of the smallest pulley that a cable runs over
_HOMED = 0.02  # m, one sigma of the zero that homing without pulleys leaves, at the same scale
_LEAN = 0.1  # rad, one sigma of each of two angles between an axis and the nearest of `AXES`, at a radius of `_SIZE`
_FLAT = 1e-3  # m, radius below which an axis cannot be seen to lean
_OWN = 2  # numbers of a leaning axis
_UPRIGHT = 0.9  # part along z from which an axis leans from the vertical, not sideways and up
_NOTHING = 1e-300  # of a length that is divided by
_XYZ = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], dtype=float)


def _with_pulleys(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """The robot with a pulley on each cable that has none: radii along `AXES`, zero of lengths, radius times leans."""
    ways = len(AXES)
    each = by_carrier(theta, ways + 1 + _OWN)
    radii, zero, lean = each[..., :ways], each[..., ways], each[..., ways + 1 :]
    size, axis = radii.sum(axis=-1), (radii[..., None] * axes(arrays)).sum(axis=-2)
    length = np.linalg.norm(axis, axis=-1, keepdims=True)
    axis = np.where(length > 0.0, axis / np.maximum(length, _NOTHING), arrays.pulley_axis)
    angle = lean * (size / (size**2 + _FLAT**2))[..., None]
    axis = axis + (angle[..., None] * _beside(axis)).sum(axis=-2)
    axis = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    bare = arrays.pulley_radius == 0.0
    return replace(
        arrays,
        pulley_radius=np.where(bare, np.maximum(size, 0.0), arrays.pulley_radius),
        pulley_axis=np.where(bare[..., None], axis, arrays.pulley_axis),
        length_offset=arrays.length_offset + np.where(bare, zero, 0.0),
    )


def axes(arrays: RobotArrays) -> np.ndarray:
    """(..., m, K, 3) unit vectors of `AXES` of each cable, world."""
    out = arrays.frame_anchors - arrays.frame_anchors.mean(axis=-2, keepdims=True)
    out = out * [1.0, 1.0, 0.0]
    length = np.linalg.norm(out, axis=-1, keepdims=True)
    out = np.where(length > 0.0, out / np.maximum(length, _NOTHING), [1.0, 0.0, 0.0])
    left = np.stack([-out[..., 1], out[..., 0], np.zeros(out.shape[:-1])], axis=-1)
    own = np.stack([out, -out, left, -left], axis=-2)
    return np.concatenate([np.broadcast_to(_XYZ, (*own.shape[:-2], *_XYZ.shape)), own], axis=-2)


def _beside(axis: np.ndarray) -> np.ndarray:
    """(..., 2, 3) two unit vectors across each axis (..., 3): level, and across both."""
    upright = np.abs(axis[..., 2:]) > _UPRIGHT
    level = np.cross(np.where(upright, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), axis)
    level = level / np.linalg.norm(level, axis=-1, keepdims=True)
    return np.stack([level, np.cross(axis, level)], axis=-2)


def _needs(seen: Seen) -> str:
    return "" if seen.bare else "every cable has a pulley in the robot file"


CAUSES = (
    Cause(
        "missing_pulleys",
        "pulleys that the robot file does not have",
        (
            *(Parameter("pulley_radius", "m", _SIZE, positive=True, least=_LEAST) for _ in AXES),
            Parameter("length_offset", "m", _HOMED),
            *(Parameter(f"pulley_lean_{i}", "m", _LEAN * _SIZE) for i in range(1, _OWN + 1)),
        ),
        _with_pulleys,
        carrier="cable",
        alike=0.8,
        one_of=AXES,
        along="lengths homed without them",
        becomes=("unstrained_length_offset",),
        seen_in=("CO", "NS"),
        sentence="the robot file has no pulleys, and the cables run over pulleys of {value} m radius",
        needs=_needs,
        separated_by="a look at where the cables leave the frame; a caliper on the pulleys",
        extension="pulley_radius",
    ),
)

"""Where does the wheel of a pulley face, as an encoder on its swivel axis says?

The angle is that of the wheel's plane, on the side of the cable, about the axis a of the robot file: zero in a
reference direction, positive for a right-handed turn about a. With e the unit part of the cable's direction normal to
a, r that of the reference and a x r beside it,

    angle = atan2(e . (a x r), e . r).

The reference is straight down, or world x for an axis within 10 degrees of the vertical.
"""

import numpy as np

_UPRIGHT = np.sin(np.radians(10.0))  # of an axis against the vertical: below it "down" says little about the wheel


def swivel_reference(axis: np.ndarray) -> np.ndarray:
    """(..., 3) direction of angle zero, world, not yet normal to the axis, for axes (..., 3) unit, as entered."""
    upright = np.linalg.norm(axis[..., :2], axis=-1) < _UPRIGHT
    return np.where(upright[..., None], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0])


def swivel_angle(direction: np.ndarray, axis: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(...) angle [rad] within (-pi, pi] of wheels whose cables leave along `direction`, any length.

    direction, axis, reference : (..., 3) world; a reference that is not normal to the axis counts by its part that is
    """
    beside = np.cross(axis, reference)
    along = np.cross(beside, axis)
    return np.arctan2((direction * beside).sum(axis=-1), (direction * along).sum(axis=-1))


def within_turn(angle: np.ndarray) -> np.ndarray:
    """The same angles [rad] within [-pi, pi)."""
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)

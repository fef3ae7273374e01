"""What a map shows of robots at rest, as a function of smooth numbers that have rates.

The largest of several tensions, or the softest of several directions, has no derivative where two of them are alike, as
they are at many poses of a symmetric robot. Tensions and compliances have one, and the quantity follows from them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.static_stiffness import static_stiffness


@dataclass(frozen=True, slots=True)
class RestQuantity:
    """A quantity of robots at rest.

    smooth  : (rests (n)) -> (n, k) numbers that are nearly linear in small changes
    reduced : (robot, numbers (n, k)) -> (n,) the quantity of a map, in its unit
    """

    smooth: Callable[[OperatingPoint], np.ndarray]
    reduced: Callable[[Robot, np.ndarray], np.ndarray]


def _tensions(rests: OperatingPoint) -> np.ndarray:
    return rests.cables.tension_at_platform


def _sags(rests: OperatingPoint) -> np.ndarray:
    return 1e3 * rests.cables.sag


def _upright(rests: OperatingPoint) -> np.ndarray:
    """z axis of the platform, world axes."""
    return rests.rotation[..., 2]


def _compliances(rests: OperatingPoint) -> np.ndarray:
    """Six compliances of the platform's origin [m/N]: xx, xy, xz, yy, yz, zz."""
    stiffness = static_stiffness(rests.arrays, rests.position, rests.rotation, rests.cables)
    compliance = stiffness.compliance[..., :3, :3]
    return np.asarray((0.5 * (compliance + np.swapaxes(compliance, -1, -2)))[..., *_UPPER])


def _softest(robot: Robot, compliance: np.ndarray) -> np.ndarray:
    matrix = np.empty((len(compliance), 3, 3))
    matrix[:, *_UPPER] = matrix[:, *_UPPER[::-1]] = compliance
    return np.asarray(1e-3 / np.linalg.eigvalsh(matrix)[:, -1])


def _tilt(robot: Robot, axis: np.ndarray) -> np.ndarray:
    level = np.linalg.norm(np.cross(axis, robot.down), axis=-1)
    return np.asarray(np.degrees(np.arctan2(level, -axis @ robot.down)))


_UPPER = np.triu_indices(3)
REST_QUANTITIES = {
    "tension-max": RestQuantity(_tensions, lambda robot, tension: tension.max(axis=1)),
    "tension-min": RestQuantity(_tensions, lambda robot, tension: tension.min(axis=1)),
    "slack-margin": RestQuantity(_tensions, lambda robot, tension: (tension - robot.force_min).min(axis=1)),
    "force-margin": RestQuantity(_tensions, lambda robot, tension: (robot.force_max - tension).min(axis=1)),
    "sag-max": RestQuantity(_sags, lambda robot, sag: sag.max(axis=1)),
    "stiffness-min": RestQuantity(_compliances, _softest),
    "stiffness-vertical": RestQuantity(_compliances, lambda robot, compliance: 1e-3 / compliance[:, -1]),
    "tilt": RestQuantity(_upright, _tilt),
}
"""By the name of the map."""

"""How does the robot move in its modes, in points that can be drawn?

A shape has no size of its own. Each is divided by the largest component of the whole mode: a displacement along x, y or
z of the platform origin or of a point of a cable [m], or a rotation of the platform [rad].
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.robot_modes import RobotModes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot import anchors_in_world

POINTS_PER_HALF_WAVE = 12
_FEWEST, _DOUBLINGS = 48, 4  # intervals a cable; how often they may be halved


@dataclass(frozen=True, slots=True, eq=False)
class ModeMotion:
    """Shapes of k modes of a robot with m cables; the largest component of each mode is 1.

    fractions : (p,) of the unstrained cable from the frame, even, where `cables` is given
    cables    : (k, m, p, 3) world axes [m]
    platform  : (k, 6) motion of the platform origin [m] and rotation [rad], world axes
    stride    : (k,) every so many of the points are enough to draw the mode
    reach     : (k,) displacement of the point of cables or platform that moves most [m]
    """

    fractions: np.ndarray
    cables: np.ndarray
    platform: np.ndarray
    stride: np.ndarray
    reach: np.ndarray


def mode_motion(point: OperatingPoint, modes: RobotModes) -> ModeMotion:
    """Shapes with at least 12 points for each half wave of every cable, as far as 769 points a cable allow."""
    needed = np.maximum(POINTS_PER_HALF_WAVE * half_waves(point, modes.hertz), _FEWEST)
    doublings = np.clip(np.ceil(np.log2(needed / _FEWEST)), 0, _DOUBLINGS).astype(int)
    most = int(doublings.max(initial=0))
    fractions = np.linspace(0.0, 1.0, _FEWEST * 2**most + 1)
    cables = modes.cable_motion(fractions)
    largest = _largest(np.concatenate([cables.reshape(len(cables), -1), modes.platform], axis=1))[:, None]
    moved, platform = cables / largest[..., None, None], modes.platform / largest
    return ModeMotion(fractions, moved, platform, 2 ** (most - doublings), _reach(point, moved, platform))


def half_waves(point: OperatingPoint, hertz: np.ndarray) -> np.ndarray:
    """(k,) half waves of that frequency that fit into a cable where its waves are slowest, the most of all cables."""
    cables = point.cables
    upper, lower = cables.force_z, cables.force_z - cables.whole_weight
    rise = np.where(upper * lower > 0.0, np.minimum(np.abs(upper), np.abs(lower)), 0.0)
    slowest = np.sqrt(np.hypot(cables.force_x, rise) / point.arrays.linear_density)
    return np.asarray(2.0 * hertz * np.max(cables.length / np.maximum(slowest, 1e-9)))


def _reach(point: OperatingPoint, cables: np.ndarray, platform: np.ndarray) -> np.ndarray:
    _, arms = anchors_in_world(point.entered, point.position, point.rotation)
    ends = platform[:, None, :3] + np.cross(platform[:, None, 3:], arms)
    farthest = [np.linalg.norm(moved, axis=-1).reshape(len(moved), -1).max(axis=1) for moved in (cables, ends)]
    return np.asarray(np.maximum(*farthest))


def _largest(components: np.ndarray) -> np.ndarray:
    """(k,) the component of the largest size of each row, with its sign."""
    index = np.abs(components).argmax(axis=1)
    return np.asarray(components[np.arange(len(components)), index])

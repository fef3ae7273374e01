"""Bands of pose and tensions at locked lengths, to first order."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from cdpr_struct.bands.locked_response import LockedResponse
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.tolerances import Spread
from cdpr_struct.statics.equilibrium import rotation_from_vector

_TURN = 1e-5  # rad, by which angles are differentiated


@dataclass(frozen=True, slots=True, eq=False)
class RestBands:
    """Central bands of each number by itself.

    pose : (6, 2) position and angles about x, y, z [m, rad], its sigma pose_sigma (6,)
    tension : (m, 2) at the platform [N], its sigma tension_sigma (m,); never below zero
    """

    pose: np.ndarray
    pose_sigma: np.ndarray
    tension: np.ndarray
    tension_sigma: np.ndarray


def rest_bands(point: OperatingPoint, response: LockedResponse, spread: Spread, level: float) -> RestBands:
    """Bands that hold with a probability `level`; spread: which robots are probable, about this one."""
    reach = ndtri(0.5 + 0.5 * level) * np.array([-1.0, 1.0])
    motion = response.pose @ pose_by_motion(point.rotation).T
    moved, pulled = spread.sigma(motion), spread.sigma(response.tension)
    pose = np.concatenate([point.position, angles_from_rotation(point.rotation)])
    tension = np.maximum(point.cables.tension_at_platform[:, None] + pulled[:, None] * reach, 0.0)
    return RestBands(pose[:, None] + moved[:, None] * reach, moved, tension, pulled)


def pose_by_motion(rotation: np.ndarray) -> np.ndarray:
    """(6, 6) change of position and angles by a small motion of the origin and turn, world axes."""
    result = np.eye(6)
    ways = np.concatenate([np.eye(3), -np.eye(3)]) * _TURN
    angles = angles_from_rotation(rotation_from_vector(ways) @ rotation)
    result[3:, 3:] = ((angles[:3] - angles[3:]) / (2.0 * _TURN)).T
    return result

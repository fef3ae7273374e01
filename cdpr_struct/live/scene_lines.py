"""Curves, arrows and rotations in the form that a 3-D window takes."""

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.reports.figures.robot_geometry import RobotGeometry


def segments(curves: np.ndarray) -> np.ndarray:
    """(c (p - 1), 2, 3) pieces of curves (c, p, 3), curve by curve."""
    return np.stack([curves[:, :-1], curves[:, 1:]], axis=2).reshape(-1, 2, 3)


def arrows(geometry: RobotGeometry, residual: np.ndarray, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """(a, 2, 3) arrows from the platform ends along the cables, and the numbers (a,) of their cables (from 0).

    residual : (m,) towards the frame where positive; nan for none. The largest is drawn `longest` [m] long.
    """
    own = np.flatnonzero(np.nan_to_num(residual) != 0.0)
    along = (geometry.frame - geometry.platform)[own]
    along = along / np.linalg.norm(along, axis=1)[:, None]
    size = longest * residual[own] / max(np.abs(residual[own]).max(initial=0.0), 1e-300)
    start = geometry.platform[own]
    return np.stack([start, start + size[:, None] * along], axis=1), own


def quaternion(rotation: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """(4,) w, x, y, z of a rotation (3, 3) followed by a rotation vector (3,) in world axes [rad]."""
    found: np.ndarray = (Rotation.from_rotvec(turn) * Rotation.from_matrix(rotation)).as_quat(scalar_first=True)
    return found


def linear(colour: np.ndarray) -> np.ndarray:
    """Colours (..., 3) of a screen, 0 to 255, as the intensities that the window takes for each of many lines."""
    share = np.asarray(colour) / 255.0
    low = share <= 0.04045
    return np.rint(255.0 * np.where(low, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)).astype(np.uint8)

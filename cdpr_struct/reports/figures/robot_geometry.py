"""Points, curves and faces of the robot's picture, in the world frame [m]."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot, anchors_in_world

_POINTS_PER_CABLE = 41
_POINTS_PER_WHEEL = 25
_SAME_PLANE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class RobotGeometry:
    """What a picture of the robot needs.

    curves    : (m, p, 3) cables from the frame end to the platform end
    frame, platform : (m, 3) cable ends
    edges     : (e, 2, 3) edges of the platform's hull; spokes from its origin where the anchors span no volume
    triangles : (t, 3) rows of `platform` that make up the hull's faces; none where there is no volume
    """

    curves: np.ndarray
    frame: np.ndarray
    platform: np.ndarray
    edges: np.ndarray
    triangles: np.ndarray

    @property
    def floor(self) -> float:
        """Height of the ground plane in the picture [m]."""
        lowest = float(min(self.frame[:, 2].min(), self.curves[..., 2].min(), self.platform[:, 2].min()))
        return min(0.0, lowest)

    def box(self) -> np.ndarray:
        """(2, 3) lower and upper corner of what the picture shows, with a margin above the floor."""
        everything = np.concatenate([self.frame, self.platform, self.curves.reshape(-1, 3)])
        low, high = everything.min(axis=0), everything.max(axis=0)
        margin = 0.04 * float((high - low).max())
        return np.array([[low[0] - margin, low[1] - margin, self.floor], high + margin])


def robot_geometry(point: OperatingPoint) -> RobotGeometry:
    """Geometry of the robot at rest."""
    platform, _ = anchors_in_world(point.entered, point.position, point.rotation)
    frame = platform - point.cables.offset
    edges, triangles = _hull(platform, point.position)
    curves = cable_curves(point, np.linspace(0.0, 1.0, _POINTS_PER_CABLE))
    return RobotGeometry(curves, frame, platform, edges, triangles)


def unloaded_geometry(robot: Robot, pose: Pose) -> RobotGeometry:
    """Geometry of the robot at a pose that needs no balance: cables are straight lines between their anchors."""
    platform, _ = anchors_in_world(robot, pose.position, pose.rotation)
    edges, triangles = _hull(platform, pose.position)
    curves = np.stack([robot.frame_anchors, platform], axis=1)
    return RobotGeometry(curves, np.array(robot.frame_anchors), platform, edges, triangles)


def cable_curves(point: OperatingPoint, fractions: np.ndarray) -> np.ndarray:
    """(m, p, 3) the hanging cables at fractions (p,) of their unstrained lengths from the frame ends, world [m]."""
    cables = point.cables
    platform, _ = anchors_in_world(point.entered, point.position, point.rotation)
    straight = (cables.weight == 0.0) & ~cables.lump_weight.any(axis=-1)
    along, up = cables.profile(fractions)
    hanging = along[..., None] * cables.heading[:, None, :] + up[..., None] * cables.up[:, None, :]
    taut = fractions[None, :, None] * cables.offset[:, None, :]
    start = (platform - cables.offset)[:, None, :]
    return np.asarray(start + np.where(straight[:, None, None], taut, hanging))


def pulley_wheels(point: OperatingPoint) -> np.ndarray:
    """(w, 25, 3) rims of the wheels that the cables run over, closed, world [m]; empty without pulleys."""
    robot, frame = point.arrays, point.cables.force_at_frame
    turning = robot.pulley_radius > 0.0
    axis, radius = robot.pulley_axis[turning], robot.pulley_radius[turning]
    across = frame[turning] - np.einsum("wi,wi->w", frame[turning], axis)[:, None] * axis
    radial = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    angle = np.linspace(0.0, 2.0 * np.pi, _POINTS_PER_WHEEL)[:, None]
    rim = (1.0 - np.cos(angle)) * radial[:, None, :] + np.sin(angle) * axis[:, None, :]
    return np.asarray(point.entered.frame_anchors[turning, None, :] + radius[:, None, None] * rim)


def _hull(platform: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    try:
        hull = ConvexHull(platform)
    except (QhullError, ValueError):
        return np.stack([np.broadcast_to(origin, platform.shape), platform], axis=1), np.empty((0, 3), dtype=int)
    pairs = {
        tuple(sorted(int(v) for v in np.delete(simplex, corner)))
        for face, simplex in enumerate(hull.simplices)
        for corner, other in enumerate(hull.neighbors[face])
        if np.abs(hull.equations[face] - hull.equations[other]).max() > _SAME_PLANE
    }
    return platform[np.array(sorted(pairs))], hull.simplices

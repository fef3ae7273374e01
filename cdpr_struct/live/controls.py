"""What the sliders say, and how far they go."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot

_LARGEST_TURN = 60.0  # deg, of a slider
_SLACK = 0.1  # of its length may a cable be let out or hauled in


@dataclass(frozen=True, slots=True)
class Controls:
    """Values of the sliders.

    pose    : x, y, z [m], rx, ry, rz [deg]: held, or with lengths where the search for a rest begins
    payload : point mass at the platform origin [kg]
    lengths : locked unstrained lengths [m]; None: the pose is held
    """

    pose: tuple[float, ...]
    payload: float = 0.0
    lengths: tuple[float, ...] | None = None

    @property
    def placed(self) -> Pose:
        """The pose as position and rotation."""
        return Pose.from_degrees(list(self.pose))

    def at(self, pose: Pose) -> "Controls":
        """The same with another pose."""
        return replace(self, pose=tuple(pose.in_degrees()))


@dataclass(frozen=True, slots=True)
class Ranges:
    """Least and greatest value of each slider, in the units of `Controls`."""

    pose: tuple[tuple[float, float], ...]
    payload: tuple[float, float]
    lengths: tuple[tuple[float, float], ...]


def slider_ranges(robot: Robot, start: Controls, lengths: np.ndarray) -> Ranges:
    """Positions within the frame, and the start wherever it is; lengths (m,) [m] about those at the start."""
    corners = np.stack([robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)])
    corners[0, 2] = min(corners[0, 2], 0.0)
    there = np.array(start.pose)
    low, high = np.minimum(corners[0], there[:3]), np.maximum(corners[1], there[:3])
    turn = np.maximum(np.abs(there[3:]), _LARGEST_TURN)
    pose = [*zip(low.tolist(), high.tolist(), strict=True), *((-float(t), float(t)) for t in turn)]
    most = max(2.0 * robot.platform.mass, 2.0 * start.payload, 10.0)
    wide = [((1.0 - _SLACK) * float(length), (1.0 + _SLACK) * float(length)) for length in lengths]
    return Ranges(tuple(pose), (0.0, most), tuple(wide))

"""Wind that presses on the cables of a robot."""

from __future__ import annotations

import numpy as np

from cdpr_struct.fem_reference.robot import RobotData

SETTLED = 1e-12  # of the largest pressure, between two rounds of statics


def pressure(robot: RobotData, starts: np.ndarray, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Force (m, 3) [N/m] of the wind on each metre of the cables from `starts` (m, 3) [m] to a platform at a pose.

    The air meets a cylinder at an angle a with its axis: its speed across is U sin a, the dynamic pressure of that acts
    on the width, in the plane of axis and wind, square to the axis.
    """
    if not robot.windy:
        return np.zeros_like(starts)
    speed, width = float(np.linalg.norm(robot.wind)), np.array([cable.drag_width for cable in robot.cables])
    axes = position + robot.platform_anchors @ rotation.T - starts
    square = np.cross(axes, np.cross(robot.wind, axes))  # in that plane, square to the axis
    length, reach = np.linalg.norm(axes, axis=1), np.linalg.norm(square, axis=1)
    sine = reach / (speed * length**2)
    stagnation = 0.5 * robot.air_density * (speed * sine) ** 2
    return np.asarray((stagnation * width / np.maximum(reach, 1e-300))[:, None] * square)


def settled(before: np.ndarray, after: np.ndarray) -> bool:
    """Whether the wind presses as in the round before."""
    return bool(np.abs(after - before).max() <= SETTLED * np.abs(after).max())

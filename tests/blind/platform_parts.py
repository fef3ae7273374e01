"""Parts of the platform that do not move with it: each sits on a spring along an axis of the platform."""

from __future__ import annotations

import numpy as np
from scipy.sparse import block_array, csc_array

from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot

PART_HZ = 4.5  # of a part on its spring, the platform held


def with_parts(
    robot: EnteredRobot, deviations: Deviations, rotation: np.ndarray, stiffness: csc_array, mass: csc_array
) -> tuple[csc_array, csc_array]:
    """Matrices whose last unknowns are the platform's (6), with parts on springs behind them.

    A part moves along its axis of the platform by so much more than the platform's origin: last unknowns, one each.
    """
    size = stiffness.shape[0]
    for axis in np.flatnonzero(deviations["flexible_platform"]):
        part = float(robot.mass * deviations["flexible_platform"][axis])
        dragged = np.zeros((stiffness.shape[0], 1))
        dragged[size - 6 : size - 3, 0] = part * rotation[:, axis]
        own = np.array([[part]])
        mass = csc_array(block_array([[mass, csc_array(dragged)], [csc_array(dragged.T), csc_array(own)]]))
        spring = csc_array(own * (2.0 * np.pi * PART_HZ) ** 2)
        stiffness = csc_array(block_array([[stiffness, None], [None, spring]]))
    return stiffness, mass


def moving_parts(robot: EnteredRobot, deviations: Deviations, rotation: np.ndarray) -> np.ndarray:
    """(6, 6) [kg] of the platform's mass matrix that sits on springs, along their axes."""
    found = np.zeros((6, 6))
    for axis in np.flatnonzero(deviations["flexible_platform"]):
        part = float(robot.mass * deviations["flexible_platform"][axis])
        found[:3, :3] += part * np.outer(rotation[:, axis], rotation[:, axis])
    return found

"""The first modes of the robot, frequencies and shapes, at very many poses."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.batched_modes import Batch, fits, lowest_shapes
from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at
from cdpr_struct.dynamics.many_poses import poses_of
from cdpr_struct.dynamics.mode_shapes import ritz_shapes, shape_size
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import stability_at
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.workspace.mode_records import unit_shapes
from cdpr_struct.workspace.rest_columns import rest_columns
from cdpr_struct.workspace.work_list import Columns

_CHUNK = 1024  # poses at once
_GENERAL_CABLES = 256  # at once, of the general solver
_ORDER, _HALF_WAVES = 24, 2.5  # of the general solver's expansions
_FEW, _HARMONICS, _MORE_HARMONICS = 24, 4, 6  # up to so many modes, so many harmonics of each cable tell them apart


@dataclass(frozen=True, slots=True, eq=False)
class ShapedModes:
    """The first k modes at n poses.

    hertz  : (n, k) ascending; nan where the platform is not held, or not stable
    shapes : (n, k, d) of length one, see `dynamics/mode_shapes.py`; zero where there is none. Half precision
    """

    hertz: np.ndarray
    shapes: np.ndarray

    def take(self, index: np.ndarray) -> "ShapedModes":
        """Some poses."""
        return ShapedModes(self.hertz[index], self.shapes[index])


def harmonics(count: int) -> int:
    """Harmonics of each cable in the shapes of so many modes."""
    return _HARMONICS if count <= _FEW else _MORE_HARMONICS


def bytes_of_pose(robot: Robot, count: int) -> int:
    """What `ShapedModes` of a pose take in memory."""
    return count * (8 + 2 * shape_size(len(robot.cables), harmonics(count)))


def shaped_modes(
    robot: Robot,
    positions: np.ndarray,
    rotation: np.ndarray,
    count: int,
    parts: int,
    found: InverseSolution | None = None,
) -> tuple[ShapedModes, Columns]:
    """First `count` modes at positions (n, 3) and one rotation or (n, 3, 3), and columns `held`, `slack_cables`.

    Exact catenaries, minimum-norm tensions within the robot's force limits.

    parts : harmonics of each cable in the shapes;  found : the tensions that hold the poses, where they are known
    """
    n = len(positions)
    hertz = np.full((n, count), np.nan)
    shapes = np.zeros((n, count, shape_size(len(robot.cables), parts)), dtype=np.float16)
    solution = inverse(robot, positions, rotation, allow_unheld=True) if found is None else found
    held = np.flatnonzero(solution.held)
    if held.size:
        states = solution.cables if held.size == n else solution.cables.at(held)
        turned = np.broadcast_to(rotation, (n, 3, 3))[held]
        point = OperatingPoint(robot, positions[held], turned, states)
        how = stability_at(point)
        chosen = np.flatnonzero(~how.unstable)
        for start in range(0, chosen.size, _CHUNK):
            own = chosen[start : start + _CHUNK]
            squared, moved = _at_rest(poses_of(point, own), how.neutral[own], count, parts)
            hertz[held[own]], shapes[held[own]] = np.sqrt(squared) / (2.0 * np.pi), unit_shapes(moved)
    return ShapedModes(hertz, shapes), rest_columns(solution)


def _at_rest(point: OperatingPoint, neutral: np.ndarray, count: int, parts: int) -> tuple[np.ndarray, np.ndarray]:
    """Squared frequencies and shapes at stable poses: the fast path's, else the general solver's."""
    n = len(point.position)
    squared = np.full((n, count), np.nan)
    shapes = np.zeros((n, count, shape_size(len(point.entered.cables), parts)))
    fast = np.flatnonzero(fits(point) & (neutral == 0))
    if fast.size:
        batch = Batch.of(poses_of(point, fast))
        for group in batch.groups:
            found, shapes[fast[group]] = lowest_shapes(batch.take(group), count, parts)
            squared[fast[group]] = found.squared
    left = np.flatnonzero(~np.isfinite(squared).all(axis=1))
    size = max(1, _GENERAL_CABLES // point.cables.length.shape[-1])
    for start in range(0, left.size, size):
        own = left[start : start + size]
        squared[own], shapes[own] = _general(poses_of(point, own), count, parts)
    return squared, shapes


def _general(point: OperatingPoint, count: int, parts: int) -> tuple[np.ndarray, np.ndarray]:
    full = expand_catenaries_at(point, _ORDER)
    highest = _HALF_WAVES * float(np.sqrt(full.omega_squared[..., 0].max()))
    modes = ritz_modes(point, full.reduced(highest, factor=1.2), count)
    return modes.omega**2, ritz_shapes(point, modes, parts)

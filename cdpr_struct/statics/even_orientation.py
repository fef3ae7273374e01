"""At which orientation are the tensions of a platform most even?

Sought is the least spread of the tensions at the platform over the angles that may be chosen: the sum of
(T_i / mean - 1)^2, with the tensions of least norm that hold the pose. Damped least squares of all poses at once, begun
where the platform hangs freely; derivatives are differences. Unlike a platform that hangs freely, one at the most even
tensions is turned there by its cables, so it takes six of them or more.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.free_orientation import free_orientation
from cdpr_struct.statics.hanging_search import within_largest_turn
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

_ROUNDS = 80
_DIFFERENCE = 1e-5  # [rad]
_SETTLED = 1e-8  # of a step [rad]


@dataclass(frozen=True, slots=True, eq=False)
class EvenOrientation:
    """Orientations of a flat batch (k).

    angles : (k, 3) rx, ry, rz [rad];  rotation : (k, 3, 3) platform to world
    spread : (k,) standard deviation of the tensions over their mean
    found  : (k,) bool, held, and the search has settled
    solution : the tensions there
    """

    angles: np.ndarray
    rotation: np.ndarray
    spread: np.ndarray
    found: np.ndarray
    solution: InverseSolution


def even_orientation(
    robot: Robot, position: npt.ArrayLike, angles: npt.ArrayLike, free: npt.ArrayLike, model: str = "sagging"
) -> EvenOrientation:
    """Orientations of the most even tensions within the robot's force limits.

    Parameters
    ----------
    position, angles : (k, 3) [m]; (3,) or (k, 3) rx, ry, rz [rad], the angles that are kept, and where the search
        begins at poses at which the platform cannot hang freely
    free : (3,) bool, which of rx, ry, rz may be chosen
    """
    place, chosen = np.asarray(position, dtype=float), np.flatnonzero(free)
    given = np.array(np.broadcast_to(np.asarray(angles, dtype=float), place.shape))
    hung = free_orientation(robot, place, given, free, model=model)
    now = np.where(hung.found[:, None], hung.angles, given)
    search = _Search(RobotArrays.of(robot), place, model)
    uneven = search.uneven(now)
    damping, settled = np.full(len(place), 1e-3), np.zeros(len(place), dtype=bool)
    for _ in range(_ROUNDS):
        step = search.step(now, uneven, chosen, damping)
        tried = search.uneven(now + step)
        better = (tried**2).sum(axis=1) < (uneven**2).sum(axis=1)
        settled |= np.abs(step).max(axis=1) <= _SETTLED
        now, uneven = np.where(better[:, None], now + step, now), np.where(better[:, None], tried, uneven)
        damping = np.where(better, np.maximum(0.2 * damping, 1e-12), 8.0 * damping)
        if settled.all():
            break
    solution = search.solved(now)
    spread = np.where(solution.held, np.sqrt((uneven**2).mean(axis=1)), np.nan)
    rotation = rotation_from_angles(*np.moveaxis(now, -1, 0))
    return EvenOrientation(now, rotation, spread, solution.held & settled, solution)


@dataclass(frozen=True, slots=True, eq=False)
class _Search:
    """Tensions of a robot at positions (k, 3) [m]."""

    arrays: RobotArrays
    position: np.ndarray
    model: str

    def solved(self, angles: np.ndarray) -> InverseSolution:
        rotation = rotation_from_angles(*np.moveaxis(angles, -1, 0))
        return inverse(self.arrays, self.position, rotation, self.model, allow_unheld=True)

    def uneven(self, angles: np.ndarray) -> np.ndarray:
        """(k, m) tensions over their mean, less one; large where a pose is not held."""
        solution = self.solved(angles)
        mean = np.maximum(solution.tensions.mean(axis=1, keepdims=True), 1e-300)
        return np.where(solution.held[:, None], solution.tensions / mean - 1.0, 1e6)

    def step(self, angles: np.ndarray, uneven: np.ndarray, chosen: np.ndarray, damping: np.ndarray) -> np.ndarray:
        """(k, 3) damped Gauss-Newton step [rad]."""
        rates = []
        for i in chosen:
            shifted = angles.copy()
            shifted[:, i] += _DIFFERENCE
            rates.append((self.uneven(shifted) - uneven) / _DIFFERENCE)
        slopes = np.stack(rates, axis=-1)
        across = np.swapaxes(slopes, -1, -2)
        normal = across @ slopes
        scale = np.einsum("kii->ki", normal).max(axis=1) * damping
        normal = normal + np.maximum(scale, 1e-30)[:, None, None] * np.eye(len(chosen))
        step = np.zeros_like(angles)
        step[:, chosen] = -np.linalg.solve(normal, across @ uneven[..., None])[..., 0]
        return within_largest_turn(step)

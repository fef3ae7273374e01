"""Balance and stability of a platform, written down a second time; nothing here is taken from the program.

Moments and turns are about the middle of the cables' platform ends, so that cables that meet in a point have no arms.
"""

from dataclasses import dataclass

import numpy as np

from benchmarks.random_robots.own_cables import solved
from cdpr_struct import Pose, Robot

_ROUNDED = 1e-5  # of EA: a share of the scale of forces, for lengths are rounded


@dataclass(frozen=True, slots=True, eq=False)
class OwnRest:
    """A platform at a pose on cables of given lengths.

    forces    : (m, 3) of the cables on the platform [N]
    misfit    : of the cables' ends, over their chords [-]
    unbalanced : wrench that is left over, over `scale` [-]
    scale     : load, tensions and a little of EA together [N]
    tangent, mass : (f, f) stiffness and mass of the free motions, rotations as arcs [N/m, kg]
    turning   : (3, 3) stiffness of turns by the weight alone where all cables meet in a point, else None [N m]
    weight_scale : the platform's weight times its radius, the size of `turning` [N m]
    """

    forces: np.ndarray
    misfit: float
    unbalanced: float
    scale: float
    tangent: np.ndarray
    mass: np.ndarray
    turning: np.ndarray | None
    weight_scale: float

    @property
    def eigenvalues(self) -> np.ndarray:
        """(f,) of the tangent over the largest, ascending."""
        values = np.linalg.eigvalsh(self.tangent)
        return np.asarray(values / max(np.abs(values).max(), 1e-300))

    def verdict(self, sharp: float = 1e-8) -> str:
        """Stable, unstable, or neither for certain."""
        least = float(self.eigenvalues[0])
        if self.turning is not None:
            least_turn = float(np.linalg.eigvalsh(self.turning)[0]) / max(self.weight_scale, 1e-300)
            if abs(least_turn) > sharp and len(self.tangent) == 6:
                held = np.linalg.eigvalsh(self.tangent[:3, :3])
                least = min(float(held[0] / max(np.abs(held).max(), 1e-300)), least_turn)
        return "stable" if least > sharp else "unstable" if least < -sharp else "unclear"

    def hertz(self) -> np.ndarray:
        """(f,) of the platform on massless cables, negative for those that grow [Hz]."""
        lower = np.linalg.inv(np.linalg.cholesky(self.mass))
        squared = np.linalg.eigvalsh(lower @ self.tangent @ lower.T)
        return np.asarray(np.sign(squared) * np.sqrt(np.abs(squared)) / (2.0 * np.pi))


def own_rest(
    robot: Robot, pose: Pose | tuple[np.ndarray, np.ndarray], lengths: np.ndarray, guess: np.ndarray
) -> OwnRest:
    """The rest at a pose, or at position and rotation, on cables of unstrained `lengths` (m,) [m].

    guess : (m, 3) forces of the cables on the platform from which their own are sought [N]
    """
    position, turn = (pose.position, pose.rotation) if isinstance(pose, Pose) else pose
    middle = robot.platform_anchors.mean(axis=0)
    arms, center = (robot.platform_anchors - middle) @ turn.T, turn @ (robot.platform.center_of_mass - middle)
    offset = position + robot.platform_anchors @ turn.T - robot.frame_anchors
    pull, stiffness, misfit = solved(robot, offset, np.asarray(lengths, dtype=float), -guess)
    weight = np.array([0.0, 0.0, -robot.platform.mass * robot.gravity])
    radius = max(float(np.sqrt((arms**2).sum(axis=1).mean())), _gyration(robot))
    wrench = np.concatenate([weight - pull.sum(axis=0), np.cross(center, weight) - np.cross(arms, pull).sum(axis=0)])
    motions = _free_motions(robot, turn @ middle, radius)
    scale = float(np.linalg.norm(weight) + np.linalg.norm(pull, axis=1).sum() + _ROUNDED * robot.axial_stiffness.sum())
    left = motions.T @ wrench
    tangent, turning = _tangent(arms, -pull, stiffness, center, weight)
    together = float(np.abs(arms).max()) <= 1e-12 * radius
    return OwnRest(
        -pull,
        misfit,
        float(np.linalg.norm(left)) / scale,
        scale,
        motions.T @ tangent @ motions,
        motions.T @ _mass(robot, turn, center) @ motions,
        turning if together else None,
        float(np.linalg.norm(weight)) * radius,
    )


def cross_matrix(vector: np.ndarray) -> np.ndarray:
    """(..., 3, 3) of vectors (..., 3): its product with a vector is the cross product."""
    x, y, z = np.moveaxis(vector, -1, 0)
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape((*vector.shape, 3))


def _tangent(
    arms: np.ndarray, force: np.ndarray, stiffness: np.ndarray, center: np.ndarray, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(6, 6) minus the derivative of the wrench, made symmetric, and the part of weight in its turns (3, 3)."""
    moved = np.concatenate([np.broadcast_to(np.eye(3), stiffness.shape), -cross_matrix(arms)], axis=-1)
    tangent = np.einsum("mai,mab,mbj->ij", moved, stiffness, moved)
    turning = -cross_matrix(weight) @ cross_matrix(center)
    tangent[3:, 3:] += turning - (cross_matrix(force) @ cross_matrix(arms)).sum(axis=0)
    return 0.5 * (tangent + tangent.T), 0.5 * (turning + turning.T)


def _mass(robot: Robot, turn: np.ndarray, center: np.ndarray) -> np.ndarray:
    mass, arm = robot.platform.mass, cross_matrix(center)
    about = turn @ robot.platform.inertia @ turn.T - mass * arm @ arm
    return np.block([[mass * np.eye(3), -mass * arm], [mass * arm, about]])


def _gyration(robot: Robot) -> float:
    return float(np.sqrt(np.trace(robot.platform.inertia) / (2.0 * robot.platform.mass)))


def _free_motions(robot: Robot, middle: np.ndarray, radius: float) -> np.ndarray:
    """(6, f) motions of the point `middle` (3,) and turns of one metre at `radius` that no guide holds."""
    names = ("x", "y", "z", "rx", "ry", "rz")
    motions = np.diag(np.repeat([1.0, 1.0 / radius], 3))
    if robot.guided:
        motions[:3, 3:] = -cross_matrix(middle) / radius
    return motions[:, [name not in robot.guided for name in names]]

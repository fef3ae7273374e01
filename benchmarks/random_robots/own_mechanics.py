"""Cables, balance and stability of a platform, written down a second time; nothing here is taken from the program.

An elastic catenary of unstrained length L, pulled at its platform end by F = (horizontal, V), weight w per length:

    horizontal: F_h (L / EA + ln[(V + T) / (V_0 + T_0)] / w),   up: (V + V_0) L (1 / (2 EA) + 1 / (T + T_0)),

V_0 = V - w L and T_0 at the frame end. Its compliance is the derivative by F, by steps into the complex plane. Without
weight a cable is a spring that cannot push. Moments and turns are about the middle of the cables' platform ends, so
that cables that meet in a point have no arms.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct import Pose, Robot

_STEP = 1e-30  # of the largest force, into the complex plane
_ITERATIONS = 30
_ROUNDED = 1e-5  # of EA: a share of the scale of forces, for lengths are rounded


@dataclass(frozen=True, slots=True, eq=False)
class OwnRest:
    """A platform at a pose on cables of given lengths.

    forces    : (m, 3) of the cables on the platform [N]
    stiffness : (m, 3, 3) of each cable's platform end [N/m]
    misfit    : of the cables' ends, over their chords
    unbalanced : over `scale`, the load, the tensions and a little of EA [N]
    tangent, mass : (f, f) stiffness and mass of the free motions, rotations as arcs [N/m, kg]
    turning   : (3, 3) stiffness of turns by the weight alone where all cables meet in a point, else None [N m]
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
    pull, stiffness, misfit = _solved(robot, offset, np.asarray(lengths, dtype=float), -guess)
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


def end_offset(force: np.ndarray, length: np.ndarray, stiff: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(..., m, 3) platform end minus frame end of cables pulled by `force` (..., m, 3) [N] at the platform end."""
    across, up = np.sqrt(force[..., 0] ** 2 + force[..., 1] ** 2), force[..., 2]
    at_frame = up - weight * length
    pull, frame_pull = np.sqrt(across**2 + up**2), np.sqrt(across**2 + at_frame**2)
    mean = (up + at_frame) * length / (pull + frame_pull)  # (T - T_0) / w
    rising, falling = at_frame.real >= 0.0, up.real <= 0.0
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # of the branches that are not taken
        grown = np.where(rising, (length + mean) / _nonzero(at_frame + frame_pull), 0.0) * weight
        fallen = np.where(falling, (length - mean) / _nonzero(pull - up), 0.0) * weight
        through = np.log(_nonzero(up + pull)) + np.log(_nonzero(frame_pull - at_frame)) - 2.0 * np.log(_nonzero(across))
        bend = np.where(rising, np.log1p(grown), np.where(falling, np.log1p(fallen), through)) / weight
    flat = force[..., :2] * (length / stiff + bend)[..., None]
    return np.concatenate([flat, ((up + at_frame) * length / (2.0 * stiff) + mean)[..., None]], axis=-1)


def _nonzero(value: np.ndarray) -> np.ndarray:
    return np.where(value == 0.0, 1e-300, value)


def compliance(force: np.ndarray, length: np.ndarray, stiff: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(m, 3, 3) derivative of `end_offset` by the force [m/N]."""
    step = _STEP * np.abs(force).max(axis=1)
    pushed = force[None] + 1j * step[None, :, None] * np.eye(3)[:, None, :]
    return np.moveaxis(end_offset(pushed, length, stiff, weight).imag / step[None, :, None], 0, -1)


def _solved(
    robot: Robot, offset: np.ndarray, length: np.ndarray, pull: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces (m, 3) on the cables' platform ends, stiffnesses (m, 3, 3), and the misfit of ends over chords."""
    stiff, weight = robot.axial_stiffness, robot.weight_per_length
    chord = np.linalg.norm(offset, axis=1)
    if robot.gravity == 0.0:
        return *_springs(offset, chord, length, stiff), 0.0
    for _ in range(_ITERATIONS):
        pull = _off_axis(pull)
        left = end_offset(pull, length, stiff, weight) - offset
        step = np.linalg.solve(compliance(pull, length, stiff, weight), left[..., None])[..., 0]
        size = np.linalg.norm(pull, axis=1)
        pull = pull - step * np.minimum(1.0, 0.5 * size / np.maximum(np.linalg.norm(step, axis=1), 1e-300))[:, None]
        if (np.linalg.norm(step, axis=1) <= 1e-13 * size).all():
            break
    pull = _off_axis(pull)
    left = np.linalg.norm(end_offset(pull, length, stiff, weight) - offset, axis=1) / chord
    return pull, np.linalg.inv(compliance(pull, length, stiff, weight)), float(left.max())


def _off_axis(pull: np.ndarray) -> np.ndarray:
    """Forces with a trace of horizontal pull where they are vertical: directions then have derivatives."""
    size, across = np.linalg.norm(pull, axis=1), np.linalg.norm(pull[:, :2], axis=1)
    return np.where((across < 1e-12 * size)[:, None], pull + 1e-12 * size[:, None] * [1.0, 0.0, 0.0], pull)


def _springs(
    offset: np.ndarray, chord: np.ndarray, length: np.ndarray, stiff: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    along = offset / chord[:, None]
    strain = chord / length - 1.0
    tension = stiff * np.maximum(strain, 0.0)
    lengthwise = along[:, :, None] * along[:, None, :]
    rate = np.where(strain > 0.0, stiff / length, 0.0)[:, None, None] * lengthwise
    return tension[:, None] * along, rate + (tension / chord)[:, None, None] * (np.eye(3) - lengthwise)


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

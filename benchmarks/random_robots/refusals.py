"""Is a refusal true? Cables cannot hold a pose if a linear program shows it; they can if taut ones do with room left.

The force of a cable on the platform is a u - q e_z, u along the chord to the frame, q from 0 to the cable's own weight.
What no a and q balance is proven to be out of reach, for cables up to 3.3 chords long and strains up to 5 %, within
which the program promises to look. What taut cables balance at half of their weight, well within all bounds, and with
cables to spare in every direction, could be held.
"""

import numpy as np
from scipy.optimize import linprog

from cdpr_struct import Pose, Robot

_LONGEST = 3.3  # chords
_STRAIN = 0.05
_TAUT = 5.0  # weights of the cable
_ROOM = 0.1  # of every bound
_ZERO = 1e-9  # of the load


def holdable(robot: Robot, pose: Pose) -> str:
    """Whether cables can hold a pose: "no", "yes" or "unknown"."""
    pulls, arms, chord = _chords(robot, pose)
    if chord.min() <= 1e-9 * np.abs(robot.frame_anchors).max():
        return "no"
    rows, load = _balance(robot, pose, pulls, arms)
    own = robot.weight_per_length * chord
    scale = max(float(np.linalg.norm(load)), float(robot.force_min.sum()), 1e-300)
    if _unbalanced(rows, load, *_widest(robot, own), scale) > _ZERO:
        return "no"
    m = len(own)
    low = np.maximum(np.maximum(robot.force_min, _TAUT * own) * (1.0 + _ROOM) + own, 1e-3 * scale)
    high = np.minimum(robot.force_max * (1.0 - _ROOM) - own, 0.8 * _STRAIN * robot.axial_stiffness)
    full = np.linalg.matrix_rank(rows[:, :m], tol=1e-6) == len(rows)
    if full and (low < high).all() and _unbalanced(rows, load, (low, high), (0.5 * own, 0.5 * own), scale) <= _ZERO:
        return "yes"
    return "unknown"


def _chords(robot: Robot, pose: Pose) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    arms = robot.platform_anchors @ pose.rotation.T
    offset = robot.frame_anchors - pose.position - arms
    chord = np.linalg.norm(offset, axis=1)
    return offset / np.maximum(chord, 1e-300)[:, None], arms, chord


def _balance(robot: Robot, pose: Pose, pulls: np.ndarray, arms: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows (f, 2 m) of the free wrench by pulls and weights of the cables, and the load (f,)."""
    radius = max(float(np.abs(arms).max()), 1e-3)
    down = np.broadcast_to([0.0, 0.0, -1.0], pulls.shape)
    forces, at = np.concatenate([pulls, down]), np.concatenate([arms, arms])
    rows = np.concatenate([forces, np.cross(at, forces) / radius], axis=1).T
    weight = np.array([0.0, 0.0, -robot.platform.mass * robot.gravity])
    load = np.concatenate([weight, np.cross(pose.rotation @ robot.platform.center_of_mass, weight) / radius])
    free = [name not in robot.guided for name in ("x", "y", "z", "rx", "ry", "rz")]
    return rows[free], load[free]


def _widest(robot: Robot, own: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Bounds of a and q beyond which the program does not promise to look."""
    heaviest = _LONGEST * own
    low = np.maximum(robot.force_min - heaviest, 0.0)
    high = np.minimum(robot.force_max + heaviest, _STRAIN * robot.axial_stiffness)
    return (low, np.maximum(high, low)), (np.zeros_like(own), heaviest)


def _unbalanced(
    rows: np.ndarray,
    load: np.ndarray,
    pull: tuple[np.ndarray, np.ndarray],
    weight: tuple[np.ndarray, np.ndarray],
    scale: float,
) -> float:
    """Least sum of what is left of the load, over `scale`."""
    f, n = rows.shape
    cost = np.concatenate([np.zeros(n), np.ones(2 * f)])
    low, high = (np.concatenate([pull[i], weight[i]]) / scale for i in (0, 1))
    bounds = [*zip(low, high, strict=True), *[(0.0, None)] * (2 * f)]
    found = linprog(cost, A_eq=np.hstack([rows, np.eye(f), -np.eye(f)]), b_eq=-load / scale, bounds=bounds)
    return float(found.fun) if found.status == 0 else 0.0

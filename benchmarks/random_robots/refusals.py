"""Is a refusal true? Cables cannot hold a pose if a linear program shows it; they can if taut ones do with room left.

The force of a cable on the platform is a u - q e_z, u along the chord to the frame, q from 0 to the cable's own weight.
What no a and q balance is proven to be out of reach, for cables up to 3.3 chords long and strains up to 5 %, within
which the program promises to look. What taut cables balance at half of their weight, well within all bounds, and with
cables to spare in every direction, could be held. Over pulleys, and where the orientation is sought, cables pull within
cones, each within a pyramid of four edges; of a sought orientation only the forces are asked.
"""

import numpy as np
from scipy.optimize import linprog

from cdpr_struct import Pose, Robot

_LONGEST = 3.3  # chords
_STRAIN = 0.05
_TAUT = 5.0  # weights of the cable
_ROOM = 0.1  # of every bound
_ZERO = 1e-9  # of the load
_WIDEST = 7.0  # tangent of a cone: beyond, directions count as any


def holdable(robot: Robot, pose: Pose, free: bool = False) -> str:
    """Whether cables can hold a pose: "no", "yes" or "unknown".

    free : the orientation is sought, too: "no" is then said of all orientations, and never "yes"
    """
    pulls, arms, chord = _chords(robot, pose)
    if chord.min() <= 1e-9 * np.abs(robot.frame_anchors).max():
        return "unknown" if free else "no"
    if free:
        pulls, chord = _directions(robot.frame_anchors - pose.position)
    own = robot.weight_per_length * (chord + _loose(robot, arms, free))
    weight = np.array([0.0, 0.0, -robot.platform.mass * robot.gravity])
    scale = max(float(np.linalg.norm(weight)), float(robot.force_min.sum()), 1e-12 * float(robot.axial_stiffness.max()))
    cones, low, high = _widest(robot, pulls, _widths(robot, arms, chord, free), own)
    rows, load = _balance(robot, pose, cones, arms, forces_only=free)
    if _unbalanced(rows, load, low, high, scale) > _ZERO:
        return "no"
    if free or any(robot.pulleys):
        return "unknown"
    return "yes" if _well_within(robot, pose, (pulls, arms), own, scale) else "unknown"


def _well_within(robot: Robot, pose: Pose, ends: tuple[np.ndarray, np.ndarray], own: np.ndarray, scale: float) -> bool:
    """Taut cables balance the platform with room left, and any wrench beside its weight."""
    rows, load = _balance(robot, pose, *ends)
    m = len(own)
    low = np.maximum(np.maximum(robot.force_min, _TAUT * own) * (1.0 + _ROOM) + own, 1e-3 * scale)
    high = np.minimum(robot.force_max * (1.0 - _ROOM) - own, 0.8 * _STRAIN * robot.axial_stiffness)
    full = np.linalg.matrix_rank(rows[:, :m], tol=1e-6) == len(rows)
    if not (full and (low < high).all()):
        return False
    half = 0.5 * own
    return _unbalanced(rows, load, np.append(low, half), np.append(high, half), scale) <= _ZERO


def _chords(robot: Robot, pose: Pose) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Directions of pull (m, 3), arms (m, 3) [m] and chords (m,) [m]."""
    arms = robot.platform_anchors @ pose.rotation.T
    pulls, chord = _directions(robot.frame_anchors - pose.position - arms)
    return pulls, arms, chord


def _directions(offset: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    chord = np.linalg.norm(offset, axis=1)
    return offset / np.maximum(chord, 1e-300)[:, None], chord


def _loose(robot: Robot, arms: np.ndarray, free: bool) -> np.ndarray:
    """(m,) how far from its frame anchor, and from where its platform end is taken, a cable may run [m]."""
    wheels = np.array([0.0 if pulley is None else 2.0 * pulley.radius for pulley in robot.pulleys])
    return wheels + (np.linalg.norm(arms, axis=1) if free else 0.0)


def _widths(robot: Robot, arms: np.ndarray, chord: np.ndarray, free: bool) -> np.ndarray:
    """(m,) tangent of the angle by which a pull may differ from its direction; inf where it may be any."""
    sine = _loose(robot, arms, free) / chord
    return np.where(sine < 0.99, sine / np.sqrt(np.maximum(1.0 - sine**2, 1e-4)), np.inf)


def _balance(
    robot: Robot, pose: Pose, pulls: np.ndarray, arms: np.ndarray, forces_only: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (f, n + m) of the free wrench by pulls (n, 3), n a multiple of m, and weights; the load (f,)."""
    radius = max(float(np.abs(arms).max()), 1e-3 * float(np.abs(robot.frame_anchors).max()))
    down = np.broadcast_to([0.0, 0.0, -1.0], arms.shape)
    forces, at = np.concatenate([pulls, down]), np.concatenate([*[arms] * (len(pulls) // len(arms)), arms])
    rows = np.concatenate([forces, np.cross(at, forces) / radius], axis=1).T
    weight = np.array([0.0, 0.0, -robot.platform.mass * robot.gravity])
    load = np.concatenate([weight, np.cross(pose.rotation @ robot.platform.center_of_mass, weight) / radius])
    held = [*robot.guided, *(("rx", "ry", "rz") if forces_only else ())]
    free = [name not in held for name in ("x", "y", "z", "rx", "ry", "rz")]
    return rows[free], load[free]


def _widest(
    robot: Robot, pulls: np.ndarray, widths: np.ndarray, own: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (n, 3) of the cones in which cables pull, n a multiple of m, and bounds of their shares and of q beyond
    which the program does not promise to look."""
    heaviest = _LONGEST * own
    low = np.maximum(robot.force_min - heaviest, 0.0)
    high = np.maximum(np.minimum(robot.force_max + heaviest, _STRAIN * robot.axial_stiffness), low)
    weights = np.zeros_like(own), heaviest
    if not widths.any():
        return pulls, np.append(low, weights[0]), np.append(high, weights[1])
    edges = _edges(pulls, np.minimum(widths, _WIDEST))
    none = np.zeros(len(edges))
    return (
        edges,
        np.append(none, weights[0]),
        np.append(np.tile(np.where(widths < _WIDEST, high, np.inf), 4), weights[1]),
    )


def _edges(pulls: np.ndarray, widths: np.ndarray) -> np.ndarray:
    """(4 m, 3) edges of pyramids around directions (m, 3), in which the cones of these widths (m,) lie."""
    side = np.cross(pulls, np.eye(3)[np.abs(pulls).argmin(axis=1)])
    side /= np.linalg.norm(side, axis=1)[:, None]
    other = np.cross(pulls, side)
    corners = [(a, b) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
    return np.concatenate([pulls + widths[:, None] * (a * side + b * other) for a, b in corners])


def _unbalanced(rows: np.ndarray, load: np.ndarray, low: np.ndarray, high: np.ndarray, scale: float) -> float:
    """Least sum of what is left of the load, over `scale`."""
    f, n = rows.shape
    cost = np.concatenate([np.zeros(n), np.ones(2 * f)])
    bounds = [*zip(low / scale, high / scale, strict=True), *[(0.0, None)] * (2 * f)]
    found = linprog(cost, A_eq=np.hstack([rows, np.eye(f), -np.eye(f)]), b_eq=-load / scale, bounds=bounds)
    return float(found.fun) if found.status == 0 else 0.0

"""Can cables hold a pose? Asked of the forces that they have at many lengths, by the study's own mechanics.

The forces of a cable at a fixed pose are a curve over its length. Where not even sums of forces from the convex hulls
of points on these curves balance the load, the pose is out of reach, but for the curves' bend between two points.
Otherwise a search along the curves from some starts tells how near it comes.
"""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares, linprog

from benchmarks.random_robots.case import Case
from benchmarks.random_robots.own_cables import Wheels, solved

_STRAINS = np.geomspace(0.05, 1e-6, 100)
_SLACK = np.geomspace(1e-6, 2.3, 200)  # length over chord, less one
_FITS = 1e-8  # of the chord: by how much the cables' own shape may miss their ends
_BENT = 7e-3  # of the cables' weights: how far a curve may lie beyond the hull of its points
_STARTS, _STEPS = 12, 120
_HELD = 1e-6  # of the load


def out_of_reach(case: Case) -> str:
    """ "no" if the hulls do not reach the load, else "found" or "not found" by a search, or "unknown"."""
    arms, forces, fits = _curves(case)
    if not fits:
        return "unknown"
    rows, load, scale = _balance(case, arms, forces)
    kept = _within(case, forces)
    if not kept.any(axis=0).all() or _least(rows, load, kept) > _BENT * _weights(case) / scale:
        return "no"
    return "found" if _searched(case, rows, load, forces, scale) <= _HELD else "not found"


def _weights(case: Case) -> float:
    robot, pose = case.robot, case.pose
    offset = pose.position + robot.platform_anchors @ pose.rotation.T - robot.frame_anchors
    return float((robot.weight_per_length * np.linalg.norm(offset, axis=1)).sum())


def _curves(case: Case) -> tuple[np.ndarray, np.ndarray, bool]:
    """Arms (m, 3) [m], forces on the platform (n, m, 3) [N] at n lengths, and whether all were found."""
    robot, pose = case.robot, case.pose
    arms = robot.platform_anchors @ pose.rotation.T
    offset = pose.position + arms - robot.frame_anchors
    straight, pull = _straight(offset, Wheels.of(robot))
    pull = _STRAINS[0] * robot.axial_stiffness[:, None] * pull
    forces, fits = [], True
    with np.errstate(all="ignore"):
        for ratio in np.concatenate([1.0 / (1.0 + _STRAINS), 1.0 + _SLACK]):
            pull, _, misfit = solved(robot, offset, straight * ratio, pull)
            fits &= bool(misfit <= _FITS)
            forces.append(-pull)
    return arms, np.array(forces), fits


def _straight(offset: np.ndarray, wheels: Wheels | None) -> tuple[np.ndarray, np.ndarray]:
    """Length (m,) [m] of straight cables, that on the wheels included, and their directions (m, 3), by repetition."""
    free, arc = offset, np.zeros(len(offset))
    for _ in range(200 if wheels is not None else 0):
        point, arc = wheels.left(free)  # type: ignore[union-attr]
        free = offset - point
    chord = np.linalg.norm(free, axis=1)
    return chord + arc, free / chord[:, None]


def _balance(case: Case, arms: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Free wrenches (n, m, f) of the forces and of the load (f,), over the scale [N]."""
    robot, pose = case.robot, case.pose
    radius = max(float(np.abs(arms).max()), 1e-3 * float(np.abs(robot.frame_anchors).max()))
    weight = np.array([0.0, 0.0, -robot.platform.mass * robot.gravity])
    load = np.concatenate([weight, np.cross(pose.rotation @ robot.platform.center_of_mass, weight) / radius])
    free = [name not in robot.guided for name in ("x", "y", "z", "rx", "ry", "rz")]
    scale = max(float(np.linalg.norm(weight)), float(robot.force_min.sum()), 1e-300)
    rows = np.concatenate([forces, np.cross(arms, forces) / radius], axis=-1)[..., free]
    return rows / scale, load[free] / scale, scale


def _within(case: Case, forces: np.ndarray) -> np.ndarray:
    """(n, m) bool: within the bounds of the tension, or next to a point that is."""
    tension = np.linalg.norm(forces, axis=-1)
    inside = (tension >= case.robot.force_min) & (tension <= case.robot.force_max)
    kept = inside.copy()
    kept[1:] |= inside[:-1]
    kept[:-1] |= inside[1:]
    return kept


def _least(rows: np.ndarray, load: np.ndarray, kept: np.ndarray) -> float:
    """Least unbalance (sum of absolute values), one point of the hull of each cable's forces being chosen."""
    m, f = rows.shape[1:]
    points = np.concatenate([rows[kept[:, i], i] for i in range(m)])
    whose = np.concatenate([np.full(int(kept[:, i].sum()), i) for i in range(m)])
    shares = (whose == np.arange(m)[:, None]).astype(float)
    equations = np.block([[points.T, np.eye(f), -np.eye(f)], [shares, np.zeros((m, 2 * f))]])
    cost = np.concatenate([np.zeros(len(points)), np.ones(2 * f)])
    found = linprog(cost, A_eq=equations, b_eq=np.concatenate([-load, np.ones(m)]), bounds=(0.0, None))
    return float(found.fun) if found.status == 0 else 0.0


def _searched(case: Case, rows: np.ndarray, load: np.ndarray, forces: np.ndarray, scale: float) -> float:
    """Least unbalance, tensions outside their bounds included, found along the curves from many starts."""
    n, m, _ = rows.shape
    low, high = case.robot.force_min / scale, case.robot.force_max / scale
    curves, pulls = CubicSpline(np.arange(n), rows), CubicSpline(np.arange(n), np.linalg.norm(forces, axis=-1) / scale)
    own = np.arange(m)

    def left(place: np.ndarray) -> np.ndarray:
        tension = pulls(place)[own, own]
        outside = np.maximum(low - tension, 0.0) + np.maximum(tension - high, 0.0)
        return np.concatenate([curves(place)[own, own].sum(axis=0) + load, outside])

    rng, best = np.random.default_rng(case.seed), np.inf
    for _ in range(_STARTS):
        start = rng.uniform(0.0, n - 1.0, m)
        ends = least_squares(left, start, bounds=(-1e-9, n - 1.0 + 1e-9), max_nfev=_STEPS)
        best = min(best, float(np.linalg.norm(ends.fun)))
    return best

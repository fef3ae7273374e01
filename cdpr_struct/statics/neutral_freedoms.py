"""In which directions does nothing push the platform back, and is it held in all others?

A freedom is neutral where the static stiffness is zero. Two arguments find it.

By symmetry: a motion that moves no cable end (all ends on one axis, or in one point) costs only what weight, hose and
force do to it. The stiffness of such motions is computed without the cables and is judged against the weight's own
scale, m g r: zero below `NEUTRAL` of that. A centre of mass a micrometre above the point in which the cables meet is
therefore unstable, not neutral, however stiff the cables are.

By size: an eigenvalue of the stiffness below `NEUTRAL` of the largest counts as zero. Rotations count as arcs at r, the
largest of the anchors' mean radius, the radius of gyration and the distance of the centre of mass.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import platform_radius, rotation_from_vector
from cdpr_struct.statics.guides import free_axes

NEUTRAL = 1e-9  # of the largest eigenvalue, or of the weight's own stiffness, below which an eigenvalue counts as zero
_ROUNDING = 1e-14  # of the largest eigenvalue, which is never told from zero
_STILL = 1e-9  # of r: by so much a cable end may move and still count as unmoved


@dataclass(frozen=True, slots=True, eq=False)
class Stability:
    """Of platforms at rest, a batch (...) of them.

    unstable : (...) bool, a small motion grows
    neutral  : (...) number of neutral freedoms
    twists   : (..., 6, k) these as motions of the platform origin and rotations, world axes, rotations of r metres
        orthonormal; k is the largest number of any, the last of those that have fewer are zero
    proved   : (..., k) bool, by symmetry
    holding  : (..., 6, 6) a stiffness that would hold them as the stiffest direction is held [N/m, N, N m]
    """

    unstable: np.ndarray
    neutral: np.ndarray
    twists: np.ndarray
    proved: np.ndarray
    holding: np.ndarray

    @property
    def stable(self) -> np.ndarray:
        """(...) bool: no small motion grows, and none is neutral."""
        return ~self.unstable & (self.neutral == 0)


def stability(arrays: RobotArrays, rotation: np.ndarray, stiffness: np.ndarray, weightless: bool = False) -> Stability:
    """How platforms (...) are held at rest.

    Parameters
    ----------
    rotation : (..., 3, 3) platform to world
    stiffness : (..., 6, 6) symmetric, at locked lengths, world axes, rotations about the platform origin
    weightless : of an assembly that leaves out the work of the weight
    """
    lead, scale = stiffness.shape[:-2], platform_radius(arrays)
    unit = np.where(np.arange(6) < 3, 1.0, scale)
    scaled = (0.5 * (stiffness + np.swapaxes(stiffness, -1, -2)) / unit / unit[:, None]).reshape(-1, 6, 6)
    free = free_axes(arrays)
    values = np.linalg.eigvalsh(scaled[:, free[:, None], free])
    largest = np.abs(values).max(axis=1)
    unstable, found = values[:, 0] < -NEUTRAL * largest, {}
    arms = np.broadcast_to(arrays.platform_anchors @ np.swapaxes(rotation, -1, -2), (*lead, arrays.cable_count, 3))
    arms = arms.reshape((-1, arrays.cable_count, 3))
    own = np.broadcast_to(0.0 if weightless else _own_scale(arrays, scale), lead).reshape(-1)
    for i in np.flatnonzero(values[:, 0] <= NEUTRAL * largest).tolist():
        unstable[i], *found[i] = _examined(scaled[i], free, arms[i] / scale, float(largest[i]), float(own[i]))
    return _gathered(found, unstable, largest, unit, lead)


def turned_least(
    held: Stability, position: np.ndarray, rotation: np.ndarray, start: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) and rotations (n, 3, 3), turned about the axis of their one neutral freedom so far that they
    differ least from rotations (n, 3, 3) at the start; those whose freedom symmetry does not prove as they are."""
    position, rotation = position.copy(), rotation.copy()
    for i in np.flatnonzero((held.neutral == 1) & held.proved[..., :1].any(axis=-1)).tolist():
        moved, turn = held.twists[i, :3, 0], held.twists[i, 3:, 0]
        size = float(np.linalg.norm(turn))
        if not size > 0.0 or abs(moved @ turn) > _STILL * size**2:  # a translation, or a screw
            continue
        axis, center = turn / size, np.cross(turn, moved) / size**2
        apart = rotation[i] @ start[i].T
        along = axis @ apart @ axis
        sine = np.cross(axis, apart.T).trace()
        back = rotation_from_vector(np.arctan2(sine, np.trace(apart) - along) * axis)
        position[i] += center - back @ center
        rotation[i] = back @ rotation[i]
    return position, rotation


def _own_scale(arrays: RobotArrays, radius: float) -> np.ndarray:
    """(...) stiffness against which that of motions which move no cable end is judged [N/m]."""
    return np.asarray((arrays.mass * arrays.gravity + np.linalg.norm(arrays.force, axis=-1)) / radius + arrays.hose)


def _examined(
    scaled: np.ndarray, free: np.ndarray, arms: np.ndarray, largest: float, own: float
) -> tuple[bool, np.ndarray, np.ndarray]:
    """Whether a platform is unstable, its neutral motions (6, k) in scaled coordinates, and which are proved (k,).

    arms : (m, 3) in units of r
    """
    still = np.zeros((6, 0))
    inner = _motionless(arms, free)
    still = np.zeros((6, inner.shape[1]))
    still[free] = inner
    rest = np.zeros((6, len(free) - inner.shape[1]))
    rest[free] = np.linalg.qr(inner, mode="complete")[0][:, inner.shape[1] :] if inner.shape[1] else np.eye(len(free))
    held = rest.T @ scaled @ rest
    values, vectors = np.linalg.eigh(held)
    zero, negative = np.abs(values) <= NEUTRAL * largest, bool((values < -NEUTRAL * largest).any())
    across = still.T @ scaled @ rest
    firm = vectors[:, ~zero]
    softened = still.T @ scaled @ still - (across @ firm / values[~zero]) @ (across @ firm).T
    stiff, turned = np.linalg.eigh(softened)
    tolerance = max(NEUTRAL * own, _ROUNDING * largest)
    by_symmetry = np.abs(stiff) <= tolerance
    negative |= bool((stiff < -tolerance).any())
    motions = np.concatenate([still @ turned[:, by_symmetry], rest @ vectors[:, zero]], axis=1)
    proved = np.arange(motions.shape[1]) < by_symmetry.sum()
    return negative, np.linalg.qr(motions)[0] if motions.shape[1] else motions, proved


def _motionless(arms: np.ndarray, free: np.ndarray) -> np.ndarray:
    """(f, s) orthonormal free motions that move no end of a cable, arms (m, 3)."""
    zero = np.zeros(len(arms))
    x, y, z = arms.T
    turn = np.stack([np.stack([zero, z, -y]), np.stack([-z, zero, x]), np.stack([y, -x, zero])]).transpose(2, 0, 1)
    moved = np.concatenate([np.broadcast_to(np.eye(3), turn.shape), turn], axis=-1).reshape(-1, 6)[:, free]
    _, sizes, motions = np.linalg.svd(moved, full_matrices=True)
    every = np.zeros(len(free))
    every[: len(sizes)] = sizes
    return np.asarray(motions[every <= _STILL * np.sqrt(len(arms))].T)


def _gathered(
    found: dict[int, list[np.ndarray]], unstable: np.ndarray, largest: np.ndarray, unit: np.ndarray,
    lead: tuple[int, ...],
) -> Stability:  # fmt: skip
    n = len(unstable)
    most = max((motions.shape[1] for motions, _ in found.values()), default=0)
    scaled, proved, neutral = np.zeros((n, 6, most)), np.zeros((n, most), dtype=bool), np.zeros(n, dtype=int)
    for i, (motions, sure) in found.items():
        count = motions.shape[1]
        neutral[i], scaled[i, :, :count], proved[i, :count] = count, motions, sure
    held = (scaled * unit[:, None]) * np.sqrt(np.where(largest > 0.0, largest, 1.0))[:, None, None]
    holding = held @ np.swapaxes(held, -1, -2)
    twists = scaled / unit[:, None]
    parts = (unstable, neutral, twists, proved, holding)
    return Stability(*(part.reshape((*lead, *part.shape[1:])) for part in parts))

"""Masts that give way: the frame anchors of a mast move with the pull of all its cables, alike in all directions.

With U the motion of the cable ends per mast and C the masts' compliances, cables of stiffness K at held frame ends are

    K - K U (1 + C U^T K U)^-1 C U^T K

behind masts; a rigid mast (zero in C) changes nothing. A cable hangs on one mast, so that U^T K U has a block of 3 x 3
for each. In vibration the cables' inertia adds to both blocks that the masts take part in.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.cable_state import CableStates

_ITERATIONS = 40
_SETTLED = 1e-15  # of the largest coordinate


def carriers(masts: np.ndarray) -> np.ndarray:
    """(m, n) 1 where a cable hangs on one of n masts; `masts` (m, m) 1 where two cables share one."""
    return np.asarray(masts[:, _first_cables(masts)], dtype=float)


def of_each_mast(masts: np.ndarray, of_cables: np.ndarray) -> np.ndarray:
    """(..., n) what the cables of each of n masts have in common, from (..., m)."""
    return np.asarray(of_cables[..., _first_cables(masts)])


def _first_cables(masts: np.ndarray) -> np.ndarray:
    return np.unique(masts.argmax(axis=1))


def pull_on_masts(arrays: RobotArrays, states: CableStates) -> np.ndarray:
    """(..., n, 3) pull of all cables of each mast, world [N]."""
    return np.einsum("mq,...mk->...qk", carriers(arrays.masts), states.force_at_frame)


def with_settled_masts(
    arrays: RobotArrays, solve: Callable[[RobotArrays], CableStates], locked: bool = True
) -> tuple[CableStates, RobotArrays]:
    """Cables in balance with the masts that they pull, and the robot with its frame anchors there.

    Parameters
    ----------
    solve : states of the cables of a robot with given frame anchors
    locked : the lengths are given, so that the pull changes with the anchors by the cables' stiffness; else the
        tensions are, and it hardly changes
    """
    if not arrays.has_masts:
        return solve(arrays), arrays
    together, give = arrays.masts, arrays.frame_compliance[..., None]
    moved = arrays
    for _ in range(_ITERATIONS):
        states = solve(moved)
        miss = arrays.frame_anchors + give * (together @ states.force_at_frame) - moved.frame_anchors
        if np.abs(miss).max(initial=0.0) <= _SETTLED * np.abs(arrays.frame_anchors).max():
            break
        step = _newton_step(moved, states, together, miss) if locked else miss
        moved = replace(moved, frame_anchors=moved.frame_anchors + step)
    return states, moved


def _newton_step(arrays: RobotArrays, states: CableStates, together: np.ndarray, miss: np.ndarray) -> np.ndarray:
    """(..., m, 3) by which the anchors move; those of a mast miss alike, so each mast is solved for by itself."""
    give = arrays.frame_compliance[..., None, None]
    matrix = np.eye(3) + give * np.einsum("ij,...jab->...iab", together, end_stiffness(arrays, states))
    step: np.ndarray = np.linalg.solve(matrix, miss[..., None])[..., 0]
    return step


Inertia = tuple[np.ndarray, np.ndarray]
"""Of cables whose masts move, two (..., m, 3, 3) [N/m]: rows ends against masts, and masts; columns masts."""


def behind_masts(
    stiffness: np.ndarray,
    cable_ends: np.ndarray,
    masts: np.ndarray,
    compliance: np.ndarray,
    inertia: Inertia | None = None,
) -> np.ndarray:
    """(..., n, n) stiffness of a body on cables behind masts.

    Parameters
    ----------
    stiffness : (..., m, 3, 3) of the cables' platform ends with held frame ends, world [N/m]
    cable_ends : (..., m, 3, n) their motion per motion of the body
    masts, compliance : (m, m) and (..., m) [m/N] of `RobotArrays`
    inertia : in vibration; None at rest
    """
    own = np.einsum("...mai,...mab,...mbj->...ij", cable_ends, stiffness, cable_ends, optimize=True)
    if not compliance.any():
        return own
    on_mast, junction = _mast_blocks(stiffness, cable_ends, masts, compliance, inertia)
    moved = np.linalg.solve(junction, of_each_mast(masts, compliance)[..., None, None] * on_mast)
    return own - np.einsum("...qai,...qaj->...ij", on_mast, moved)


def negative_junctions(
    stiffness: np.ndarray, masts: np.ndarray, compliance: np.ndarray, inertia: Inertia
) -> np.ndarray:
    """(...) negative eigenvalues of the masts' own stiffness with the cables' dynamic one (..., m, 3, 3) on it.

    The clamped frequencies of cables and masts together are those of the clamped cables plus this many.
    """
    nothing = np.zeros((stiffness.shape[-3], 3, 0))
    _, junction = _mast_blocks(stiffness, nothing, masts, compliance, inertia)
    return np.asarray((np.linalg.eigvalsh(junction) < 0.0).sum(axis=(-2, -1)))


def _mast_blocks(
    stiffness: np.ndarray,
    cable_ends: np.ndarray,
    masts: np.ndarray,
    compliance: np.ndarray,
    inertia: Inertia | None,
) -> tuple[np.ndarray, np.ndarray]:
    """U^T K A (..., n, 3, k) and 1 + C U^T K U (..., n, 3, 3) of the n masts."""
    carried, give = carriers(masts), of_each_mast(masts, compliance)[..., None, None]
    across, own_stiffness = stiffness, stiffness
    if inertia is not None:
        back = np.swapaxes(inertia[0], -1, -2)
        across, own_stiffness = stiffness - back, stiffness - inertia[0] - back + inertia[1]
    on_mast = np.einsum("mq,...mak->...qak", carried, across @ cable_ends)
    return on_mast, np.eye(3) + give * np.einsum("mq,...mab->...qab", carried, own_stiffness)

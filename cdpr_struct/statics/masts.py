"""Masts that give way: the frame anchors of a mast move with the pull of all its cables.

A mast is a bracket, whose exits move together and alike in all directions (`frame_compliance`), or an upright clamped
to the floor, which bends sideways and gives way less lower down (`mast_bending`); or both. Either is a set of shapes S,
motions of the exits by one number each: an exit moves by S c S^T F under the pulls F, c being compliances. With A the
motion of the cable ends, cables of stiffness K at held frame ends are

    A^T K A - A^T K S (1 + c S^T K S)^-1 c S^T K A

behind masts; a rigid mast (zero in c) changes nothing. In vibration the cables' inertia adds to both blocks that the
masts take part in.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_response import end_stiffness
from cdpr_struct.statics.cable_state import CableStates

_ITERATIONS = 40
_SETTLED = 1e-15  # of the largest coordinate: where Newton's steps end
_CONVERGED = 1e-11  # of the largest coordinate: a larger step is no rounding


def carriers(masts: np.ndarray) -> np.ndarray:
    """(m, n) 1 where a cable hangs on one of n masts; `masts` (m, m) 1 where two cables share one."""
    return np.asarray(masts[:, _first_cables(masts)], dtype=float)


def of_each_mast(masts: np.ndarray, of_cables: np.ndarray) -> np.ndarray:
    """(..., n) what the cables of each of n masts have in common, from (..., m)."""
    return np.asarray(of_cables[..., _first_cables(masts)])


def _first_cables(masts: np.ndarray) -> np.ndarray:
    return np.unique(masts.argmax(axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class MastShapes:
    """How masts move: shapes (m, 3, q), motion of the exits by each of q numbers, world; compliance (..., q) [m/N]."""

    shapes: np.ndarray
    compliance: np.ndarray

    @classmethod
    def of(cls, arrays: RobotArrays) -> "MastShapes":
        """All shapes of a robot's masts: brackets in x, y and z, then uprights in x and y."""
        together = carriers(arrays.masts)
        uprights = np.broadcast_to(arrays.uprights, arrays.masts.shape)
        bent = uprights[:, uprights.any(axis=0)]
        shapes = [np.einsum("mq,ab->maqb", part, np.eye(3)[:, :axes]) for part, axes in ((together, 3), (bent, 2))]
        flat = np.concatenate([part.reshape((len(together), 3, -1)) for part in shapes], axis=-1)
        first, owner = _first_cables(arrays.masts), (bent != 0.0).argmax(axis=0)
        give = (arrays.frame_compliance, np.repeat(first, 3)), (arrays.mast_bending, np.repeat(owner, 2))
        lead = np.broadcast_shapes(*(value.shape[:-1] for value, _ in give))
        parts = [np.broadcast_to(value, (*lead, len(together)))[..., index] for value, index in give]
        return cls(flat, np.concatenate(parts, axis=-1))

    @classmethod
    def soft(cls, arrays: RobotArrays) -> "MastShapes":
        """Those that give way, in any robot of a batch."""
        every = cls.of(arrays)
        some = every.compliance.reshape(-1, every.compliance.shape[-1]).any(axis=0)
        return cls(every.shapes[..., some], every.compliance[..., some])

    @property
    def scaled(self) -> np.ndarray:
        """(..., m, 3, q) in units of the root of the compliance, in which a mast's own stiffness is one."""
        return self.shapes * np.sqrt(self.compliance)[..., None, None, :]

    def pulled(self, force_at_frame: np.ndarray) -> np.ndarray:
        """(..., q) by pulls (..., m, 3) of the cables [N]."""
        return np.einsum("maq,...ma->...q", self.shapes, force_at_frame)

    def moved(self, numbers: np.ndarray) -> np.ndarray:
        """(..., m, 3) motion of the exits by numbers (..., q) [m]."""
        return np.einsum("maq,...q->...ma", self.shapes, numbers)

    def shift(self, force_at_frame: np.ndarray) -> np.ndarray:
        """(..., m, 3) motion of the exits under pulls (..., m, 3) of the cables [m]."""
        return self.moved(self.compliance * self.pulled(force_at_frame))

    def energy(self, force_at_frame: np.ndarray) -> np.ndarray:
        """(...) elastic energy under pulls (..., m, 3) of the cables [J]."""
        return np.asarray(0.5 * (self.compliance * self.pulled(force_at_frame) ** 2).sum(axis=-1))


def with_settled_masts(
    arrays: RobotArrays, solve: Callable[[RobotArrays], CableStates], locked: bool = True
) -> tuple[CableStates, RobotArrays]:
    """Cables in balance with the masts that they pull, and the robot with its frame anchors there.

    Parameters
    ----------
    solve : states of the cables of a robot with given frame anchors
    locked : the lengths are given, so that the pull changes with the anchors by the cables' stiffness; else the
        tensions are, and it hardly changes

    Raises
    ------
    ConvergenceError : cables and masts find no balance.
    """
    if not arrays.has_masts:
        return solve(arrays), arrays
    masts, moved, size = MastShapes.soft(arrays), arrays, np.abs(arrays.frame_anchors).max()
    numbers = np.zeros(masts.compliance.shape)
    for _ in range(_ITERATIONS):
        states = solve(moved)
        miss = masts.compliance * masts.pulled(states.force_at_frame) - numbers
        if np.abs(miss).max(initial=0.0) <= _SETTLED * size:
            break
        numbers = numbers + (_newton_step(moved, states, masts, miss) if locked else miss)
        moved = replace(moved, frame_anchors=arrays.frame_anchors + masts.moved(numbers))
    if not np.abs(miss).max(initial=0.0) <= _CONVERGED * size:
        hint = "The masts give way too much for these cables; check their compliance [m/N]."
        raise ConvergenceError("masts in balance with their cables", float(np.abs(miss).max()), _ITERATIONS, hint)
    return states, moved


def _newton_step(arrays: RobotArrays, states: CableStates, masts: MastShapes, miss: np.ndarray) -> np.ndarray:
    """(..., q) by which the masts' numbers move."""
    own = np.einsum("maq,...mab,mbp->...qp", masts.shapes, end_stiffness(arrays, states), masts.shapes, optimize=True)
    matrix = np.eye(own.shape[-1]) + masts.compliance[..., None] * own
    step: np.ndarray = np.linalg.solve(matrix, miss[..., None])[..., 0]
    return step


Inertia = tuple[np.ndarray, np.ndarray]
"""Of cables whose masts move, two (..., m, 3, 3) [N/m]: rows ends against masts, and masts; columns masts."""


def behind_masts(
    stiffness: np.ndarray, cable_ends: np.ndarray, arrays: RobotArrays, inertia: Inertia | None = None
) -> np.ndarray:
    """(..., n, n) stiffness of a body on cables behind a robot's masts.

    Parameters
    ----------
    stiffness : (..., m, 3, 3) of the cables' platform ends with held frame ends, world [N/m]
    cable_ends : (..., m, 3, n) their motion per motion of the body
    inertia : in vibration; None at rest
    """
    pulls, n = stiffness @ cable_ends, cable_ends.shape[-1]
    ends = np.swapaxes(cable_ends.reshape((*cable_ends.shape[:-3], -1, n)), -1, -2)
    own = np.asarray(ends @ pulls.reshape((*pulls.shape[:-3], -1, n)))
    if not arrays.has_masts:
        return own
    on_mast, junction = _mast_blocks(stiffness, cable_ends, arrays, inertia)
    return own - np.swapaxes(on_mast, -1, -2) @ np.linalg.solve(junction, on_mast)


def negative_junctions(stiffness: np.ndarray, arrays: RobotArrays, inertia: Inertia) -> np.ndarray:
    """(...) negative eigenvalues of the masts' own stiffness with the cables' dynamic one (..., m, 3, 3) on it.

    The clamped frequencies of cables and masts together are those of the clamped cables plus this many.
    """
    _, junction = _mast_blocks(stiffness, np.zeros((stiffness.shape[-3], 3, 0)), arrays, inertia)
    return np.asarray((np.linalg.eigvalsh(junction) < 0.0).sum(axis=-1))


def _mast_blocks(
    stiffness: np.ndarray, cable_ends: np.ndarray, arrays: RobotArrays, inertia: Inertia | None
) -> tuple[np.ndarray, np.ndarray]:
    """S^T K A (..., q, n) and 1 + S^T K S (..., q, q), S in units of the root of the masts' compliances."""
    scaled = MastShapes.soft(arrays).scaled
    across, own_stiffness = stiffness, stiffness
    if inertia is not None:
        back = np.swapaxes(inertia[0], -1, -2)
        across, own_stiffness = stiffness - back, stiffness - inertia[0] - back + inertia[1]
    on_mast = np.einsum("...maq,...mab,...mbn->...qn", scaled, across, cable_ends, optimize=True)
    own = np.einsum("...maq,...mab,...mbp->...qp", scaled, own_stiffness, scaled, optimize=True)
    return on_mast, np.eye(own.shape[-1]) + own

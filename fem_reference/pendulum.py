"""A mass that hangs on a bar from a point of the platform: three unknowns more, after the platform's, of the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_diag, csc_array

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.bar_element import bar_stiffness
from cdpr_struct.fem_reference.rigid_platform import point_motion


@dataclass(frozen=True, eq=False)
class PendulumData:
    """A bob of a mass [kg] on a weightless bar of a length [m] and an EA [N]; hook (3,), platform frame."""

    mass: float
    length: float
    hook: np.ndarray
    axial_stiffness: float = 1e9

    def __post_init__(self) -> None:
        for name in ("mass", "length", "axial_stiffness"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ValueError(f"PendulumData.{name} must be positive and finite, got {getattr(self, name)!r}")
        object.__setattr__(self, "hook", fixed_array("PendulumData.hook", self.hook, (3,)))


def with_pendulum(
    stiffness: csc_array, inertia: csc_array, rotation: np.ndarray, gravity: np.ndarray, pendulum: PendulumData
) -> tuple[csc_array, csc_array]:
    """Matrices of `robot_matrices` with the bob's displacement (3, world) as further, last unknowns.

    The platform was at rest with the bob as a point mass at its hook: so strong is the pull there, and so it turns with
    the arm. That point's inertia leaves it, and the bob's own and the bar between them come in; the bar is one element
    along gravity (3,) [m/s^2], under the bob's weight.
    """
    down = gravity / np.linalg.norm(gravity)
    pull = pendulum.mass * float(np.linalg.norm(gravity))
    unstrained = pendulum.length / (1.0 + pull / pendulum.axial_stiffness)
    bar = bar_stiffness(down, np.asarray(pull), np.asarray(unstrained), np.asarray(pendulum.axial_stiffness))
    hook = point_motion(rotation @ pendulum.hook)
    ends = np.zeros((6, 9))
    ends[:3, :6], ends[3:, 6:] = hook, np.eye(3)
    heavy = np.zeros((9, 9))
    heavy[:6, :6], heavy[6:, 6:] = -pendulum.mass * hook.T @ hook, pendulum.mass * np.eye(3)
    first = stiffness.shape[0] - 6
    wide = (csc_array(block_diag([matrix, csc_array((3, 3))])) for matrix in (stiffness, inertia))
    more = (csc_array(block_diag([csc_array((first, first)), own])) for own in (ends.T @ bar @ ends, heavy))
    found = [csc_array(matrix + own) for matrix, own in zip(wide, more, strict=True)]
    return found[0], found[1]

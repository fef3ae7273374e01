"""A mass that hangs on a bar from a point of the platform: three unknowns more, after the platform's, of the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, lil_array

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
    n = stiffness.shape[0] + 3
    wide = [lil_array((n, n)), lil_array((n, n))]
    for matrix, whole in zip((stiffness, inertia), wide, strict=True):
        whole[:-3, :-3] = matrix
    wide[0][-9:, -9:] += ends.T @ bar @ ends
    wide[1][-9:-3, -9:-3] -= pendulum.mass * hook.T @ hook
    wide[1][-3:, -3:] += pendulum.mass * np.eye(3)
    return csc_array(wide[0]), csc_array(wide[1])

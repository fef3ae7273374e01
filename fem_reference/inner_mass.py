"""A point mass that slides on a spring inside the platform: one unknown more, before the platform's, of the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_array, csc_array

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.rigid_platform import point_motion


@dataclass(frozen=True, eq=False)
class InnerMassData:
    """Mass [kg], a part of the platform's; spring [N/m]; place and axis (3,), platform frame, the axis of length 1."""

    mass: float
    spring: float
    place: np.ndarray
    axis: np.ndarray

    def __post_init__(self) -> None:
        for name in ("mass", "spring"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ValueError(f"InnerMassData.{name} must be positive and finite, got {getattr(self, name)!r}")
        axis = fixed_array("InnerMassData.axis", self.axis, (3,))
        if abs(float(axis @ axis) - 1.0) > 1e-12:
            raise ValueError(f"InnerMassData.axis must have length 1, got {axis.tolist()!r}")
        object.__setattr__(self, "place", fixed_array("InnerMassData.place", self.place, (3,)))
        object.__setattr__(self, "axis", axis)


def with_inner_mass(
    stiffness: csc_array, inertia: csc_array, rotation: np.ndarray, inner: InnerMassData
) -> tuple[csc_array, csc_array]:
    """Matrices of `robot_matrices` with the slide of the mass as a further, last unknown.

    The mass moves with the platform at its place, and along its axis by the slide: velocity = motion q + axis slide.
    """
    row = np.zeros((1, stiffness.shape[0]))
    row[0, -6:] = inner.mass * (rotation @ inner.axis) @ point_motion(rotation @ inner.place)
    spring, mass = csc_array([[inner.spring]]), csc_array([[inner.mass]])
    wide = block_array([[stiffness, None], [None, spring]])
    return csc_array(wide), csc_array(block_array([[inertia, csc_array(row.T)], [csc_array(row), mass]]))

"""The rigid platform: its mass matrix, its turning lever arms, and what couples them to forces.

A small motion of the platform is q = (displacement of the reference point, rotation), both in world axes.
A point at rho from the reference point moves by translation + rotation x rho, to second order with the
rotation vector of exp([rotation]x).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference.arrays import fixed_array


@dataclass(frozen=True, eq=False)
class PlatformData:
    """Rigid body, described in the platform frame, whose origin is the reference point.

    mass           : [kg]
    center_of_mass : (3,) [m]
    inertia        : (3, 3) [kg m^2] about the centre of mass
    """

    mass: float
    center_of_mass: np.ndarray
    inertia: np.ndarray

    def __post_init__(self) -> None:
        if not 0.0 < self.mass < np.inf:
            raise ValueError(f"PlatformData.mass must be positive and finite, got {self.mass!r}")
        center = fixed_array("PlatformData.center_of_mass", self.center_of_mass, (3,))
        inertia = fixed_array("PlatformData.inertia", self.inertia, (3, 3))
        size = float(np.abs(inertia).max())
        if np.abs(inertia - inertia.T).max() > 1e-9 * size or np.linalg.eigvalsh(inertia)[0] <= 0.0:
            raise ValueError(f"PlatformData.inertia must be symmetric and positive, got {inertia.tolist()!r}")
        object.__setattr__(self, "center_of_mass", center)
        object.__setattr__(self, "inertia", inertia)


def cross_matrix(vectors: np.ndarray) -> np.ndarray:
    """Matrices (..., 3, 3) that multiply as `vectors` (..., 3) do in a cross product from the left."""
    x, y, z = np.moveaxis(np.asarray(vectors, dtype=float), -1, 0)
    zero = np.zeros_like(x)
    rows = [np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))]
    return np.stack(rows, axis=-2)


def turned(rotation: np.ndarray, rotation_vector: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) after a further turn by the rotation vector (3,) [rad], world axes."""
    return np.asarray(Rotation.from_rotvec(rotation_vector).as_matrix() @ rotation)


def point_motion(arms: np.ndarray) -> np.ndarray:
    """Motion (..., 3, 6) of platform points per q, for lever arms (..., 3) [m], world axes."""
    arms = np.asarray(arms, dtype=float)
    identity = np.broadcast_to(np.eye(3), (*arms.shape, 3))
    return np.concatenate([identity, -cross_matrix(arms)], axis=-1)


def rotating_arm_stiffness(arms: np.ndarray, forces_on_platform: np.ndarray) -> np.ndarray:
    """Stiffness (6, 6) from constant forces on arms that turn with the platform.

    The moment rho x F changes by (rotation x rho) x F. Minus its derivative by the rotation, summed over the
    arms (k, 3) [m] and forces (k, 3) [N], both world, fills the rotational block [N m]. Symmetric as soon as
    the moments balance.
    """
    stiffness = np.zeros((6, 6))
    stiffness[3:, 3:] = -np.einsum("kab,kbc->ac", cross_matrix(forces_on_platform), cross_matrix(arms))
    return stiffness


def platform_mass_matrix(platform: PlatformData, rotation: np.ndarray) -> np.ndarray:
    """Mass matrix (6, 6) of the platform about its reference point, world axes; rotation (3, 3) to world."""
    motion = point_motion(rotation @ platform.center_of_mass)
    matrix = platform.mass * motion.T @ motion
    matrix[3:, 3:] += rotation @ platform.inertia @ rotation.T
    return matrix

"""The rigid platform: mass, centre of mass, inertia, and what a point load does to them."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.robot.arrays import frozen_array, require_positive


@dataclass(frozen=True, slots=True, eq=False)
class Platform:
    """Rigid platform, all in its own frame.

    mass           : m [kg]
    center_of_mass : (3,) c [m]
    inertia        : (3, 3) about the centre of mass [kg m^2]
    """

    mass: float
    center_of_mass: np.ndarray
    inertia: np.ndarray

    def __post_init__(self) -> None:
        require_positive(self, "mass")
        for name, shape in (("center_of_mass", (3,)), ("inertia", (3, 3))):
            object.__setattr__(self, name, frozen_array(getattr(self, name), shape, f"Platform.{name}"))
        _check_inertia(self.inertia)

    def with_point_load(self, load: float) -> "Platform":
        """Platform with a point mass `load` [kg] >= 0 fixed at the origin of its frame."""
        if not load >= 0.0:
            raise ValueError(f"payload must be >= 0 kg, got {load!r}")
        if load == 0.0:
            return self
        return self.with_masses_at(np.array([load]), np.zeros((1, 3)))

    def with_masses_at(self, masses: np.ndarray, points: np.ndarray) -> "Platform":
        """Platform with further point masses (k,) [kg] fixed at points (k, 3) [m] of its frame."""
        mass, center, inertia = joined_masses(np.asarray(self.mass), self.center_of_mass, self.inertia, masses, points)
        return Platform(float(mass), center, 0.5 * (inertia + inertia.T))

    def moved_mass(self, direction: np.ndarray) -> float:
        """Apparent mass [kg] of the free platform at its origin along a unit vector (3,) of its frame."""
        return float(moved_mass(np.asarray(self.mass), self.center_of_mass, self.inertia, direction))

    def with_mass(self, mass: float) -> "Platform":
        """Platform of another mass [kg], with the same centre of mass and inertia."""
        return replace(self, mass=mass)


def joined_masses(
    mass: np.ndarray, center: np.ndarray, inertia: np.ndarray, masses: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass (...), centre (..., 3) and inertia (..., 3, 3) about it of a body with point masses (..., k) at (..., k, 3).

    Parallel axes: each part adds m (a^2 - a a^T), a its place seen from the common centre.
    """
    total = mass + masses.sum(axis=-1)
    moment = mass[..., None] * center + (masses[..., None] * points).sum(axis=-2)
    common = moment / total[..., None]
    own, arms = center - common, points - common[..., None, :]
    added = mass[..., None, None] * _about(own) + (masses[..., None, None] * _about(arms)).sum(axis=-3)
    return total, common, inertia + added


def moved_mass(mass: np.ndarray, center: np.ndarray, inertia: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """(...) apparent mass [kg] at the origin along unit vectors (..., 3) of free bodies, as in `joined_masses`."""
    turning = np.cross(center, direction)
    turned = np.linalg.solve(inertia, turning[..., None])[..., 0]
    return np.asarray(1.0 / (1.0 / mass + (turning * turned).sum(axis=-1)))


def least_moved_mass(mass: np.ndarray, center: np.ndarray, inertia: np.ndarray, place: np.ndarray) -> np.ndarray:
    """(...) apparent mass [kg] of free bodies, as in `joined_masses`, at places (..., 3) along the direction in which
    it is least."""
    arm = np.cross(np.eye(3), (place - center)[..., None, :])  # row k: turned by the arm, unit force along axis k
    turned = arm @ np.linalg.solve(inertia, np.swapaxes(arm, -1, -2))
    return np.asarray(1.0 / (1.0 / mass + np.linalg.eigvalsh(turned)[..., -1]))


def _about(arm: np.ndarray) -> np.ndarray:
    """(..., 3, 3) inertia of one kilogram at `arm` (..., 3)."""
    square: np.ndarray = (arm**2).sum(axis=-1)[..., None, None] * np.eye(3)
    return square - arm[..., :, None] * arm[..., None, :]


def is_inertia(moments: np.ndarray) -> np.ndarray:
    """(...) whether principal moments (..., 3), ascending, are those of a body: none above the sum of the others."""
    enough = moments[..., 0] + moments[..., 1] >= moments[..., 2] * (1.0 - 1e-9)
    return np.asarray(enough & (moments[..., 0] > 0.0))


def _check_inertia(inertia: np.ndarray) -> None:
    if not np.allclose(inertia, inertia.T, rtol=1e-9, atol=0.0):
        raise ValueError(f"Platform.inertia must be symmetric, got {inertia.tolist()}")
    principal = np.linalg.eigvalsh(inertia)
    if not principal[0] > 0.0:
        raise ValueError(f"Platform.inertia must be positive definite, principal moments are {principal.tolist()}")
    if not is_inertia(principal):
        raise ValueError(
            "Platform.inertia breaks the triangle inequality of principal moments "
            f"(the two smaller must sum to at least the largest), they are {principal.tolist()}"
        )

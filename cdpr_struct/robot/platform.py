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
        mass = self.mass + load
        center = self.center_of_mass * self.mass / mass
        reduced = self.mass * load / mass
        c = self.center_of_mass
        return Platform(mass, center, self.inertia + reduced * (c @ c * np.eye(3) - np.outer(c, c)))

    def with_masses_at(self, masses: np.ndarray, points: np.ndarray) -> "Platform":
        """Platform with further point masses (k,) [kg] fixed at points (k, 3) [m] of its frame."""
        every, places = np.append(self.mass, masses), np.vstack([self.center_of_mass, points])
        center = every @ places / every.sum()
        inertia = np.array(self.inertia)
        for mass, arm in zip(every, places - center, strict=True):
            inertia = inertia + mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return Platform(float(every.sum()), center, 0.5 * (inertia + inertia.T))

    def with_mass(self, mass: float) -> "Platform":
        """Platform of another mass [kg], with the same centre of mass and inertia."""
        return replace(self, mass=mass)


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

"""A cable cut into bars, and what is known of it once it hangs still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference.bar_element import MassModel, bar_mass, bar_stiffness


@dataclass(frozen=True)
class CableData:
    """Uniform elastic cable.

    unstrained_length : L [m]
    axial_stiffness   : EA [N]
    linear_density    : mu [kg/m], per unstrained length
    """

    unstrained_length: float
    axial_stiffness: float
    linear_density: float

    def __post_init__(self) -> None:
        for name in ("unstrained_length", "axial_stiffness", "linear_density"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ValueError(f"CableData.{name} must be positive and finite, got {getattr(self, name)!r}")

    @property
    def mass(self) -> float:
        """Mass [kg] of the whole cable."""
        return self.linear_density * self.unstrained_length


@dataclass(frozen=True, eq=False)
class CableEquilibrium:
    """A cable of n bars at rest between two held ends.

    cable, gravity   : the data it was solved for; gravity (3,) [m/s^2]
    nodes            : (n + 1, 3) [m], world, from start to end
    tension_vectors  : (n, 3) [N], world, pull of each bar along its way from start to end
    start_force      : (3,) [N], applied to the cable at its start to hold it
    end_force        : (3,) [N], applied to the cable at its end to hold it
    residual_norm    : largest force [N] left over at an interior node, evaluated from `nodes` alone
    iterations       : Newton steps spent
    """

    cable: CableData
    gravity: np.ndarray
    nodes: np.ndarray
    tension_vectors: np.ndarray
    start_force: np.ndarray
    end_force: np.ndarray
    residual_norm: float
    iterations: int

    @property
    def elements(self) -> int:
        """Number n of bars."""
        return len(self.tension_vectors)

    @property
    def element_length(self) -> float:
        """Unstrained length [m] of one bar."""
        return self.cable.unstrained_length / self.elements

    @property
    def tensions(self) -> np.ndarray:
        """Tension (n,) [N] of every bar."""
        return np.linalg.norm(self.tension_vectors, axis=-1)

    @property
    def residual_floor(self) -> float:
        """Smallest `residual_norm` [N] that nodes stored in float64 can show: EA eps max|x| / L0."""
        reach = max(float(np.abs(self.nodes).max()), self.element_length)
        return self.cable.axial_stiffness * float(np.finfo(float).eps) * reach / self.element_length

    def element_stiffness(self) -> np.ndarray:
        """Tangent stiffness (n, 6, 6) [N/m] of every bar in this state."""
        tensions = self.tensions
        return bar_stiffness(
            self.tension_vectors / tensions[:, None],
            tensions,
            np.array(self.element_length),
            np.array(self.cable.axial_stiffness),
        )

    def element_mass(self, mass: MassModel = "lumped") -> np.ndarray:
        """Mass matrix (n, 6, 6) [kg] of every bar."""
        each = np.full(self.elements, self.cable.linear_density * self.element_length)
        return bar_mass(each, mass)

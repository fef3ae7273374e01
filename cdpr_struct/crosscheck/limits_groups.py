"""The dimensionless groups of one cable, and where they lie against the printed limits.

A cable at rest has chord l_c, inclination alpha, chord tension tau, stiffness EA, density mu and gravity g: six
quantities, three units, so three groups, and a frequency makes four. Written in the axes of the chord, gravity has a
part across it and a part along it, and nothing else in the problem knows which way is up. The groups are therefore

    epsilon = mu g l_c cos(alpha) / tau      weight across the chord (the sag)
    along   = mu g l_c sin(alpha) / tau      weight along the chord, epsilon tan(alpha) (the tension's variation)
    strain  = tau / EA                       the static strain
    Omega   = omega l_c sqrt(mu / tau)       frequency

Everything else follows: lambda^2 = epsilon^2 l_c / (strain L_e), sag / chord = epsilon / 8, the ratio of the transverse
to the axial wave speed sqrt(strain), and the phase of the axial wave along the cable, Omega sqrt(strain). Which end
moves, the upper or the lower, is a sign of `along`. A mass m at the end adds m / (mu l_c). Viscous damping replaces
omega^2 by a complex number in the cable's equations and in the closed form alike, so it adds no group to the error.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cdpr_struct.crosscheck.validity_limits import (
    CROSSOVER_DISTANCE,
    INCLINATION_EPSILON_PAIRS,
    LAMBDA_SQUARED_LIMIT,
    SAG_RATIO_LIMIT,
    crossover_distance,
)
from cdpr_struct.generated import cable_dsm


@dataclass(frozen=True, slots=True, eq=False)
class CableGroups:
    """The three static groups of n cables, arrays (n,) [-]; `along` >= 0."""

    epsilon: np.ndarray
    along: np.ndarray
    strain: np.ndarray

    @classmethod
    def of(cls, inclination_deg: npt.ArrayLike, epsilon: npt.ArrayLike, lambda_squared: npt.ArrayLike) -> "CableGroups":
        """Groups from the parameters of the print, broadcast and flattened; inclination in [0, 90) deg."""
        angle, sag, lambda2 = np.broadcast_arrays(
            *(np.asarray(a, dtype=float) for a in (inclination_deg, epsilon, lambda_squared))
        )
        strain = sag**2 / (lambda2 * cable_dsm.effective_length_integral(1.0, sag))
        along = sag * np.tan(np.radians(angle))
        return cls(sag.ravel(), along.ravel(), strain.ravel())

    def take(self, index: npt.NDArray[np.intp]) -> "CableGroups":
        """The cables at `index`."""
        return CableGroups(self.epsilon[index], self.along[index], self.strain[index])

    def __len__(self) -> int:
        return len(self.epsilon)

    @property
    def inclination_deg(self) -> np.ndarray:
        """(n,) |alpha| [deg]."""
        return np.degrees(np.arctan2(self.along, self.epsilon))

    @property
    def weight(self) -> np.ndarray:
        """(n,) mu g l_c / tau [-]."""
        return np.hypot(self.epsilon, self.along)

    @property
    def effective_length(self) -> np.ndarray:
        """(n,) L_e / l_c [-]."""
        return np.asarray(cable_dsm.effective_length_integral(1.0, self.epsilon))

    @property
    def lambda_squared(self) -> np.ndarray:
        """(n,) Irvine's parameter [-]."""
        return np.asarray(cable_dsm.lambda_squared(1.0, 1.0, 1.0 / self.strain, self.effective_length, self.epsilon))

    @property
    def sag_ratio(self) -> np.ndarray:
        """(n,) d / l_c to first order, epsilon / 8 [-]."""
        return self.epsilon / 8.0


def broken_limits(groups: CableGroups) -> dict[str, np.ndarray]:
    """Which printed limits each cable breaks: name -> (n,) bool, eqs (2.40)-(2.41) and section 2.2.1."""
    angle = groups.inclination_deg
    allowed = np.zeros(len(groups))
    for largest_angle, largest in reversed(INCLINATION_EPSILON_PAIRS):
        allowed = np.where(angle <= largest_angle * (1.0 + 1e-12), largest, allowed)
    steep = angle > INCLINATION_EPSILON_PAIRS[-1][0] * (1.0 + 1e-12)
    return {
        "lambda2": groups.lambda_squared > LAMBDA_SQUARED_LIMIT * (1.0 + 1e-12),
        "crossover_distance": crossover_distance(groups.lambda_squared) < CROSSOVER_DISTANCE,
        "alpha_deg": steep,
        "epsilon": ~steep & (groups.epsilon > allowed * (1.0 + 1e-12)),
        "sag_ratio": groups.sag_ratio > SAG_RATIO_LIMIT,
    }


def inside_printed_limits(groups: CableGroups) -> np.ndarray:
    """(n,) bool: no printed limit is broken."""
    return ~np.any(list(broken_limits(groups).values()), axis=0)

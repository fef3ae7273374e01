"""The crossovers lambda^2 = 4 n^2 pi^2: two frequencies cross in the closed form and veer in an inclined cable."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.limits_closed_form import clamped_frequencies
from cdpr_struct.crosscheck.limits_domain import MAX_STRAIN
from cdpr_struct.crosscheck.limits_errors import IN_PLANE_MODES, measure
from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.crosscheck.limits_reference import reference_planes

CASES = ((0.0, 0.1), (60.0, 0.1))  # inclination [deg] and epsilon: horizontal, and the steepest that the print admits


@dataclass(frozen=True, slots=True, eq=False)
class Veering:
    """In-plane frequencies of one family of cables over lambda^2.

    lambda_squared     : (n,);  closed_form, catenary : (n, 6) Omega;  mode_shape_error : (n,) 1 - MAC, worst of six
    gap                : smallest relative distance of the two frequencies that meet at the first crossover
    gap_at             : lambda^2 where it is
    """

    inclination_deg: float
    epsilon: float
    lambda_squared: np.ndarray
    closed_form: np.ndarray
    catenary: np.ndarray
    mode_shape_error: np.ndarray
    gap: float
    gap_at: float


def veering(inclination_deg: float, epsilon: float, count: int) -> Veering:
    """Frequencies from the least lambda^2 that the strain allows to beyond the second crossover."""
    first = max(0.3, float(np.sqrt(epsilon**2 / MAX_STRAIN)) / np.pi)
    ratio = np.union1d(np.linspace(first, 4.6, count), 2.0 + np.linspace(-0.12, 0.12, 2 * (count // 6) + 1))
    groups = CableGroups.of(inclination_deg, epsilon, (np.pi * ratio) ** 2)
    catenary = reference_planes(groups, np.array([0.5])).in_plane.frequencies[:, :IN_PLANE_MODES]
    near = np.abs(ratio - 2.0) < 0.3
    gaps = catenary[near, 1] / catenary[near, 0] - 1.0
    return Veering(
        inclination_deg=inclination_deg,
        epsilon=epsilon,
        lambda_squared=groups.lambda_squared,
        closed_form=clamped_frequencies(groups, IN_PLANE_MODES),
        catenary=catenary,
        mode_shape_error=measure(groups)["mode_shape"].error.max(axis=1),
        gap=float(gaps.min()),
        gap_at=float(groups.lambda_squared[near][gaps.argmin()]),
    )

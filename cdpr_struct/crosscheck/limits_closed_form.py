"""The thesis's closed-form DSM in the units of chord, chord tension and density."""

import numpy as np

from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.crosscheck.limits_reference import CablePlanes, Plane
from cdpr_struct.dynamics.clamped_cable import symmetric_roots
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.taut_cable_expansion import expand_taut_cables
from cdpr_struct.dynamics.taut_cables import TautCables
from cdpr_struct.generated import cable_dsm

_PAIRS = 12  # antisymmetric and symmetric modes each


def closed_form_planes(groups: CableGroups, stations: np.ndarray) -> CablePlanes:
    """Clamped modes and end shapes of the closed form; both ends are alike to it."""
    one = np.ones(len(groups))
    cables = TautCables(
        chord=one,
        tension=one,
        axial_stiffness=1.0 / groups.strain,
        effective_length=groups.effective_length,
        linear_density=one,
        perpendicular_weight=groups.epsilon,
        damping_ratio=np.zeros(len(groups)),
        epsilon=groups.epsilon,
        lambda_squared=groups.lambda_squared,
        frame=np.broadcast_to(np.eye(3), (len(groups), 3, 3)),
    )
    full = expand_taut_cables(cables, _PAIRS)
    _, modes = full.shapes(stations)
    return CablePlanes(
        in_plane=_plane(full, modes, np.arange(2 * _PAIRS, 4 * _PAIRS), np.array([0, 2])),
        across=_plane(full, modes, np.arange(2 * _PAIRS), np.array([1])),
    )


def _plane(full: ModalExpansion, modes: np.ndarray, numbers: np.ndarray, axes: np.ndarray) -> Plane:
    """The given modes and axes of a modal expansion, slow modes first, for one moving end."""
    omega_squared = full.omega_squared[:, numbers]
    rank = np.argsort(omega_squared, axis=1)
    coupling = full.coupling[:, numbers][..., axes]
    block = np.ix_(np.arange(len(omega_squared)), axes, axes)
    return Plane(
        omega_squared=np.take_along_axis(omega_squared, rank, axis=1),
        modes=np.take_along_axis(modes[:, numbers][..., axes], rank[..., None, None], axis=1),
        static=full.static_stiffness[block][:, None],
        coupling=np.take_along_axis(coupling, rank[..., None], axis=1)[:, None],
        end_mass=full.end_mass[block][:, None],
    )


def closed_form_stiffness(groups: CableGroups, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness of the moving end at Omega (n, f): in plane (n, f, 2, 2) and across (n, f), eqs (2.31)-(2.35)."""
    k_xx, k_xz, k_yy, k_zz = cable_dsm.dynamic_stiffness(
        frequency**2, 1.0, 1.0, (1.0 / groups.strain)[:, None], groups.effective_length[:, None], 1.0,
        groups.epsilon[:, None],
    )  # fmt: skip
    return np.stack([k_xx, k_xz, k_xz, k_zz], axis=-1).reshape((*k_xx.shape, 2, 2)), k_yy


def clamped_frequencies(groups: CableGroups, count: int) -> np.ndarray:
    """(n, count) lowest in-plane Omega."""
    antisymmetric = np.broadcast_to(2.0 * np.pi * np.arange(1, count + 1), (len(groups), count))
    roots = symmetric_roots(groups.lambda_squared, count)
    return np.sort(np.concatenate([antisymmetric, roots], axis=1), axis=1)[:, :count]

"""Modal expansion of the taut, slightly sagging cable: the same linear model as the closed-form DSM."""

import numpy as np

from cdpr_struct.dynamics.clamped_cable import symmetric_roots
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.polynomial_basis import gauss_rule
from cdpr_struct.dynamics.taut_cables import TautCables


def expand_taut_cables(cables: TautCables, pairs: int) -> ModalExpansion:
    """Expansion with `pairs` antisymmetric and as many symmetric in-plane modes, and 2 `pairs` out of plane.

    Modes come plane by plane: out of plane, in plane antisymmetric, symmetric. Local axes are those of the chord.
    Motion along the chord carries no mass in this model; its shape is linear.
    """
    symmetric = symmetric_roots(cables.lambda_squared, pairs)
    nodes, weights = gauss_rule(24 + 8 * pairs)
    xi, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    mass = cables.linear_density * cables.chord
    raw = _clamped_shapes(symmetric, xi)
    scale = 1.0 / np.sqrt(mass[:, None] * np.einsum("mpsc,s->mp", raw**2, weights))
    static = _static_shapes(cables, xi)
    coupling = (mass[:, None] * scale)[..., None] * np.einsum("mpsc,mscb,s->mpb", raw, static, weights, optimize=True)
    end_mass = mass[:, None, None] * np.einsum("msca,mscb,s->mab", static, static, weights, optimize=True)

    def shapes(stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
        if derivative:
            raise ValueError(f"derivative of the closed form's shapes must be 0, got {derivative}")
        static = _static_shapes(cables, stations)
        static[:, :, 0, 0] = stations
        return static, scale[..., None, None] * _clamped_shapes(symmetric, stations)

    omega_squared = _omega_squared(cables, symmetric)
    across = np.diag([0.0, 1.0, 1.0])
    rigid_end = mass[:, None, None] * np.einsum("msca,s->mac", static, weights) @ across
    rigid_modes = (mass[:, None] * scale)[..., None] * np.einsum("mpsc,s->mpc", raw, weights)
    rigid = mass[:, None, None] * across, rigid_end, rigid_modes
    return ModalExpansion(cables.frame, _static_stiffness(cables), end_mass, omega_squared, coupling, *rigid, shapes)


def _static_shapes(cables: TautCables, xi: np.ndarray) -> np.ndarray:
    """(m, s, 3, 3): across the chord linear, and a parabola where the end moves along the chord."""
    stretch = cables.axial_stiffness / cables.effective_length / (1.0 + cables.lambda_squared / 12.0)
    bow = stretch * cables.epsilon * cables.chord / (2.0 * cables.tension)
    static = np.zeros((len(bow), len(xi), 3, 3))
    static[..., 1, 1] = static[..., 2, 2] = xi
    static[..., 2, 0] = bow[:, None] * xi * (1.0 - xi)
    return static


def _static_stiffness(cables: TautCables) -> np.ndarray:
    stiffness = np.zeros((len(cables.chord), 3, 3))
    stiffness[:, 0, 0] = cables.axial_stiffness / cables.effective_length / (1.0 + cables.lambda_squared / 12.0)
    stiffness[:, 1, 1] = stiffness[:, 2, 2] = cables.tension / cables.chord
    return stiffness


def _omega_squared(cables: TautCables, symmetric: np.ndarray) -> np.ndarray:
    pairs = symmetric.shape[-1]
    out_of_plane = np.broadcast_to(np.pi * np.arange(1, 2 * pairs + 1), (len(symmetric), 2 * pairs))
    antisymmetric = np.broadcast_to(2.0 * np.pi * np.arange(1, pairs + 1), symmetric.shape)
    parameter = np.concatenate([out_of_plane, antisymmetric, symmetric], axis=-1)
    return (parameter * cables.frequency_scale[:, None]) ** 2


def _clamped_shapes(symmetric: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """(m, 4 pairs, s, 3) in the order of `_omega_squared`, not normalised."""
    m, pairs = symmetric.shape
    shapes = np.zeros((m, 4 * pairs, len(xi), 3))
    shapes[:, : 2 * pairs, :, 1] = np.sin(np.pi * np.arange(1, 2 * pairs + 1)[:, None] * xi)
    shapes[:, 2 * pairs : 3 * pairs, :, 2] = np.sin(2.0 * np.pi * np.arange(1, pairs + 1)[:, None] * xi)
    middle = np.cos(0.5 * symmetric[..., None])
    shapes[:, 3 * pairs :, :, 2] = np.cos(symmetric[..., None] * (xi - 0.5)) - middle
    return shapes

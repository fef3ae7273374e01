"""Modal expansion of the taut, slightly sagging cable: the same linear model as the closed-form DSM."""

from typing import NamedTuple

import numpy as np

from cdpr_struct.dynamics.clamped_cable import symmetric_roots
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.taut_cables import TautCables


def expand_taut_cables(cables: TautCables, pairs: int) -> ModalExpansion:
    """Expansion with `pairs` antisymmetric and as many symmetric in-plane modes, and 2 `pairs` out of plane.

    Modes come plane by plane: out of plane, in plane antisymmetric, symmetric. Local axes are those of the chord.
    Motion along the chord carries no mass in this model; its shape is linear.
    """
    symmetric = symmetric_roots(cables.lambda_squared, pairs)
    mass, bow = cables.linear_density * cables.chord, _bow(cables)
    whole = _integrals(symmetric)
    scale = 1.0 / np.sqrt(mass[:, None] * whole.square)
    weight = (mass[:, None] * scale)[..., None]
    sideways = np.zeros((4 * pairs, 3))
    sideways[: 2 * pairs, 1] = sideways[2 * pairs :, 2] = 1.0
    coupling = weight * whole.with_ramp[..., None] * sideways
    coupling[..., 0] = weight[..., 0] * bow[:, None] * whole.with_parabola * sideways[:, 2]
    end_mass, mean = np.zeros((2, len(mass), 3, 3))
    end_mass[:, 1, 1] = end_mass[:, 2, 2] = mass / 3.0
    end_mass[:, 0, 0], mean[:, 0, 2] = mass * bow**2 / 30.0, bow / 6.0
    end_mass[:, 0, 2] = end_mass[:, 2, 0] = mass * bow / 12.0
    mean[:, 1, 1] = mean[:, 2, 2] = 0.5

    def shapes(stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
        if derivative:
            raise ValueError(f"derivative of the closed form's shapes must be 0, got {derivative}")
        static = _static_shapes(cables, stations)
        static[:, :, 0, 0] = stations
        return static, scale[..., None, None] * _clamped_shapes(symmetric, stations)

    omega_squared = _omega_squared(cables, symmetric)
    rigid_end = mass[:, None, None] * mean
    rigid_modes = weight * whole.alone[..., None] * sideways
    rigid = mass[:, None, None] * np.diag([0.0, 1.0, 1.0]), rigid_end, rigid_modes
    return ModalExpansion(cables.frame, _static_stiffness(cables), end_mass, omega_squared, coupling, *rigid, shapes)


class _Integrals(NamedTuple):
    """Of the modes' shapes (m, 4 pairs) over xi in 0..1: alone, times xi, times xi (1 - xi), and squared."""

    alone: np.ndarray
    with_ramp: np.ndarray
    with_parabola: np.ndarray
    square: np.ndarray


def _integrals(symmetric: np.ndarray) -> _Integrals:
    """Of `_clamped_shapes`: sin(n pi xi) changes its sign about the middle if n is even, cos(s (xi - 1/2)) never."""
    m, pairs = symmetric.shape
    n = np.concatenate([np.arange(1.0, 2 * pairs + 1), np.arange(2.0, 2 * pairs + 1, 2.0)])
    odd = n % 2.0
    sine, cosine = np.sin(0.5 * symmetric), np.cos(0.5 * symmetric)
    area = 2.0 * sine / symmetric - cosine
    spread = 0.5 * sine / symmetric + 2.0 * cosine / symmetric**2 - 4.0 * sine / symmetric**3 - cosine / 12.0
    own = area, 0.5 * area, 0.25 * area - spread, 0.5 - 3.0 * sine * cosine / symmetric + cosine**2
    sines = 2.0 * odd / (n * np.pi), (2.0 * odd - 1.0) / (n * np.pi), 4.0 * odd / (n * np.pi) ** 3, 0.5 + 0.0 * n
    parts = (np.concatenate([np.tile(a, (m, 1)), b], axis=1) for a, b in zip(sines, own, strict=True))
    return _Integrals(*parts)


def _bow(cables: TautCables) -> np.ndarray:
    """(m,) by which xi (1 - xi) moves the cable where its end moves along the chord."""
    stretch = cables.axial_stiffness / cables.effective_length / (1.0 + cables.lambda_squared / 12.0)
    return np.asarray(stretch * cables.epsilon * cables.chord / (2.0 * cables.tension))


def _static_shapes(cables: TautCables, xi: np.ndarray) -> np.ndarray:
    """(m, s, 3, 3): across the chord linear, and a parabola where the end moves along the chord."""
    bow = _bow(cables)
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

"""A taut sagging cable as static shapes of its moving end plus modes of the clamped cable.

The same linear cable as the closed-form DSM, in coordinates in which the robot's eigenproblem is an ordinary matrix
one: nothing becomes infinite at a clamped frequency, so mode shapes are found there too.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.clamped_cable import symmetric_roots
from cdpr_struct.dynamics.operating_point import TautCables


@dataclass(frozen=True, slots=True, eq=False)
class CableModalExpansion:
    """m cables, p clamped modes each (half out of plane, half in plane), cable axes (x chord, y, z up).

    omega_squared : (m, p) [rad^2/s^2]
    end_mass      : (m, 3, 3) mass of the static shapes [kg]
    coupling      : (m, p, 3) mass coupling of unit-modal-mass modes with the end [kg^(1/2)]
    cables        : what it expands
    """

    cables: TautCables
    omega_squared: np.ndarray
    end_mass: np.ndarray
    coupling: np.ndarray
    _symmetric: np.ndarray
    _scale: np.ndarray

    def motion(self, xi: np.ndarray, end: np.ndarray, modal: np.ndarray) -> np.ndarray:
        """Transverse motion at the fractions xi (s,) of the chord.

        Parameters
        ----------
        end : (k, m, 3) displacement of the moving end, cable axes
        modal : (k, m, p) modal coordinates

        Returns
        -------
        (k, m, s, 3), cable axes; motion along the chord is that of the end times xi.
        """
        y_modes, z_modes = _clamped_shapes(self._symmetric, xi)
        half = y_modes.shape[1]
        y = np.einsum("kmp,mp,mps->kms", modal[..., :half], self._scale[:, :half], y_modes)
        z = np.einsum("kmp,mp,mps->kms", modal[..., half:], self._scale[:, half:], z_modes)
        y += end[..., 1, None] * xi
        z += end[..., 2, None] * xi + end[..., 0, None] * (_bow(self.cables)[:, None] * xi * (1.0 - xi))
        return np.stack([end[..., 0, None] * xi, y, z], axis=-1)


def expand(cables: TautCables, pairs: int) -> CableModalExpansion:
    """Expansion with `pairs` antisymmetric and as many symmetric in-plane modes, and 2 `pairs` out of plane."""
    symmetric = symmetric_roots(cables.lambda_squared, pairs)
    nodes, weights = np.polynomial.legendre.leggauss(24 + 8 * pairs)
    xi, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    y_modes, z_modes = _clamped_shapes(symmetric, xi)
    shapes = np.concatenate([y_modes, z_modes], axis=1)
    mass = (cables.linear_density * cables.chord)[:, None]
    scale = 1.0 / np.sqrt(mass * (shapes**2 @ weights))
    bow = _bow(cables)
    ends = np.zeros((*shapes.shape[:2], 3))
    half = y_modes.shape[1]
    ends[:, :half, 1] = y_modes @ (weights * xi)
    ends[:, half:, 2] = z_modes @ (weights * xi)
    ends[:, half:, 0] = bow[:, None] * (z_modes @ (weights * xi * (1.0 - xi)))
    return CableModalExpansion(
        cables, _omega_squared(cables, symmetric), _end_mass(cables, bow), (mass * scale)[..., None] * ends, symmetric, scale
    )


def _bow(cables: TautCables) -> np.ndarray:
    """Rise of the static shape, v = bow xi (1 - xi), per unit end displacement along the chord (m,) [-]."""
    stretch = cables.axial_stiffness / cables.effective_length / (1.0 + cables.lambda_squared / 12.0)
    return stretch * cables.epsilon * cables.chord / (2.0 * cables.tension)


def _end_mass(cables: TautCables, bow: np.ndarray) -> np.ndarray:
    mass = np.zeros((*bow.shape, 3, 3))
    mass[..., 0, 0] = bow**2 / 30.0
    mass[..., 0, 2] = mass[..., 2, 0] = bow / 12.0
    mass[..., 1, 1] = mass[..., 2, 2] = 1.0 / 3.0
    return mass * (cables.linear_density * cables.chord)[..., None, None]


def _omega_squared(cables: TautCables, symmetric: np.ndarray) -> np.ndarray:
    pairs = symmetric.shape[-1]
    out_of_plane = np.broadcast_to(np.pi * np.arange(1, 2 * pairs + 1), (len(symmetric), 2 * pairs))
    antisymmetric = np.broadcast_to(2.0 * np.pi * np.arange(1, pairs + 1), symmetric.shape)
    parameter = np.concatenate([out_of_plane, antisymmetric, symmetric], axis=-1)
    return (parameter * cables.frequency_scale[:, None]) ** 2


def _clamped_shapes(symmetric: np.ndarray, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    pairs = symmetric.shape[-1]
    y = np.sin(np.pi * np.arange(1, 2 * pairs + 1)[:, None] * xi)
    anti = np.sin(2.0 * np.pi * np.arange(1, pairs + 1)[:, None] * xi)
    even = np.cos(symmetric[..., None] * (xi - 0.5)) - np.cos(0.5 * symmetric[..., None])
    even /= 1.0 + np.abs(np.cos(0.5 * symmetric[..., None]))
    cables = len(symmetric)
    z = np.concatenate([np.broadcast_to(anti, (cables, *anti.shape)), even], axis=1)
    return np.broadcast_to(y, (cables, *y.shape)), z

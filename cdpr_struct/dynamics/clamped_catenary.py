"""At which frequencies do hanging cables vibrate whose ends are both held?

The modes of `catenary_expansion` without what a moving end needs: (D u')' + mu omega^2 u = 0 by Galerkin's method in
polynomials that vanish at both ends. Motion in the plane of the cable and across it do not couple.
"""

import numpy as np

from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate
from cdpr_struct.dynamics.catenary_line import stiffness_density
from cdpr_struct.dynamics.polynomial_basis import on_gauss_nodes
from cdpr_struct.statics.cable_state import CableStates

_IN_PLANE, _ACROSS = (0, 2), (1,)
_ORDER, _PER_MODE, _SAG, _HIGHEST = 40, 4, 8, 400  # of polynomials: of a taut cable, more a mode and a unit of w L / T


def enough_polynomials(cables: CableStates, count: int) -> int:
    """Order that suits `count` frequencies of each plane of every one of m cables, whatever their sag."""
    slack = float((cables.weight * cables.length / cables.tension).max())
    return min(_HIGHEST, _ORDER + _PER_MODE * count + int(_SAG * slack))


def clamped_frequencies(cables: CableStates, linear_density: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies [rad/s] of m cables between held ends, ascending.

    Parameters
    ----------
    cables : states (m,)
    linear_density : (m,) mu [kg/m]
    order : of the polynomials; ten frequencies of a taut cable have six digits at 24 and twelve at 30

    Returns
    -------
    (m, 2 (order - 1)) in the vertical plane of the cable, axial ones among them, and (m, order - 1) across it.
    """
    nodes, weights, values, slopes = on_gauss_nodes(order)
    bubbles, rises = values[:-2], slopes[:-2]
    arc, rate = CatenaryCoordinate.of(cables).arc(nodes)
    mass = (bubbles * (linear_density[:, None] * rate * weights)[:, None]) @ bubbles.T
    density = stiffness_density(cables, arc) * (weights / rate)[..., None, None]
    planes = []
    for axes in (_IN_PLANE, _ACROSS):
        blocks = [[(rises * density[:, None, :, a, b]) @ rises.T for b in axes] for a in axes]
        planes.append(_frequencies(np.block(blocks), mass, len(axes)))
    return planes[0], planes[1]


def _frequencies(stiffness: np.ndarray, mass: np.ndarray, axes: int) -> np.ndarray:
    """Frequencies (m, axes n) of stiffness (m, axes n, axes n) and the mass (m, n, n) of each axis.

    The eigenproblem of 1 / omega^2: rounding then falls on the fast axial modes, not on the slow ones.
    """
    m, n, _ = mass.shape
    inverse = np.linalg.inv(np.linalg.cholesky(stiffness))
    moved = inverse.reshape(m, axes * n * axes, n) @ mass
    periods = np.linalg.eigvalsh(moved.reshape(m, axes * n, axes * n) @ np.swapaxes(inverse, 1, 2))[:, ::-1]
    return np.asarray(1.0 / np.sqrt(np.maximum(periods, np.finfo(float).eps * periods[:, :1])))

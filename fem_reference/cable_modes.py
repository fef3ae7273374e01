"""Eigenfrequencies, shapes and end stiffness of one cable about its equilibrium."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array, eye_array, kron

from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.cable import CableEquilibrium
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.pulley import Wrap
from cdpr_struct.fem_reference.sparse_chain import chain_matrix
from cdpr_struct.fem_reference.substructure import condensed_and_counted, dynamic_ends


@dataclass(frozen=True, eq=False)
class CableModes:
    """Modes of a cable clamped at both ends, ascending.

    frequencies_hz : (k,) [Hz]
    shapes         : (k, n - 1, 3) displacement of the interior nodes, world; modal mass 1 kg
    in_plane_share : (k,) part of the motion energy in the vertical plane of the cable
    """

    frequencies_hz: np.ndarray
    shapes: np.ndarray
    in_plane_share: np.ndarray


def cable_frame(equilibrium: CableEquilibrium) -> np.ndarray:
    """Rows (3, 3): two directions that span the plane the cable hangs in, then the normal of that plane.

    The plane holds the chord and the load on the nodes. A vertical or weightless cable has no such plane: any plane
    through its chord serves, since its motion is the same in all of them.
    """
    chord = equilibrium.nodes[-1] - equilibrium.nodes[0]
    along = chord / max(float(np.linalg.norm(chord)), 1e-300)
    pull = equilibrium.node_load / max(float(np.linalg.norm(equilibrium.node_load)), 1e-300)
    normal = np.cross(along, pull)
    if np.linalg.norm(normal) < 1e-9:
        axis = along if np.linalg.norm(along) > 0.5 else pull
        normal = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    normal = normal / np.linalg.norm(normal)
    across = along if np.linalg.norm(along) > 0.5 else pull
    across = across - normal * (across @ normal)
    across = across / np.linalg.norm(across)
    return np.array([across, np.cross(normal, across), normal])


def clamped_matrices(equilibrium: CableEquilibrium, mass: MassModel = "lumped") -> tuple[csc_array, csc_array]:
    """Stiffness [N/m] and mass [kg] of the cable with both ends held, sparse, each 3 (n - 1) square."""
    stiffness = chain_matrix(equilibrium.element_stiffness()[None])[:-3, :-3]
    return csc_array(stiffness), csc_array(chain_matrix(equilibrium.element_mass(mass)[None])[:-3, :-3])


def cable_modes(equilibrium: CableEquilibrium, count: int, mass: MassModel = "lumped") -> CableModes:
    """Lowest `count` modes of the clamped cable.

    A cable under its weight hangs in a plane, so motion in and out of that plane does not couple; the two
    are solved apart, which keeps nearly equal frequencies of the two kinds from mixing. A pulley with an
    axis out of that plane couples them; a cable with a pulley is solved in one go.

    Raises
    ------
    ValueError : count above 3 (n - 1), or an unknown mass model.
    """
    interior = equilibrium.elements - 1
    if not 1 <= count <= 3 * interior:
        raise ValueError(f"count must be between 1 and {3 * interior}, got {count!r}")
    frame, matrices = cable_frame(equilibrium), clamped_matrices(equilibrium, mass)
    values, shapes, shares = [], [], []
    for axes in (frame[:2], frame[2:]) if not isinstance(equilibrium.wrap, Wrap) else (frame,):
        basis = csc_array(kron(eye_array(interior), axes.T))
        stiffness, inertia = (csc_array(basis.T @ matrix @ basis) for matrix in matrices)
        found, vectors = lowest_eigenpairs(
            stiffness, inertia, min(count, len(axes) * interior), -1e-3 * string_eigenvalue(equilibrium)
        )
        values.append(found)
        shapes.append((basis @ vectors).T.reshape(len(found), interior, 3))
        shares.append(_in_plane_shares(vectors, len(axes)))
    order = np.argsort(np.concatenate(values), kind="stable")[:count]
    return CableModes(
        frequencies_hz(np.concatenate(values)[order]),
        np.concatenate(shapes)[order],
        np.concatenate(shares)[order],
    )


def _in_plane_shares(vectors: np.ndarray, axes: int) -> np.ndarray:
    """Part (k,) of the motion energy along the first two axes, for vectors (nodes x axes, k)."""
    squares = (vectors**2).reshape(-1, axes, vectors.shape[1]).sum(axis=0)
    if axes < 3:
        return np.full(vectors.shape[1], float(axes == 2))
    return np.asarray(squares[:2].sum(axis=0) / squares.sum(axis=0))


def first_omega(equilibrium: CableEquilibrium, mass: MassModel = "lumped") -> float:
    """Lowest eigenfrequency [rad/s] of the cable with its far end held, of any direction of motion."""
    shift = -1e-3 * string_eigenvalue(equilibrium)
    values, _ = lowest_eigenpairs(*clamped_matrices(equilibrium, mass), 1, shift)
    return float(np.sqrt(values[0]))


def string_eigenvalue(equilibrium: CableEquilibrium) -> float:
    """Order of magnitude [rad^2/s^2] of the lowest eigenvalue: that of a string with the smallest tension."""
    cable = equilibrium.cable
    return float(equilibrium.tensions.min()) / (cable.linear_density * cable.unstrained_length**2)


def cable_count_below(equilibrium: CableEquilibrium, omega: float, mass: MassModel = "lumped") -> int:
    """Number of eigenfrequencies of the clamped cable below omega [rad/s], from matrix inertia alone."""
    matrices = equilibrium.element_stiffness() - omega**2 * equilibrium.element_mass(mass)
    return int(condensed_and_counted(matrices)[1])


def end_dynamic_stiffness(
    equilibrium: CableEquilibrium,
    omegas: ArrayLike,
    mass: MassModel = "lumped",
    damping_ratio: float = 0.0,
    reference_omega: float | None = None,
) -> np.ndarray:
    """Force at the end node per displacement of the end node, start held, in steady vibration.

    Parameters
    ----------
    equilibrium : the cable about which small vibration is taken.
    omegas : (...) [rad/s], real or complex.
    mass : "lumped" (half of the last element sits on the end node) or "consistent".
    damping_ratio, reference_omega : xi [-] and omega_1 [rad/s] of a viscous, mass-proportional damping:
        omega^2 - 2i xi omega_1 omega takes the place of omega^2.

    Returns
    -------
    (..., 3, 3) [N/m], world axes, symmetric; complex if the damping or an omega is.

    Raises
    ------
    ValueError : damping without a reference_omega.
    """
    omega = np.asarray(omegas)
    squares = omega * omega * 1.0
    if damping_ratio != 0.0:
        if reference_omega is None:
            raise ValueError(f"damping_ratio {damping_ratio!r} needs reference_omega [rad/s], got None")
        squares = squares - 2.0j * damping_ratio * reference_omega * omega
    ends = dynamic_ends(equilibrium.element_stiffness(), equilibrium.element_mass(mass), squares.reshape(-1))
    return ends.reshape(*omega.shape, 3, 3)

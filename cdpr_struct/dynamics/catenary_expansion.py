"""Modal expansion of the elastic catenary itself: any sag, any inclination, axial waves included.

The linearised equations about the true profile r(s), in the unstrained coordinate s,

    (D u')' + mu omega^2 u = 0,   D = EA t t^T + T / (1 + T / EA) (1 - t t^T),

solved by Galerkin's method with integrated Legendre polynomials over the whole cable. Tension T(s) and tangent t(s)
are analytic, so the error falls exponentially with the polynomial order; `catenary_coordinate` keeps that so where a
slack cable bends sharply.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate
from cdpr_struct.dynamics.catenary_line import across, along, stiffness_density
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.piecewise_basis import PiecewiseBasis, PiecewiseCoordinate
from cdpr_struct.dynamics.polynomial_basis import curvatures, on_gauss_nodes
from cdpr_struct.dynamics.stiff_cable import shortening, slenderness
from cdpr_struct.statics.cable_state import CableStates, cable_frame


@dataclass(frozen=True, slots=True, eq=False)
class FrameEnds:
    """How far the frame ends of m cables can give way: q directions each, held by springs; not at all in others.

    directions : (m, 3, q) orthonormal columns, world
    stiffness  : (m, q) [N/m]
    """

    directions: np.ndarray
    stiffness: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class CableExtras:
    """What cables are beside strings.

    bending_stiffness, bending_fixity : (m,) EI [N m^2] of taut cables, and how far their ends are clamped (0 to 1)
    added_mass, added_mass_place      : (m,) [kg] at a share of the unstrained length from the platform end
    lump_mass                         : (m, k) of the point masses that hang where `CableStates.lump_place` says [kg]
    """

    bending_stiffness: np.ndarray
    bending_fixity: np.ndarray
    added_mass: np.ndarray
    added_mass_place: np.ndarray
    lump_mass: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class LeftOut:
    """What m cables are to lack, so that one sees what it is worth; the shape at rest is the caller's.

    axial_stiffness : (m,) EA [N] of the vibrating cables, which are not stretched at rest; None where they are
    axial_inertia   : whether motion along the cable has no inertia
    """

    axial_stiffness: np.ndarray | None = None
    axial_inertia: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class _Plane:
    """Motion components that are coupled with each other: i functions, c components, p modes.

    omega_squared (m, p); modes (m, i, c, p); static (m, i, c, c); end_stiffness, end_mass (m, c, c);
    coupling (m, p, c); rigid_mass, rigid_end (m, c, c) and rigid_modes (m, p, c) of the cable moved as a whole.
    The functions are those of `polynomial_basis` without the moving end's.
    """

    components: tuple[int, ...]
    omega_squared: np.ndarray
    modes: np.ndarray
    static: np.ndarray
    end_stiffness: np.ndarray
    end_mass: np.ndarray
    coupling: np.ndarray
    rigid_mass: np.ndarray
    rigid_end: np.ndarray
    rigid_modes: np.ndarray


def expand_catenaries(
    cables: CableStates,
    linear_density: np.ndarray,
    order: int,
    end_stiffness: np.ndarray,
    frame_ends: FrameEnds | None = None,
    extras: CableExtras | None = None,
    left_out: LeftOut | None = None,
) -> ModalExpansion:
    """Expansion of m cables (m,) with all the modes that the polynomials span, 3 (order - 1) for fixed frame ends.

    Local axes: x along the heading (horizontal, from the frame to the platform), y across, z up. Modes are sorted by
    frequency. About order / 2 half waves per plane are resolved to ten digits.

    Parameters
    ----------
    end_stiffness : (m, 3, 3) static stiffness of the platform ends, world [N/m]
    frame_ends : None where all are fixed points
    extras : None where cables neither resist bending nor carry masses
    left_out : not None: cables that lack something; their static stiffness is then computed here
    """
    frame = cable_frame(cables)
    to_local = np.swapaxes(frame, -1, -2)
    lumped = cables.has_lumps
    basis = PiecewiseBasis(order, 1 + lumped * cables.lump_place.shape[-1])
    nodes, weights, values, slopes = basis.on_gauss_nodes() if lumped else on_gauss_nodes(order)
    coordinate = PiecewiseCoordinate.of(cables) if lumped else CatenaryCoordinate.of(cables)
    arc, rate = coordinate.arc(nodes)
    stretched = None if left_out is None else left_out.axial_stiffness
    density = stiffness_density(cables, arc, axial_stiffness=stretched)
    scale = weights / rate
    inertia = linear_density[:, None] * rate * weights
    mass = _products(values, inertia)
    bending = None
    if extras is not None and extras.added_mass.any():
        there, _ = basis.values(coordinate.xi(1.0 - extras.added_mass_place[:, None]))
        mass = mass + _of_points(there, extras.added_mass[:, None])
    if extras is not None and lumped:
        there, _ = basis.values(coordinate.xi(1.0 - cables.lump_place / cables.length[:, None]))
        mass = mass + _of_points(there, extras.lump_mass)
    if extras is not None and extras.bending_stiffness.any():
        slender = slenderness(extras.bending_stiffness, cables.tension, cables.chord)
        density = stiffness_density(cables, arc, (1.0 + shortening(slender, extras.bending_fixity)) ** 2)
        bending = curvatures(nodes, order), extras.bending_stiffness[:, None] * weights / rate**3
        sideways = across(cables, arc)
    directions = None if frame_ends is None else to_local @ frame_ends.directions
    springs = None if frame_ends is None else frame_ends.stiffness
    planes = []
    for components in ((0, 2), (1,)) if frame_ends is None else ((0, 1, 2),):
        own = density[..., components, :][..., components]
        stiffness = np.moveaxis(_products(slopes, np.moveaxis(own * scale[..., None, None], 1, -1)), (1, 2), (2, 4))
        if bending is not None:
            plane = sideways[..., components, :][..., components] * bending[1][..., None, None]
            stiffness = stiffness + np.moveaxis(_products(bending[0], np.moveaxis(plane, 1, -1)), (1, 2), (2, 4))
        full = mass if len(components) == 1 else np.kron(mass, np.eye(len(components)))
        if left_out is not None and left_out.axial_inertia:
            moved = along(cables, arc)[..., components, :][..., components] * inertia[..., None, None]
            full = full - np.moveaxis(_products(values, np.moveaxis(moved, 1, -1)), (1, 2), (2, 4)).reshape(full.shape)
        freedoms = _Freedoms.of(basis.count - 1, len(components), directions)
        planes.append(_condense(components, stiffness, full, freedoms, springs))
    computed = _end_mass([(plane.components, plane.end_stiffness) for plane in planes])
    found = ModalExpansion(
        frame=frame,
        static_stiffness=to_local @ end_stiffness @ frame if left_out is None else computed,
        end_mass=_end_mass([(plane.components, plane.end_mass) for plane in planes]),
        omega_squared=np.concatenate([plane.omega_squared for plane in planes], axis=1),
        coupling=_coupling([(plane.components, plane.coupling) for plane in planes]),
        rigid_mass=_end_mass([(plane.components, plane.rigid_mass) for plane in planes]),
        rigid_end=_end_mass([(plane.components, plane.rigid_end) for plane in planes]),
        rigid_modes=_coupling([(plane.components, plane.rigid_modes) for plane in planes]),
        shapes=lambda stations, derivative=0: _shapes(planes, coordinate, basis, stations, derivative),
    )
    return found.ascending()


def _products(functions: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(..., i, j) weighted sums over q of products of functions (i, q), weights (..., q)."""
    return (functions * weights[..., None, :]) @ functions.T


def _of_points(functions: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """(m, i, j) of masses (m, k) where functions have the values (i, m, k)."""
    return np.asarray(np.einsum("imk,jmk,mk->mij", functions, functions, mass, optimize=True))


@dataclass(frozen=True, slots=True, eq=False)
class _Freedoms:
    """Free combinations of i functions and c components, those of the moving end last.

    kept    : those that are free as they are, frame and moving end ramps alike; all but the frame's where it is fixed
    columns : (m, i c, n) where the frame gives way in some directions, None where it is fixed
    """

    kept: np.ndarray
    columns: np.ndarray | None

    @classmethod
    def of(cls, order: int, size: int, frame_directions: np.ndarray | None) -> "_Freedoms":
        bubbles, every = (order - 1) * size, (order + 1) * size
        kept = np.r_[0:bubbles, bubbles + size : every]
        if frame_directions is None:
            return cls(kept, None)
        count, _, q = frame_directions.shape
        columns = np.zeros((count, every, every - size + q))
        columns[:, :bubbles, :bubbles] = np.eye(bubbles)
        columns[:, bubbles : bubbles + size, bubbles : bubbles + q] = frame_directions
        columns[:, -size:, -size:] = np.eye(size)
        return cls(kept, columns)

    def rows(self, matrix: np.ndarray) -> np.ndarray:
        """(m, n, ...) of (m, i c, ...)."""
        return matrix[:, self.kept] if self.columns is None else np.swapaxes(self.columns, 1, 2) @ matrix

    def both(self, matrix: np.ndarray) -> np.ndarray:
        """(m, n, n) of (m, i c, i c)."""
        return self.rows(matrix)[..., self.kept] if self.columns is None else self.rows(matrix) @ self.columns

    def functions(self, vectors: np.ndarray, size: int) -> np.ndarray:
        """(m, (i - 1) c, ...) coefficients of all but the moving end's functions, of free ones (m, n - c, ...)."""
        if self.columns is not None:
            return self.columns[:, :-size, :-size] @ vectors
        return np.concatenate([vectors, np.zeros((len(vectors), size, vectors.shape[-1]))], axis=1)


def _condense(
    components: tuple[int, ...],
    stiffness: np.ndarray,
    mass: np.ndarray,
    freedoms: _Freedoms,
    springs: np.ndarray | None,
) -> _Plane:
    """Static shapes of the moving end and modes of the clamped cable; stiffness (m, i, c, i, c), mass (m, i c, i c)."""
    (m, count), size = stiffness.shape[:2], len(components)
    stiffness = freedoms.both(stiffness.reshape(m, count * size, count * size))
    full, mass = mass, freedoms.both(mass)
    whole = np.kron(np.r_[np.zeros(count - 2), 1.0, 1.0][:, None], np.eye(size))  # both ramps sum up to one
    shared = freedoms.rows(full @ whole)
    inner, end = slice(None, -size), slice(-size, None)
    if springs is not None:
        held = np.arange(stiffness.shape[-1] - size - springs.shape[1], stiffness.shape[-1] - size)
        stiffness[:, held, held] += springs
    omega_squared, modes = _slow_modes_first(stiffness[:, inner, inner], mass[:, inner, inner])
    static = -np.linalg.solve(stiffness[:, inner, inner], stiffness[:, inner, end])
    carried = mass[:, inner, end] + mass[:, inner, inner] @ static
    end_mass = mass[:, end, end] + mass[:, end, inner] @ static + np.swapaxes(static, 1, 2) @ carried
    return _Plane(
        components,
        omega_squared,
        freedoms.functions(modes, size).reshape(m, count - 1, size, -1),
        freedoms.functions(static, size).reshape(m, count - 1, size, size),
        stiffness[:, end, end] + stiffness[:, end, inner] @ static,
        end_mass,
        np.swapaxes(modes, 1, 2) @ carried,
        whole.T @ full @ whole,
        shared[:, end] + np.swapaxes(static, 1, 2) @ shared[:, inner],
        np.swapaxes(modes, 1, 2) @ shared[:, inner],
    )


def _slow_modes_first(stiffness: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """omega^2 (m, p) ascending and modes (m, i, p) of unit modal mass, from the eigenproblem of 1 / omega^2.

    The fastest axial modes lie eight or more decades above the first transverse one; turned round, rounding falls on
    them and not on the slow modes.
    """
    inverse = np.linalg.inv(np.linalg.cholesky(stiffness))
    periods, vectors = np.linalg.eigh(inverse @ mass @ np.swapaxes(inverse, 1, 2))
    periods, vectors = periods[:, ::-1], vectors[..., ::-1]
    periods = np.maximum(periods, np.finfo(float).eps * periods[:, :1])
    return 1.0 / periods, np.swapaxes(inverse, 1, 2) @ vectors / np.sqrt(periods)[:, None, :]


def _end_mass(parts: list[tuple[tuple[int, ...], np.ndarray]]) -> np.ndarray:
    """(m, 3, 3) from the blocks (m, c, c) of some components each."""
    total = np.zeros((len(parts[0][1]), 3, 3))
    for components, part in parts:
        total[np.ix_(range(len(total)), components, components)] = part
    return total


def _coupling(parts: list[tuple[tuple[int, ...], np.ndarray]]) -> np.ndarray:
    """(m, p, 3) from those (m, p, c) of the modes in some components each."""
    blocks = []
    for components, part in parts:
        block = np.zeros((*part.shape[:2], 3))
        block[..., components] = part
        blocks.append(block)
    return np.concatenate(blocks, axis=1)


def _shapes(
    planes: list[_Plane],
    coordinate: CatenaryCoordinate | PiecewiseCoordinate,
    basis: PiecewiseBasis,
    stations: np.ndarray,
    derivative: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Static shapes (m, s, 3, 3) and modes (m, p, s, 3) as `Shapes` says; the second derivative for taut cables."""
    xi = coordinate.xi(stations)
    values, slopes = basis.values(xi)
    if derivative:
        stretch = coordinate.length[:, None] / coordinate.arc(xi)[1]
        values = slopes * stretch if derivative == 1 else curvatures(xi, basis.order) * stretch**2
    inner, ramp = values[:-1], values[-1]
    static = np.zeros((*xi.shape, 3, 3))
    blocks = []
    for plane in planes:
        own = np.einsum("ims,miab->msab", inner, plane.static, optimize=True)
        for a, row in enumerate(plane.components):
            for b, column in enumerate(plane.components):
                static[:, :, row, column] = own[..., a, b] + (a == b) * ramp
        block = np.zeros((*plane.omega_squared.shape, xi.shape[1], 3))
        block[..., plane.components] = np.einsum("ims,miap->mpsa", inner, plane.modes, optimize=True)
        blocks.append(block)
    return static, np.concatenate(blocks, axis=1)

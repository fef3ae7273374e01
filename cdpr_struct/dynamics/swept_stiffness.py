"""The platform's dynamic stiffness at very many frequencies, for little more than the cost of solving with it.

Near a natural frequency of a clamped cable the stiffness has a pole whose place and strength the modal expansion of
the cable knows. Over a segment of the band the few poles around it are summed one by one; what remains is smooth and
is interpolated in Chebyshev points, at which the full model is evaluated. The decay of the coefficients is the error
estimate; a segment that misses the tolerance is halved, and at last evaluated in full at every frequency.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from cdpr_struct.dynamics.cable_dynamics import CableDynamics, ClosedFormCables
from cdpr_struct.dynamics.damping import DampingLaw
from cdpr_struct.dynamics.internal_mass import internal_reaction
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    assemble,
    attachment,
    platform_mass_matrix,
)

RELATIVE_TOLERANCE = 1e-9
_NODES = 16
_POLES_PER_SEGMENT = 12
_NEAR = 2.5  # poles within this many half widths of a segment's centre are summed one by one
_HALVINGS = 4
_BLOCK = 64
UPPER = np.triu_indices(6)
"""Rows and columns of the 21 entries of an upper triangle."""
_DIAGONAL = np.flatnonzero(UPPER[0] == UPPER[1])
_FULL = np.array(
    [[np.flatnonzero((UPPER[0] == min(i, j)) & (UPPER[1] == max(i, j)))[0] for j in range(6)] for i in range(6)]
)


def dynamic_stiffness(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    omega: np.ndarray,
    assembly: Assembly = "consistent",
) -> np.ndarray:
    """D(omega) = K_E(omega) - omega^2 M of eq. (3.25) with damped cables, evaluated in full at every frequency.

    omega : (f,) [rad/s], zero or above

    Returns
    -------
    (f, 6, 6) complex, symmetric, world axes, moments about the platform origin [N/m, N, N m].
    """
    matrices = _of_rigid_platform(point, cables, law, omega, assembly)
    return matrices - internal_reaction(point.arrays, point.rotation, omega**2)


def _of_rigid_platform(
    point: OperatingPoint, cables: CableDynamics, law: DampingLaw, omega: np.ndarray, assembly: Assembly
) -> np.ndarray:
    """The same with an internal mass held fast, so that cables have all the poles."""
    matrices = np.empty((len(omega), 6, 6), dtype=complex)
    for start in range(0, len(omega), _BLOCK):
        part = omega[start : start + _BLOCK]
        matrices[start : start + _BLOCK] = _cable_part(point, cables, law, part, assembly)
    return matrices - (omega**2)[:, None, None] * platform_mass_matrix(point.arrays, point.rotation)


@dataclass(frozen=True, slots=True, eq=False)
class SweptStiffness:
    """D(omega) over a band [rad/s], prepared once for any number of frequencies in it; made by `swept_stiffness`."""

    point: OperatingPoint
    cables: CableDynamics
    law: DampingLaw
    assembly: Assembly
    low: float
    pieces: "list[_Piece]"
    poles: "_Poles | None"

    def at(self, omega: np.ndarray) -> np.ndarray:
        """(f, 6, 6) as `dynamic_stiffness`, to `RELATIVE_TOLERANCE` of the largest entries; omega (f,) ascending."""
        return np.ascontiguousarray(np.moveaxis(self.upper(omega)[_FULL], -1, 0))

    def upper(self, omega: np.ndarray) -> np.ndarray:
        """(21, f) upper triangles of `at`, row by row.

        The bottom of the band, where a law may jump at rest, and what no piece covers are evaluated in full.
        """
        entries = np.empty((21, len(omega)), dtype=complex)
        left = np.ones(len(omega), dtype=bool)
        for piece in self.pieces:
            part = slice(*np.searchsorted(omega, [piece.low, piece.high]))
            if self.poles is not None and part.start < part.stop:
                entries[:, part] = piece.at(omega[part], self.law, self.poles)
                left[part] = False
        left |= omega <= self.low
        if left.any():
            full = _of_rigid_platform(self.point, self.cables, self.law, omega[left], self.assembly)
            entries[:, left] = full[:, *UPPER].T
        if self.point.arrays.has_internal_mass:
            entries -= internal_reaction(self.point.arrays, self.point.rotation, omega**2)[:, *UPPER].T
        return entries


def swept_stiffness(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    band: tuple[float, float],
    assembly: Assembly = "consistent",
) -> SweptStiffness:
    """The dynamic stiffness over a band (lowest, highest) [rad/s]."""
    low, high = band
    if point.arrays.has_masts:  # masts move the poles
        return SweptStiffness(point, cables, law, assembly, low, [], None)
    poles = _poles(point, cables, high)
    inside = int((np.sqrt(poles.omega_squared) < high).sum())
    edges = np.linspace(low, high, 2 + inside // _POLES_PER_SEGMENT)
    segments = np.stack([edges[:-1], edges[1:]], axis=-1)
    kept: list[_Piece] = []
    for _ in range(_HALVINGS + 1):
        pieces = _interpolate(point, cables, law, segments, poles, assembly)
        kept += [piece for piece in pieces if piece.accurate]
        refused = [(piece.low, piece.high) for piece in pieces if not piece.accurate]
        if not refused:
            break
        segments = _halves(np.array(refused))
    return SweptStiffness(point, cables, law, assembly, low, kept, poles)


def swept_dynamic_stiffness(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    omega: np.ndarray,
    assembly: Assembly = "consistent",
) -> np.ndarray:
    """`SweptStiffness.at` for one ascending sweep (f,)."""
    return swept_stiffness(point, cables, law, (float(omega[0]), float(omega[-1])), assembly).at(omega)


def _halves(segments: np.ndarray) -> np.ndarray:
    middle = segments.mean(axis=1)
    return np.concatenate([np.stack([segments[:, 0], middle], -1), np.stack([middle, segments[:, 1]], -1)])


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """The stiffness over [low, high) [rad/s]: Chebyshev coefficients (n, 21) and the poles summed one by one."""

    low: float
    high: float
    coefficients: np.ndarray
    near: np.ndarray

    @property
    def accurate(self) -> bool:
        """The last coefficients are small against the diagonal entries of their row and column."""
        sizes = np.abs(self.coefficients)
        diagonal = np.sqrt(sizes[:, _DIAGONAL].max(axis=0))
        return bool((sizes[-2:] < RELATIVE_TOLERANCE * diagonal[UPPER[0]] * diagonal[UPPER[1]]).all())

    def at(self, omega: np.ndarray, law: DampingLaw, poles: "_Poles") -> np.ndarray:
        """(21, f) at frequencies inside."""
        x = (2.0 * omega - self.low - self.high) / (self.high - self.low)
        powers = np.ascontiguousarray(chebyshev.chebvander(x, _NODES - 1).T)
        found = poles.sum(self.near, law, omega)
        found.real += self.coefficients.real.T @ powers
        found.imag += self.coefficients.imag.T @ powers
        return found


def _interpolate(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    segments: np.ndarray,
    poles: "_Poles",
    assembly: Assembly,
) -> list[_Piece]:
    x = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    middle, half = segments.mean(axis=1), 0.5 * np.diff(segments, axis=1)[:, 0]
    nodes = middle[:, None] + half[:, None] * x
    values = _at_nodes(point, cables, law, nodes.ravel(), poles, assembly).reshape(*nodes.shape, 21)
    to_coefficients = 2.0 / _NODES * chebyshev.chebvander(x, _NODES - 1).T
    to_coefficients[0] *= 0.5
    place = np.sqrt(poles.omega_squared)
    pieces = []
    for k, (low, high) in enumerate(segments.tolist()):
        near = np.flatnonzero(np.abs(place - middle[k]) < _NEAR * half[k])
        smooth = values[k] - poles.sum(near, law, nodes[k]).T
        pieces.append(_Piece(low, high, to_coefficients @ smooth, near))
    return pieces


@dataclass(frozen=True, slots=True, eq=False)
class _Poles:
    """Natural frequencies of the clamped cables, all together.

    omega_squared   : (p,) [rad^2/s^2]
    cable           : (p,) number of the cable, from 0
    strength        : (p, 21) of the pole in the platform's matrix, upper triangle
    static, mass    : (m, 21) what is left of each cable without poles, in the platform's matrix [N/m, kg, ..]
    first_frequency : (m,) of the clamped cables [rad/s]
    """

    omega_squared: np.ndarray
    cable: np.ndarray
    strength: np.ndarray
    static: np.ndarray
    mass: np.ndarray
    first_frequency: np.ndarray

    def sum(self, chosen: np.ndarray, law: DampingLaw, omega: np.ndarray) -> np.ndarray:
        """(21, f) part of the platform's stiffness that the chosen poles make."""
        factors = (
            law.inertia(omega[:, None], self.first_frequency),
            law.elasticity(omega[:, None], self.first_frequency),
        )
        inertia, elasticity = (np.ascontiguousarray(np.transpose(factor)) for factor in factors)
        cable, squared = self.cable[chosen], self.omega_squared[chosen][:, None]
        gap = elasticity[cable] * squared - inertia[cable]
        gap = np.where(gap == 0.0, np.finfo(float).eps * squared, gap)
        gain = -(inertia**2)[cable] / gap
        strength = np.ascontiguousarray(self.strength[chosen].T)
        if not np.iscomplexobj(gain):
            return np.asarray((strength @ gain).astype(complex))
        return np.asarray((strength @ gain.view(float)).view(complex))


def _poles(point: OperatingPoint, cables: CableDynamics, highest: float) -> _Poles:
    expansion = cables.expansion(1.5 * highest)
    to_cable = np.swapaxes(expansion.frame, -1, -2) @ attachment(point)
    arms = np.einsum("mpa,mai->mpi", expansion.coupling, to_cable)
    omega_squared = expansion.omega_squared.ravel()
    return _Poles(
        omega_squared,
        np.repeat(np.arange(len(arms)), arms.shape[1]),
        (arms[..., UPPER[0]] * arms[..., UPPER[1]]).reshape(len(omega_squared), 21),
        (np.swapaxes(to_cable, 1, 2) @ expansion.static_stiffness @ to_cable)[:, *UPPER],
        (np.swapaxes(to_cable, 1, 2) @ expansion.end_mass @ to_cable)[:, *UPPER],
        cables.first_frequency,
    )


def _at_nodes(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    omega: np.ndarray,
    poles: _Poles,
    assembly: Assembly,
) -> np.ndarray:
    """(f, 21) full matrices. The closed form is evaluated as such: its modal expansion is only a truncated series."""
    if isinstance(cables, ClosedFormCables):
        return _of_rigid_platform(point, cables, law, omega, assembly)[:, *UPPER]
    rigid = assemble(point, np.zeros((len(poles.static), 3, 3)), assembly)[UPPER]
    mass = platform_mass_matrix(point.arrays, point.rotation)[UPPER]
    inertia = law.inertia(omega[:, None], poles.first_frequency)
    elasticity = law.elasticity(omega[:, None], poles.first_frequency)
    smooth = elasticity @ poles.static - inertia @ poles.mass + rigid - (omega**2)[:, None] * mass
    return smooth + poles.sum(np.arange(len(poles.omega_squared)), law, omega).T


def _cable_part(
    point: OperatingPoint, cables: CableDynamics, law: DampingLaw, omega: np.ndarray, assembly: Assembly
) -> np.ndarray:
    first = cables.first_frequency
    inertia, elasticity = law.inertia(omega[:, None], first), law.elasticity(omega[:, None], first)
    stiffness = elasticity[..., None, None] * cables.stiffness(inertia / elasticity)
    if not point.arrays.has_masts:
        return assemble(point, stiffness, assembly)
    ends, own = (elasticity[..., None, None] * part for part in cables.mast_stiffness(inertia / elasticity))
    return assemble(point, stiffness, assembly, (ends, own))

"""The platform's dynamic stiffness at very many frequencies, for little more than the cost of solving with it.

Near a natural frequency of a clamped cable the stiffness has a pole whose place and strength the modal expansion of
the cable knows. Over a segment of the band the few poles around it are summed one by one, with what the damping law
itself makes of each cable (`cable_poles`); what remains is smooth, whatever the law, and is interpolated in Chebyshev
points, at which the full model is evaluated. The decay of the coefficients is the error estimate; a segment that
misses the tolerance is halved, and at last evaluated in full at every frequency.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics, ClosedFormCables
from cdpr_struct.dynamics.cable_poles import UPPER, CableFactors, CablePoles, cable_poles, weighted
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
    """The same with moving parts held fast, so that cables have all the poles."""
    matrices = np.empty((len(omega), 6, 6), dtype=complex)
    for start in range(0, len(omega), _BLOCK):
        part = omega[start : start + _BLOCK]
        matrices[start : start + _BLOCK] = _cable_part(point, cables, law, part, assembly)
    return matrices - (omega**2)[:, None, None] * platform_mass_matrix(point.arrays, point.rotation)


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


@dataclass(frozen=True, slots=True, eq=False)
class SweptStiffness:
    """D(omega) over a band [rad/s], prepared once for any number of frequencies in it; made by `swept_stiffness`."""

    point: OperatingPoint
    cables: CableDynamics
    law: DampingLaw
    assembly: Assembly
    low: float
    pieces: "list[_Piece]"
    model: "_Model | None"

    def at(self, omega: np.ndarray) -> np.ndarray:
        """(f, 6, 6) as `dynamic_stiffness`, to `RELATIVE_TOLERANCE` of the largest entries; omega (f,) ascending."""
        return np.ascontiguousarray(np.moveaxis(self.upper(omega)[_FULL], -1, 0))

    def upper(self, omega: np.ndarray) -> np.ndarray:
        """(21, f) upper triangles of `at`, row by row.

        The bottom of the band, where a law may jump at rest, and what no piece covers are evaluated in full.
        """
        entries = np.empty((21, len(omega)), dtype=complex)
        factors = CableFactors.of(self.law, omega, self.cables.first_frequency)
        left = np.ones(len(omega), dtype=bool)
        for piece in self.pieces:
            part = slice(*np.searchsorted(omega, [piece.low, piece.high]))
            if part.start < part.stop:
                entries.real[:, part], entries.imag[:, part] = np.swapaxes(piece.at(factors[part]), 0, 1)
                left[part] = False
        left |= omega <= self.low
        if left.any():
            entries[:, left] = self._in_full(factors[left])
        if self.point.arrays.has_moving_parts:
            entries -= internal_reaction(self.point.arrays, self.point.rotation, omega**2)[:, *UPPER].T
        return entries

    def _in_full(self, factors: CableFactors) -> np.ndarray:
        if self.model is None:
            return _of_rigid_platform(self.point, self.cables, self.law, factors.omega, self.assembly)[:, *UPPER].T
        found = self.model.upper(factors)
        return np.asarray(found[:, 0] + 1j * found[:, 1])


def swept_stiffness(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    band: tuple[float, float],
    assembly: Assembly = "consistent",
) -> SweptStiffness:
    """The dynamic stiffness over a band (lowest, highest) [rad/s]."""
    low, high = band
    kept: list[_Piece] = []
    if point.arrays.has_masts:  # masts move the poles
        return SweptStiffness(point, cables, law, assembly, low, kept, None)
    model = _Model.of(point, cables, law, high, assembly)
    if not len(model.poles.omega_squared):  # nothing to interpolate
        return SweptStiffness(point, cables, law, assembly, low, kept, model)
    inside = int((model.poles.omega_squared < high**2).sum())
    edges = np.linspace(low, high, 2 + inside // _POLES_PER_SEGMENT)
    segments = np.stack([edges[:-1], edges[1:]], axis=-1)
    for _ in range(_HALVINGS + 1):
        pieces = model.interpolated(segments)
        accurate = np.array([piece.accurate for piece in pieces])
        kept += [piece for piece, good in zip(pieces, accurate, strict=True) if good]
        if accurate.all():
            break
        segments = _halves(segments[~accurate])
    return SweptStiffness(point, cables, law, assembly, low, kept, model)


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


def _chebyshev(x: np.ndarray) -> np.ndarray:
    """(_NODES, f) polynomials at x (f,), doubling their number by T_(m + k) = 2 T_m T_k - T_(m - k)."""
    values = np.empty((_NODES, len(x)))
    values[0], values[1] = 1.0, x
    m = 1
    while m < _NODES - 1:
        end = min(2 * m, _NODES - 1)
        np.multiply(2.0 * values[m], values[1 : end - m + 1], out=values[m + 1 : end + 1])
        values[m + 1 : end + 1] -= values[2 * m - end : m][::-1]
        m = end
    return values


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """The stiffness over [low, high) [rad/s].

    coefficients : (42, n) of Chebyshev polynomials, real and imaginary part of each entry
    near, weights : poles summed one by one, and `CablePoles.weights` of these
    size : (6,) roots of the largest diagonal entries of what is summed without poles
    """

    low: float
    high: float
    coefficients: np.ndarray
    near: np.ndarray
    weights: np.ndarray
    size: np.ndarray
    poles: CablePoles

    @property
    def accurate(self) -> bool:
        """The last coefficients are small against the diagonal entries of their row and column."""
        last = np.hypot(self.coefficients[::2, -2:], self.coefficients[1::2, -2:])
        return bool((last.max(axis=1) < RELATIVE_TOLERANCE * self.size[UPPER[0]] * self.size[UPPER[1]]).all())

    def at(self, factors: CableFactors) -> np.ndarray:
        """(21, 2, f) at frequencies inside."""
        powers = _chebyshev((2.0 * factors.omega - self.low - self.high) / (self.high - self.low))
        found = weighted(self.weights, self.poles.terms(self.near, factors))
        found += (self.coefficients @ powers).reshape(found.shape)
        return found


@dataclass(frozen=True, slots=True, eq=False)
class _Model:
    """The full model on rigid masts, to be evaluated at few frequencies.

    to_cables : (m, 3, 6) attachment matrices
    """

    cables: CableDynamics
    law: DampingLaw
    poles: CablePoles
    to_cables: np.ndarray

    @classmethod
    def of(
        cls, point: OperatingPoint, cables: CableDynamics, law: DampingLaw, highest: float, assembly: Assembly
    ) -> "_Model":
        arms = attachment(point)
        rigid = assemble(point, np.zeros((len(arms), 3, 3)), assembly)
        mass = platform_mass_matrix(point.arrays, point.rotation)
        return cls(cables, law, cable_poles(cables.expansion(1.5 * highest), arms, rigid, mass), arms)

    def upper(self, factors: CableFactors) -> np.ndarray:
        """(21, 2, f). The closed form is evaluated as such: its modal expansion is only a truncated series."""
        if not isinstance(self.cables, ClosedFormCables):
            every = np.arange(len(self.poles.omega_squared))
            return weighted(self.poles.weights(every), self.poles.terms(every, factors))
        ratio = (factors.inertia / factors.elasticity).T
        stiffness = factors.elasticity.T[..., None, None] * self.cables.stiffness(ratio)
        arms = self.to_cables[:, :, None, UPPER[0]] * self.to_cables[:, None, :, UPPER[1]]
        flat = (stiffness.reshape(len(ratio), -1) @ arms.reshape(-1, 21)).T
        platform = self.poles.rigid[:, None] - factors.omega**2 * self.poles.inertia[:, None]
        return np.stack([flat.real + platform, flat.imag], axis=1)

    def interpolated(self, segments: np.ndarray) -> list[_Piece]:
        """Segments (s, 2) [rad/s] as pieces."""
        x = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
        middle, half = segments.mean(axis=1), 0.5 * np.diff(segments, axis=1)[:, 0]
        omega = (middle[:, None] + half[:, None] * x).ravel()
        factors = CableFactors.of(self.law, omega, self.cables.first_frequency)
        values = self.upper(factors)
        to_coefficients = 2.0 / _NODES * _chebyshev(x).T
        to_coefficients[:, 0] *= 0.5
        place = np.sqrt(self.poles.omega_squared)
        pieces = []
        for k, (low, high) in enumerate(segments.tolist()):
            part = slice(k * _NODES, (k + 1) * _NODES)
            near = np.flatnonzero(np.abs(place - middle[k]) < _NEAR * half[k])
            weights, terms = self.poles.weights(near), self.poles.terms(near, factors[part])
            rest = values[..., part] - weighted(weights, terms)
            smooth = rest + weighted(weights[:, len(near) :], terms[len(near) :])
            size = np.sqrt(np.abs(smooth[_DIAGONAL]).max(axis=(1, 2)))
            pieces.append(
                _Piece(low, high, rest.reshape(42, _NODES) @ to_coefficients, near, weights, size, self.poles)
            )
        return pieces

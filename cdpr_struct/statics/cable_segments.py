"""Cables with point masses on them: catenaries in series, from the platform to the frame.

Without wind the cable stays in one plane and its horizontal force H is the same everywhere; at a point mass the
vertical force jumps by its weight. Each segment between two masses is thus a catenary with forces (H, V_j) at its
platform end, V_j the vertical force at the cable's end less all weight in between. The end of the cable is the sum of
the segments' ends, so its derivative by (H, V) is the sum of their compliances (2.24)-(2.27), and the complementary
energy, whose gradient the gap is, is convex.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.cable_compliance import compliance
from cdpr_struct.generated.catenary import end_point
from cdpr_struct.statics.cable_state import STEEPEST, segments
from cdpr_struct.statics.catenary import CableStatus, CatenaryForces, solve_end_forces

MAX_ITERATIONS = 100
_SETTLED = 1e-13  # of the tension, between two steps
_NOISE = 64.0 * float(np.finfo(float).eps)  # of EA: rounding of the end point, in forces
_RESIDUAL = 1e-10  # of the unstrained length
Ends = tuple[np.ndarray, np.ndarray, np.ndarray]
"""x, z and unstrained length (n,) [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Loading:
    """What hangs where on cables (...): weight w [N/m], point weights (..., k) [N] at places (..., k) [m] from the
    platform end, ascending; EA (...) [N]."""

    weight: np.ndarray
    place: np.ndarray
    point_weight: np.ndarray
    axial_stiffness: np.ndarray

    def take(self, index: np.ndarray) -> "Loading":
        """Items of a flat batch."""
        return Loading(*(getattr(self, name)[index] for name in self.__slots__))

    @property
    def points(self) -> np.ndarray:
        """(...) all point weights together [N]."""
        return np.asarray(self.point_weight.sum(axis=-1))

    def segments(self, force_x: np.ndarray, force_z: np.ndarray, length: np.ndarray) -> tuple[np.ndarray, ...]:
        """Arguments (..., k + 1) of the generated functions of every segment."""
        cable = force_x, force_z, length, self.axial_stiffness, self.weight
        return segments(cable, self.place, self.point_weight)

    def reached(self, *of_cable: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and z (...) [m] of the platform end from the frame end."""
        x, z = end_point(*self.segments(*of_cable))
        return x.sum(axis=-1), z.sum(axis=-1)

    def compliance(self, *of_cable: np.ndarray) -> tuple[np.ndarray, ...]:
        """c_axial, c_xx, c_xz, c_zz (...) [m/N] of the whole cable."""
        return tuple(part.sum(axis=-1) for part in compliance(*self.segments(*of_cable)))


def forces_at_length(
    x: np.ndarray, z: np.ndarray, length: np.ndarray, loading: Loading, near: CatenaryForces | None
) -> CatenaryForces:
    """Pulls at the platform ends of cables (...) through (0, 0) and (x, z), x >= 0 [m], of unstrained `length`.

    near : of cables nearly like these, to begin from
    """
    begin = near
    if begin is None or begin.force_x.shape != x.shape:
        even = loading.weight + loading.points / length
        begin = solve_end_forces(x, z, length, loading.axial_stiffness, even)
    flat = x.reshape(-1), z.reshape(-1), length.reshape(-1)
    own = Loading(*(value.reshape((-1, *value.shape[x.ndim :])) for value in _whole(loading, x.shape)))
    pull = np.stack([begin.force_x.reshape(-1), begin.force_z.reshape(-1)], axis=-1)
    iterations = np.zeros(len(pull), dtype=int)
    items, gap = np.arange(len(pull)), _gap(own, flat, pull)
    for _ in range(MAX_ITERATIONS):
        if not items.size:
            break
        part, here = own.take(items), (flat[0][items], flat[1][items], flat[2][items])
        step = -np.linalg.solve(_matrix(part, here[2], pull[items]), gap[items][..., None])[..., 0]
        pull[items], gap[items] = _searched(part, here, pull[items], gap[items], step)
        iterations[items] += 1
        size = np.hypot(*pull[items].T)
        small = np.hypot(*step.T) <= np.maximum(_SETTLED * size, _NOISE * part.axial_stiffness)
        items = items[~small]
    residual = np.hypot(*gap.T)
    status = np.where(residual <= _RESIDUAL * flat[2], CableStatus.CONVERGED, CableStatus.NOT_CONVERGED)
    parts = (pull[:, 0], pull[:, 1], residual, iterations, status, np.zeros(len(pull)))
    return CatenaryForces(*(part.reshape(x.shape) for part in parts))


def _whole(loading: Loading, shape: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    k = loading.place.shape[-1:]
    cores = ((), k, k, ())
    return tuple(
        np.broadcast_to(getattr(loading, name), shape + core)
        for name, core in zip(Loading.__slots__, cores, strict=True)
    )


def _gap(loading: Loading, ends: Ends, pull: np.ndarray) -> np.ndarray:
    """(n, 2) by how much the cables overshoot their ends [m]."""
    reached = loading.reached(pull[:, 0], pull[:, 1], ends[2])
    return np.stack([reached[0] - ends[0], reached[1] - ends[1]], axis=-1)


def _matrix(loading: Loading, length: np.ndarray, pull: np.ndarray) -> np.ndarray:
    """(n, 2, 2) derivative of the gap by the pull."""
    c_axial, c_xx, c_xz, c_zz = loading.compliance(pull[:, 0], pull[:, 1], length)
    return np.stack([np.stack([c_axial + c_xx, c_xz], axis=-1), np.stack([c_xz, c_axial + c_zz], axis=-1)], axis=-2)


def _searched(
    loading: Loading, ends: Ends, pull: np.ndarray, gap: np.ndarray, step: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Steps shortened until the energy, convex along them, does not rise steeply at their end, and H stays positive."""
    share = np.ones(len(pull))
    before = (gap * step).sum(axis=-1)
    for _ in range(60):
        trial = pull + share[:, None] * step
        trial[:, 0] = np.maximum(trial[:, 0], 0.1 * pull[:, 0])
        found = _gap(loading, ends, trial)
        slope = (found * step).sum(axis=-1)
        well = (slope <= 0.8 * np.abs(before)) | (np.hypot(*found.T) <= 0.9 * np.hypot(*gap.T))
        well |= np.hypot(*found.T) <= 1e-13 * ends[2]
        if well.all():
            break
        share = np.where(well, share, 0.5 * share)
    return trial, found


@dataclass(frozen=True, slots=True, eq=False)
class LoadedLength:
    """Cables of given chord tension: length [m], its rate with the tension [m/N], pulls at the platform [N], status."""

    length: np.ndarray
    length_rate: np.ndarray
    force_x: np.ndarray
    force_z: np.ndarray
    status: np.ndarray


def length_at_tension(
    x: np.ndarray, z: np.ndarray, chord_tension: np.ndarray, loading: Loading, begin: tuple[np.ndarray, np.ndarray]
) -> LoadedLength:
    """Unstrained length of cables through (0, 0) and (x, z), x >= 0 [m], with a horizontal pull of `chord_tension` [N]
    times x over the chord: along the chord, the tension where the cable is parallel to it.

    begin : vertical pull [N] and length [m] of cables nearly like these
    """
    x, z, tau = np.broadcast_arrays(x, z, chord_tension)
    chord = np.hypot(x, z)
    wide = np.maximum(x, STEEPEST * chord)
    own = Loading(*_whole(loading, x.shape))
    fx, (fz, length) = tau * wide / chord, begin
    for _ in range(MAX_ITERATIONS):
        a, b, c, d, error_x, error_z = _length_equations(own, wide, z, chord, tau, fx, fz, length)
        determinant = a * d - b * c
        step_fz = (b * error_z - d * error_x) / determinant
        step_length = (c * error_x - a * error_z) / determinant
        factor = np.minimum(1.0, 0.3 * length / np.maximum(np.abs(step_length), 1e-300))
        fz, length = fz + factor * step_fz, length + factor * step_length
        size = np.abs(step_length) / length + np.abs(step_fz) / np.hypot(fx, fz)
        if (size <= 1e-14).all():
            break
        if (size <= 1e-12).all() and (np.abs(error_x) * fx + np.abs(error_z) <= 1e-14 * length).all():
            break
    a, b, c, d, error_x, error_z = _length_equations(own, wide, z, chord, tau, fx, fz, length)
    c_axial, c_xx, c_xz, _ = own.compliance(fx, fz, length)
    first, second = -(c_axial + c_xx) / tau, -c_xz * wide / chord
    rate = (a * second - c * first) / (a * d - b * c)
    met = np.abs(error_x) * fx + np.abs(error_z) <= _RESIDUAL * length
    return LoadedLength(length, rate, fx, fz, np.where(met, CableStatus.CONVERGED, CableStatus.NOT_CONVERGED))


def _length_equations(
    own: Loading, x: np.ndarray, z: np.ndarray, chord: np.ndarray, tau: np.ndarray,
    fx: np.ndarray, fz: np.ndarray, length: np.ndarray,
) -> tuple[np.ndarray, ...]:  # fmt: skip
    """d(x/fx, z) / d(fz, L) row by row, and by how much both are missed. Cable is added at the frame end."""
    reached_x, reached_z = own.reached(fx, fz, length)
    c_axial, _, c_xz, c_zz = own.compliance(fx, fz, length)
    bottom = fz - own.weight * length - own.points
    stretch = 1.0 / own.axial_stiffness + 1.0 / np.hypot(fx, bottom)
    return c_xz / fx, stretch, c_axial + c_zz, bottom * stretch, reached_x / fx - chord / tau, reached_z - z

"""How long must a cable be to carry a given tension between two given points?

Two questions with one answer family: along the cables through fixed end points, the chord-parallel tension tau
(2.17) sweeps every cable once, from very slack (tau -> 0) to very taut. At given tau the horizontal force is
tau x / chord, and the unknowns (fz, L) come from a two-by-two Newton on the end-point equations (2.11)-(2.12); the
horizontal one is divided by fx, which keeps it regular for a vertical cable.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.cable_compliance import compliance
from cdpr_struct.generated.catenary import end_point
from cdpr_struct.generated.special_functions import tanhc
from cdpr_struct.statics.cable_state import STEEPEST
from cdpr_struct.statics.catenary import CableStatus

MAX_ITERATIONS = 60
SLACKEST = 6.0  # largest q = w chord / (2 tau); sinh(q)/q is then 34 times the span
_TOLERANCE = 1e-13
_NEAR = 0.1  # of tau: a cable nearer than this is a better start than the inextensible catenary


@dataclass(frozen=True, slots=True, eq=False)
class CatenaryLength:
    """Cables that carry given tensions, all arrays of one shape (...).

    length, length_rate   : unstrained length [m] and its derivative with respect to the chord tension [m/N]
    force_x               : horizontal pull at the platform end [N]
    force_z, force_z_rate : vertical pull there [N] and its derivative with respect to the chord tension [-]
    chord_tension         : tau [N]
    residual              : end-point error [m]
    iterations, status    : as in `CatenaryForces`
    """

    length: np.ndarray
    length_rate: np.ndarray
    force_x: np.ndarray
    force_z: np.ndarray
    force_z_rate: np.ndarray
    chord_tension: np.ndarray
    residual: np.ndarray
    iterations: np.ndarray
    status: np.ndarray

    @property
    def converged(self) -> np.ndarray:
        """(...) bool."""
        return self.status == CableStatus.CONVERGED


def length_at_chord_tension(
    x: npt.ArrayLike,
    z: npt.ArrayLike,
    chord_tension: npt.ArrayLike,
    axial_stiffness: npt.ArrayLike,
    weight: npt.ArrayLike,
) -> CatenaryLength:
    """Cable through (0, 0) and (x, z) with chord-parallel tension tau.

    Parameters
    ----------
    x, z : (...) platform end relative to the frame end [m], x >= 0; not both zero
    chord_tension : (...) tau > 0 [N], eq. (2.17)
    axial_stiffness, weight : (...) EA [N], w [N/m]

    Raises
    ------
    ValueError : a chord or a tension that is not positive.
    """
    arrays = np.broadcast_arrays(*(np.asarray(a, dtype=float) for a in (x, z, chord_tension, axial_stiffness, weight)))
    shape = arrays[0].shape
    x_, z_, tau, stiff, w = (np.atleast_1d(a).reshape(-1) for a in arrays)
    if not (tau > 0.0).all():
        raise ValueError(f"chord_tension must be > 0, got {tau[~(tau > 0.0)][0]!r}")
    chord = _checked_chord(x_, z_)
    return _shaped(_newton(np.maximum(x_, STEEPEST * chord), z_, chord, tau, stiff, w), shape)


def _checked_chord(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    chord = np.hypot(x, z)
    if not (chord > 0.0).all():
        raise ValueError(f"chord must be > 0, got {chord[~(chord > 0.0)][0]!r}")
    return chord


def _shaped(cable: CatenaryLength, shape: tuple[int, ...]) -> CatenaryLength:
    return CatenaryLength(*(np.reshape(getattr(cable, name), shape) for name in CatenaryLength.__slots__))


def solve_length(
    x: npt.ArrayLike,
    z: npt.ArrayLike,
    tension_at_platform: npt.ArrayLike,
    axial_stiffness: npt.ArrayLike,
    weight: npt.ArrayLike,
    near: CatenaryLength | None = None,
) -> CatenaryLength:
    """Unstrained length with which a cable pulls with a given tension at its platform end.

    Parameters
    ----------
    x, z : (...) platform end relative to the frame end [m], x >= 0
    tension_at_platform : (...) T > 0 [N]
    axial_stiffness, weight : (...) EA [N], w [N/m]
    near : the answer (...) to almost the same question, to begin with

    Returns
    -------
    CatenaryLength. Of the two cables with this tension the taut one. Status `TENSION_TOO_LOW` where the cable's own
    weight pulls harder than T at any length; the fields then hold the cable of least tension that was found.

    Raises
    ------
    ValueError : a chord or a tension that is not positive.
    """
    arrays = np.broadcast_arrays(
        *(np.asarray(a, dtype=float) for a in (x, z, tension_at_platform, axial_stiffness, weight))
    )
    x_, z_, wanted, stiff, w = (np.atleast_1d(a).reshape(-1) for a in arrays)
    if not (wanted > 0.0).all():
        raise ValueError(f"tension_at_platform must be > 0, got {wanted[~(wanted > 0.0)][0]!r}")
    chord = _checked_chord(x_, z_)
    half = 0.5 * w * chord
    cos, sin = x_ / chord, z_ / chord
    floor = np.maximum(half / SLACKEST, 1e-9 * wanted)
    tau = -sin * half + np.sqrt(np.maximum(wanted**2 - (cos * half) ** 2, 0.0))
    tau = np.maximum(tau, np.maximum(floor, 0.5 * half))
    near = None if near is None else _shaped(near, x_.shape)
    tau = tau if near is None else np.where(near.converged, near.chord_tension, tau)
    for _ in range(MAX_ITERATIONS):
        near = cable = _newton(np.maximum(x_, STEEPEST * chord), z_, chord, tau, stiff, w, near)
        tension = np.hypot(cable.force_x, cable.force_z)
        slope = (cos**2 * tau + cable.force_z * cable.force_z_rate) / tension
        step = (wanted - tension) / np.maximum(slope, 0.05)
        met = np.abs(wanted - tension) <= 1e-13 * (wanted + half)
        stuck = (tau <= floor) & (step < 0.0)
        if (met | stuck).all():
            break
        tau = np.where(met, tau, np.clip(tau + step, np.maximum(0.3 * tau, floor), 3.0 * tau + half))
    met = np.abs(wanted - tension) <= 1e-10 * (wanted + half)
    status = np.where(cable.converged & ~met, CableStatus.TENSION_TOO_LOW, cable.status)
    return _shaped(replace(cable, status=status), arrays[0].shape)


def force_z_curvature(x: np.ndarray, z: np.ndarray, chord_tension: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Second derivative (...) of force_z with respect to the chord tension [1/N], elasticity left out.

    For an inextensible cable fz = w/2 (z coth q + L), L^2 = z^2 + (x sinh(q)/q)^2, q = w chord / (2 tau). Meant to
    speed up an optimiser, not to enter a result.
    """
    q = np.minimum(0.5 * weight * np.hypot(x, z) / chord_tension, 2.0 * SLACKEST)
    small = q < 1e-2
    safe = np.where(small, 1e-2, q)
    spread, coth = np.sinh(safe) / safe, 1.0 / np.tanh(safe)
    first = np.where(small, q / 3.0, (np.cosh(safe) - spread) / safe)
    second = np.where(small, 1.0 / 3.0, spread - 2.0 * first / safe)
    coth_part = np.where(small, q / 1.5, 2.0 * safe * (safe * coth - 1.0) / np.sinh(safe) ** 2)
    spread = np.where(small, 1.0, spread)
    length = np.maximum(np.hypot(z, x * spread), 1e-300)
    length_q = x**2 * spread * first / length
    length_qq = (x**2 * (first**2 + spread * second) - length_q**2) / length
    curvature: np.ndarray = 0.5 * weight / chord_tension**2 * (z * coth_part + q * (q * length_qq + 2.0 * length_q))
    return curvature


def _newton(
    x: np.ndarray,
    z: np.ndarray,
    chord: np.ndarray,
    tau: np.ndarray,
    stiff: np.ndarray,
    w: np.ndarray,
    near: CatenaryLength | None = None,
) -> CatenaryLength:
    """Cables of a flat batch with the chord tension tau, begun from near ones where these are near enough."""
    fx = tau * x / chord
    length, fz = _start(x, z, chord, tau, stiff, w)
    if near is not None:
        more = tau - near.chord_tension
        useful = near.converged & (np.abs(more) < _NEAR * tau)
        length = np.where(useful, near.length + more * near.length_rate, length)
        fz = np.where(useful, near.force_z + more * near.force_z_rate, fz)
    iterations = np.zeros(x.shape, dtype=int)
    best = np.full(x.shape, np.inf)
    todo = np.ones(x.shape, dtype=bool)
    for _ in range(MAX_ITERATIONS):
        reached_x, reached_z = end_point(fx, fz, length, stiff, w)
        matrix = _jacobian(fx, fz, length, stiff, w)
        error_x, error_z = reached_x / fx - chord / tau, reached_z - z
        size = (np.abs(error_x) * fx + np.abs(error_z)) / length
        todo &= (size > _TOLERANCE) & ((size > 1e-10) | (size < 0.5 * best))  # stops at the floor of rounding too
        best = size
        if not todo.any():
            break
        step_fz, step_length = _solve_two(matrix, -error_x, -error_z)
        factor = np.minimum(1.0, 0.5 * length / np.maximum(np.abs(step_length), 1e-300))
        fz = np.where(todo, fz + factor * step_fz, fz)
        length = np.where(todo, length + factor * step_length, length)
        iterations += todo
    c_axial, c_sag, c_xz, _ = compliance(fx, fz, length, stiff, w)
    fz_rate, length_rate = _solve_two(matrix, -(c_axial + c_sag) / tau, -c_xz * x / chord)
    status = np.where(best <= 1e-10, CableStatus.CONVERGED, CableStatus.NOT_CONVERGED)
    return CatenaryLength(length, length_rate, fx, fz, fz_rate, tau, best * length, iterations, status)


def _start(
    x: np.ndarray, z: np.ndarray, chord: np.ndarray, tau: np.ndarray, stiff: np.ndarray, w: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Length and fz of the inextensible catenary through the unstretched chord."""
    q = np.minimum(0.5 * w * chord / tau, SLACKEST)
    spread = np.where(q > 0.0, np.sinh(q) / np.where(q > 0.0, q, 1.0), 1.0)
    length = np.hypot(z, x * spread) / (1.0 + tau / stiff)
    return length, z / (length / stiff + chord / tau * tanhc(q)) + 0.5 * w * length


def _jacobian(
    fx: np.ndarray, fz: np.ndarray, length: np.ndarray, stiff: np.ndarray, w: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """d(x/fx, z) / d(fz, L), row by row. Adding cable at the frame end adds it along the tension there."""
    c_axial, _, c_xz, c_zz = compliance(fx, fz, length, stiff, w)
    bottom = fz - w * length
    stretch = 1.0 / stiff + 1.0 / np.hypot(fx, bottom)
    return c_xz / fx, stretch, c_axial + c_zz, bottom * stretch


def _solve_two(
    matrix: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray], first: np.ndarray, second: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    a, b, c, d = matrix
    determinant = a * d - b * c
    return (d * first - b * second) / determinant, (a * second - c * first) / determinant

"""Elastic catenary between two given points: which end forces does it carry?

The end-point equations (2.11)-(2.12) have two unknowns, fx and fz. With S = |T_B| + |T_C| (sum of the two end
tensions) they collapse to one. Write W = w L and v = fz - W/2. Since |T_C|^2 - |T_B|^2 = 2 v W,
and the difference of the two arsinh is 2 artanh(W/S),

    z = v L (1/EA + 2/S),      x = fx L (1/EA + 2 artanh(W/S) / W),

so v follows from S, fx from the ellipse |T_B| + |T_C| = S, and x grows monotonically with S: one bracketed scalar
Newton a cable, from very taut to very slack, with the limits w = 0 and x = 0 inside. In the unknown
t = S/(2 EA) [-], with omega = W/(2 EA), a = |z|/L, d = t - omega and c = 1 + t - a,

    x/L = sqrt(d (d + 2 omega)) / t * sqrt(c (c + 2 a)) * (1 + m / (1 + t)),   m = artanh(r)/r - 1,  r = omega/t.

The solver works in p = t - max(omega, a - 1), which keeps every digit of d and c. The answer is checked against the
generated end-point equations.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from cdpr_struct.generated.catenary import end_point
from cdpr_struct.generated.special_functions import atanhc_remainder

MAX_ITERATIONS = 100
RESIDUAL_TOLERANCE = 1e-10  # of the unstrained length; measured worst case is about 1e-14
_VERTICAL = 1e-150  # x/L below this is a vertical cable: p would underflow


class CableStatus(IntEnum):
    """What the solver found for one cable."""

    CONVERGED = 0
    WEIGHTLESS_SLACK = 1  # w = 0 and the chord is shorter than the cable: no force at all
    FOLDED = 2  # exactly vertical and longer than its chord: hangs in a fold; forces are the limit x -> 0
    NOT_CONVERGED = 3
    TENSION_TOO_LOW = 4  # asked for a tension that the cable weight alone exceeds (`solve_length`)


@dataclass(frozen=True, slots=True, eq=False)
class CatenaryForces:
    """End forces of a batch of cables, all arrays of the same shape (...).

    force_x    : pull at the platform end, horizontal, away from the frame end, >= 0 [N]
    force_z    : pull at the platform end, upwards [N]; at the frame end the cable carries force_z - w L
    residual   : distance between the end point these forces give and the wanted one [m]
    iterations : of the scalar Newton
    status     : `CableStatus` values
    root       : p of the module docstring, zero where there is none: where the search begins `near` this answer
    """

    force_x: np.ndarray
    force_z: np.ndarray
    residual: np.ndarray
    iterations: np.ndarray
    status: np.ndarray
    root: np.ndarray

    @property
    def converged(self) -> np.ndarray:
        """(...) bool: the forces are an answer (folds and weightless slack cables included)."""
        return self.status != CableStatus.NOT_CONVERGED


@dataclass(frozen=True, slots=True, eq=False)
class _SpanEquation:
    """The scalar equation of the module docstring for a flat batch: ln(x(p) / x) = 0."""

    span: np.ndarray  # x/L, wanted
    rise: np.ndarray  # a = |z|/L
    omega: np.ndarray  # W / (2 EA)

    @property
    def lowest(self) -> np.ndarray:
        return np.maximum(self.omega, self.rise - 1.0)

    def take(self, index: np.ndarray) -> "_SpanEquation":
        return _SpanEquation(self.span[index], self.rise[index], self.omega[index])

    def value_and_slope(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """ln(x(p)/x) and its derivative with respect to ln p; every term of the slope is positive."""
        t, d_product, c_product, m = self._parts(p)
        one_t = 1.0 + t
        span = np.sqrt(d_product * c_product) / t * (1.0 + m / one_t)
        slope = t * (t + m) / (d_product * (one_t + m)) + self.rise**2 / (c_product * one_t)
        return np.log(span / self.span), p * slope

    def forces(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """fx/EA and |v|/EA."""
        lowest = self.lowest
        one_t = 1.0 + lowest + p
        d = (lowest - self.omega) + p
        c = (lowest - (self.rise - 1.0)) + p
        fx = np.sqrt(d * (d + 2.0 * self.omega) * c * (c + 2.0 * self.rise)) / one_t
        return fx, self.rise * (lowest + p) / one_t

    def _parts(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        lowest = self.lowest
        t = lowest + p
        d = (lowest - self.omega) + p
        c = (lowest - (self.rise - 1.0)) + p
        r = self.omega / t
        excess = r * r * atanhc_remainder(r, d / t)
        return t, d * (d + 2.0 * self.omega), c * (c + 2.0 * self.rise), excess

    def start(self) -> np.ndarray:
        """First p: the taut cable's cubic t^3 - (chord - 1) t^2 - kappa = 0, or the slack inextensible catenary."""
        chord = np.hypot(self.span, self.rise)
        excess = chord - 1.0
        kappa = (self.omega * self.span / chord) ** 2 / 6.0
        root = np.maximum(excess, np.cbrt(kappa))
        tiny = np.finfo(float).tiny
        for _ in range(3):
            value, slope = (root - excess) * root**2 - kappa, (3.0 * root - 2.0 * excess) * root
            root = np.maximum(root - value / np.maximum(slope, tiny), 0.2 * root)
        taut = np.maximum(root - self.lowest, 1e-3 * self.lowest)
        return np.where(excess < 0.0, np.minimum(taut, self._slack_start()), taut) + tiny

    def _slack_start(self) -> np.ndarray:
        """p = omega (coth q - 1) with sinh(q)/q = sqrt(1 - a^2)/span, both limits of the inverse joined."""
        ratio = np.sqrt(np.maximum(1.0 - self.rise**2, 0.0)) / self.span
        near = np.sqrt(6.0 * np.maximum(ratio - 1.0, 1e-16))
        log = np.log(np.maximum(2.0 * ratio, 4.0))
        q = np.where(ratio < 3.0, near, np.minimum(log + np.log(log), 350.0))
        return 2.0 * self.omega / np.expm1(2.0 * q)


def solve_end_forces(
    x: npt.ArrayLike,
    z: npt.ArrayLike,
    length: npt.ArrayLike,
    axial_stiffness: npt.ArrayLike,
    weight: npt.ArrayLike,
    near: CatenaryForces | None = None,
) -> CatenaryForces:
    """Forces at the ends of an elastic catenary through two given points.

    Parameters
    ----------
    x, z : (...) platform end relative to the frame end [m]; x horizontal, >= 0, z upwards
    length : (...) unstrained length L [m]
    axial_stiffness : (...) EA [N]
    weight : (...) w = mu g [N/m], >= 0
    near : answer (...) for cables nearly like these, to begin from: the same answer in fewer steps

    Returns
    -------
    CatenaryForces of the broadcast shape. A cable always has exactly one answer; `status` names the two
    where it is a limit (`FOLDED`, `WEIGHTLESS_SLACK`).

    Raises
    ------
    ValueError : an argument is not finite or out of range.

    Solves eqs. (2.11)-(2.12).
    """
    names = ("x", "z", "length", "axial_stiffness", "weight")
    given = (x, z, length, axial_stiffness, weight)
    arrays = np.broadcast_arrays(*(np.asarray(a, dtype=float) for a in given))
    shape = arrays[0].shape
    flat = [np.atleast_1d(a).reshape(-1) for a in arrays]
    _check(dict(zip(names, flat, strict=True)))
    guess = np.zeros_like(flat[0]) if near is None else np.broadcast_to(near.root, shape).reshape(-1)
    force_x, force_z, iterations, status, root = _solve_flat(*[*flat, guess])
    idle = status == CableStatus.WEIGHTLESS_SLACK
    reached_x, reached_z = end_point(force_x, np.where(idle, 1.0, force_z), *flat[2:])
    residual = np.where(idle, 0.0, np.hypot(reached_x - flat[0], reached_z - flat[1]))
    stuck = (residual > RESIDUAL_TOLERANCE * flat[2]) & (status == CableStatus.CONVERGED)
    status[stuck] = CableStatus.NOT_CONVERGED
    return CatenaryForces(*(a.reshape(shape) for a in (force_x, force_z, residual, iterations, status, root)))


def _check(given: dict[str, np.ndarray]) -> None:
    lowest = {"x": 0.0, "weight": 0.0, "length": np.finfo(float).tiny, "axial_stiffness": np.finfo(float).tiny}
    for name, values in given.items():
        wrong = ~np.isfinite(values) | (values < lowest.get(name, -np.inf))
        if wrong.any():
            least = {"z": "finite", "x": "finite and >= 0", "weight": "finite and >= 0"}.get(name, "finite and > 0")
            raise ValueError(f"{name} must be {least}, got {values[wrong][0]!r} ({int(wrong.sum())} such values)")


def _solve_flat(
    x: np.ndarray,
    z: np.ndarray,
    length: np.ndarray,
    axial_stiffness: np.ndarray,
    weight: np.ndarray,
    guess: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Forces, iterations, status and p of a flat batch, p begun from a guess where that is positive."""
    equation = _SpanEquation(x / length, np.abs(z) / length, 0.5 * weight * length / axial_stiffness)
    vertical = equation.span < _VERTICAL
    idle = (weight == 0.0) & (np.hypot(equation.span, equation.rise) <= 1.0)
    p = np.zeros_like(x)
    iterations = np.zeros(x.shape, dtype=int)
    regular = np.flatnonzero(~(vertical | idle))
    p[regular], iterations[regular] = _solve_span(equation.take(regular), guess[regular])
    fx, mean = np.zeros_like(x), np.zeros_like(x)
    loaded = np.flatnonzero(~idle)
    fx[loaded], mean[loaded] = equation.take(loaded).forces(p[loaded])
    fx[vertical] = 0.0
    force_z = np.where(idle, 0.0, np.copysign(mean, z) * axial_stiffness + 0.5 * weight * length)
    folded = vertical & ~idle & (equation.rise - 1.0 < equation.omega)
    status = np.full(x.shape, CableStatus.CONVERGED, dtype=int)
    status[idle] = CableStatus.WEIGHTLESS_SLACK
    status[folded] = CableStatus.FOLDED
    return fx * axial_stiffness, force_z, iterations, status, p


def _solve_span(equation: _SpanEquation, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Root p of the span equation by Newton in ln p, kept inside a shrinking bracket."""
    y = np.log(guess if (guess > 0.0).all() else np.where(guess > 0.0, guess, equation.start()))
    low, high = np.full_like(y, -700.0), np.full_like(y, 700.0)
    iterations = np.zeros(y.shape, dtype=int)
    open_items = np.arange(y.size)
    for count in range(1, MAX_ITERATIONS + 1):
        if not open_items.size:
            break
        here = y[open_items]
        value, slope = equation.take(open_items).value_and_slope(np.exp(here))
        low[open_items] = np.where(value <= 0.0, here, low[open_items])
        high[open_items] = np.where(value >= 0.0, here, high[open_items])
        step = np.clip(-value / np.maximum(slope, 1e-30), -8.0, 8.0)
        target = here + step
        middle = 0.5 * (low[open_items] + high[open_items])
        outside = (target <= low[open_items]) | (target >= high[open_items])
        done = (np.abs(value) <= 5e-16) | (np.abs(step) <= 4e-16 * (1.0 + np.abs(here)))
        y[open_items] = np.where(done, here, np.where(outside, middle, target))
        iterations[open_items] = count
        open_items = open_items[~done & (high[open_items] - low[open_items] > 1e-15 * (1.0 + np.abs(here)))]
    return np.exp(y), iterations

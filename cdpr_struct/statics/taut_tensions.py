"""Which tensions of least norm hold the platform, at thousands of poses at once, where every cable is taut?

Arrays are (cable, pose), so that every operation runs over long vectors. Unknowns of a cable are its chord tension
tau, with H = tau span / chord, the vertical pull V at mid-cable and its unstrained length L. With the end tensions
T0, T1 at V -+ w L / 2, S = T0 + T1 and q = w L / S the end-point equations (2.11)-(2.12) read

    x / H = L / EA + (2 L / S) artanh(q) / q,      z = V (L / EA + 2 L / S),

which lose no digits from taut to slack. One iteration takes a Newton step of (V, L) at every cable and one of the least
norm's conditions (a 6 x 6 system a pose) for all tau, both from one evaluation.

Bounds act as in an active-set method: cables that would pass one are fixed in it, one after the other, and freed once
the cost wants them inside. What this leaves to `HoldingProblem.solve`: poses at which a cable hangs slack
(tau < w L), the last step is not negligible or no set of bounds settles; pulleys, masts, fewer than six cables. A
pose's answer does not depend on those it is computed with.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.bounded_steps import EQUATIONS, StepProgram, least_norm
from cdpr_struct.statics.cable_models import SaggingModel
from cdpr_struct.statics.cable_response import let_out
from cdpr_struct.statics.cable_state import CableStates, heading_and_span
from cdpr_struct.statics.catenary import CableStatus
from cdpr_struct.statics.catenary_length import STEEPEST, force_z_curvature
from cdpr_struct.statics.holding_tensions import HoldingProblem

_ITERATIONS = 10
_NEGLIGIBLE = 1e-13  # of the largest tension: the step after the last, as the last two foretell it
_FOLLOWS = 30.0  # times the product of the last two, measured up to 22: multipliers lag one iteration behind
_CHUNK = 640
_ROUNDING = 1e-12  # of the tension: how far beyond its bound one may lie
_TAUTEST = 0.7  # of the weight of a straight cable: least chord tension to begin from
_RISING = 0.05  # least growth of the platform tension with the chord tension at which bounds are linearised
_CLOSED = 1e-7  # of the length: what the last step may close of the end-point equations; its square is left


@dataclass(frozen=True, slots=True, eq=False)
class TautTensions:
    """Cables of a batch and where they count.

    states     : `CableStates` (k, m)
    found      : (k,) bool, the answer counts: settled, within the bounds, all cables taut
    iterations : (k,)
    """

    states: CableStates
    found: np.ndarray
    iterations: np.ndarray

    @property
    def first(self) -> "TautTensions":
        """The first pose alone."""
        states = CableStates(*(getattr(self.states, name)[:1] for name in CableStates.__slots__))
        return TautTensions(states, self.found[:1], self.iterations[:1])


def suits(problem: HoldingProblem) -> bool:
    """Whether this batch may be tried."""
    arrays = problem.arrays
    plain = not (arrays.has_pulleys or arrays.has_masts)
    enough = arrays.cable_count >= EQUATIONS and len(problem.load) > 0
    return plain and enough and isinstance(problem.model, SaggingModel)


def taut_tensions(problem: HoldingProblem) -> TautTensions:
    """Least-norm tensions of a batch that `suits`."""
    count = len(problem.load)
    if count == 1:  # twice: sums over vectors of one are rounded otherwise
        return taut_tensions(problem.take(np.zeros(2, dtype=int))).first
    if count <= _CHUNK:
        with np.errstate(all="ignore"):
            return _solve(problem)
    parts = []
    for index in np.array_split(np.arange(count), -(-count // _CHUNK)):
        with np.errstate(all="ignore"):
            parts.append(_solve(problem.take(index)))
    names = CableStates.__slots__
    states = CableStates(*(np.concatenate([getattr(part.states, name) for part in parts]) for name in names))
    return TautTensions(
        states, np.concatenate([part.found for part in parts]), np.concatenate([part.iterations for part in parts])
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Geometry:
    """A batch, cables first: span, rise, chord, stiff (EA), weight (m, n); cos, sin of the chord's inclination.

    level, upright (6, m, n) wrenches of unit pulls along the heading and up on the platform ends, moments in units of
    `unit` (n,); load (6, n) alike; low, high (m, n) bounds on the tension at the platform.
    """

    span: np.ndarray
    rise: np.ndarray
    chord: np.ndarray
    stiff: np.ndarray
    weight: np.ndarray
    level: np.ndarray
    upright: np.ndarray
    load: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def columns(self, along: np.ndarray, up: np.ndarray) -> np.ndarray:
        """Wrenches (6, m, n) of pulls with horizontal (m, n) and vertical (m, n) parts on the cables' platform ends."""
        return along * self.level + up * self.upright


@dataclass(frozen=True, slots=True, eq=False)
class _Pull:
    """Cables at (tau, V, L): steps of V and L that close the end point, their rates with tau, all (m, n)."""

    vertical: np.ndarray
    length: np.ndarray
    vertical_rate: np.ndarray
    length_rate: np.ndarray


def _geometry(problem: HoldingProblem) -> tuple[_Geometry, np.ndarray, np.ndarray]:
    """The batch, and offsets (n, m, 3) and headings (n, m, 3) of its cables."""
    arrays, unit = problem.arrays, problem.unit
    offset = problem.arms.points - arrays.frame_anchors
    heading, span = heading_and_span(offset)
    shape = span.shape

    def first(value: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray((value if value.shape == shape else np.broadcast_to(value, shape)).T)

    rise = first(offset[..., 2])
    chord = np.hypot(first(span), rise)
    a, b, c = (first(problem.arms.arms[..., i]) / unit[:, 3] for i in range(3))
    (x, y), one, none = (-first(heading[..., i]) for i in range(2)), np.ones(chord.shape), np.zeros(chord.shape)
    pose = _Geometry(
        np.maximum(first(span), STEEPEST * chord), rise, chord, first(arrays.axial_stiffness), first(arrays.weight),
        np.stack([x, y, none, -c * y, c * x, a * y - b * x]), np.stack([none, none, -one, -b, a, none]),
        np.ascontiguousarray((problem.load / unit).T),
        first(problem.low), first(problem.high),
    )  # fmt: skip
    return pose, offset, heading


def _closed(pose: _Geometry, tau: np.ndarray, vertical: np.ndarray, length: np.ndarray) -> _Pull:
    """One Newton step of the end-point equations, and the rates with tau, at (tau, V, L)."""
    cos = pose.span / pose.chord
    h, half = tau * cos, 0.5 * pose.weight * length
    v0, v1 = vertical - half, vertical + half
    t0, t1 = np.sqrt(h * h + v0 * v0), np.sqrt(h * h + v1 * v1)
    total = t0 + t1
    q = 2.0 * half / total
    share0, share1 = v0 / t0, v1 / t1
    slope = share0 + share1
    total_l = 0.5 * pose.weight * (share1 - share0)
    reach = 2.0 * length / total
    spread = reach / (1.0 - q * q)
    error_x = length / pose.stiff + reach * np.arctanh(q) / q - pose.chord / tau
    give = length / pose.stiff + reach
    error_z = vertical * give - pose.rise
    x_v, x_l = -spread * slope / total, 1.0 / pose.stiff + spread * (1.0 / length - total_l / total)
    give_v, give_l = -reach * slope / total, 1.0 / pose.stiff + 2.0 / total - reach * total_l / total
    z_v, z_l = give + vertical * give_v, vertical * give_l
    rising = h * (1.0 / t0 + 1.0 / t1) / total * cos
    x_t, z_t = pose.chord / tau**2 - spread * rising, -vertical * reach * rising
    determinant = x_v * z_l - x_l * z_v
    return _Pull(
        (x_l * error_z - z_l * error_x) / determinant, (z_v * error_x - x_v * error_z) / determinant,
        (x_l * z_t - z_l * x_t) / determinant, (z_v * x_t - x_v * z_t) / determinant,
    )  # fmt: skip


def _solve(problem: HoldingProblem) -> TautTensions:
    pose, offset, heading = _geometry(problem)
    along, vertical, length, good, iterations = _iterated(pose)
    states = _states(problem, pose, (offset, heading), along, vertical, length)
    return TautTensions(states, good & _inside(problem, states), iterations)


def _iterated(pose: _Geometry) -> tuple[np.ndarray, ...]:
    """H, V, L (m, n); settled with all cables taut (n,) and iterations (n,)."""
    cos = pose.span / pose.chord
    tau, vertical, length, side, settled, dual = _start(pose, cos)
    first = _closed(pose, tau, vertical, length)
    vertical, length = vertical + first.vertical, length + first.length
    bend = force_z_curvature(pose.span, pose.rise, tau, pose.weight)
    good, error = ~settled, np.full_like(tau, np.inf)
    before, iterations = np.zeros(len(settled)), np.zeros(len(settled), dtype=int)
    for _ in range(_ITERATIONS):
        pull, moving = _closed(pose, tau, vertical, length), ~settled
        vertical, length = vertical + moving * pull.vertical, length + moving * pull.length
        error = np.where(moving, pull.length, error)
        step, dual, after = least_norm(_program(pose, pull, (tau, vertical, length), bend, dual), side)
        step = np.where(moving, np.maximum(step, -0.5 * tau), 0.0)
        tau = tau + step
        vertical, length = vertical + pull.vertical_rate * step, length + pull.length_rate * step
        iterations += moving
        size = np.abs(step).max(axis=0) / tau.max(axis=0)
        small = size * np.fmin(np.fmax(size / before, _FOLLOWS * before), 1.0) <= _NEGLIGIBLE
        settled = settled | (small & (after == side).all(axis=0))
        before, side = size, after
        if settled.all():
            break
    taut = (np.abs(error) <= _CLOSED * length) & (tau >= pose.weight * length)
    return tau * cos, vertical, length, settled & good & taut.all(axis=0), iterations


def _start(pose: _Geometry, cos: np.ndarray) -> tuple[np.ndarray, ...]:
    """tau, V, L of straight cables (m, n) with half of their weight at each end, parabolas in length, their bounds'
    sides, and where there are none (n,)."""
    ones, sin = np.ones_like(cos), pose.rise / pose.chord
    low = np.maximum(pose.low, _TAUTEST * pose.weight * pose.chord)
    half = 0.5 * pose.weight * pose.chord
    left = pose.load + pose.columns(np.zeros_like(cos), half).sum(axis=1)
    program = StepProgram(ones, half * sin, pose.columns(cos, sin), left, low, np.maximum(pose.high, low))
    tau, dual, side = least_norm(program, np.zeros(cos.shape, dtype=int))
    hopeless = ~np.isfinite(tau).all(axis=0)
    tau = np.where(hopeless, low, np.clip(tau, low, program.high))
    length = pose.chord / (1.0 + tau / pose.stiff) * (1.0 + (pose.weight * pose.span / tau) ** 2 / 24.0)
    return tau, tau * sin, length, side, hopeless, dual


def _program(
    pose: _Geometry, pull: _Pull, cable: tuple[np.ndarray, np.ndarray, np.ndarray], bend: np.ndarray, dual: np.ndarray
) -> StepProgram:
    """The quadratic program around cables (tau, V, L) with closed end points, and multipliers (6, n)."""
    tau, vertical, length = cable
    cos = pose.span / pose.chord
    top = vertical + 0.5 * pose.weight * length
    rate = pull.vertical_rate + 0.5 * pose.weight * pull.length_rate
    up = dual[2] - dual[3] * pose.upright[3] - dual[4] * pose.upright[4]
    first, gradient = cos * cos + rate * rate, tau * cos * cos + top * rate
    curvature = np.maximum(first + (top + up) * bend, 0.1 * first)
    left = pose.columns(tau * cos, top).sum(axis=1) + pose.load
    tension = np.hypot(tau * cos, top)
    pace = tension / np.where(gradient > _RISING * tension, gradient, np.nan)
    low, high = ((bound - tension) * pace for bound in (pose.low, pose.high))
    return StepProgram(curvature, gradient, pose.columns(cos, rate), left, low, high)


def _inside(problem: HoldingProblem, states: CableStates) -> np.ndarray:
    """(n,) bool: within the bounds but for rounding."""
    pull = states.tension_at_platform
    margin = _ROUNDING * pull
    inside = (pull >= problem.low - margin) & (pull <= problem.high + margin)
    return np.asarray(inside.all(axis=1))


def _states(
    problem: HoldingProblem,
    pose: _Geometry,
    directions: tuple[np.ndarray, np.ndarray],
    along: np.ndarray,
    vertical: np.ndarray,
    length: np.ndarray,
) -> CableStates:
    half = 0.5 * pose.weight * length
    bottom = np.hypot(along, vertical - half).T
    none, stiff = np.zeros(bottom.shape), pose.stiff.T
    passed = np.broadcast_to(let_out(problem.arrays, bottom, stiff), none.shape)
    status = np.full(none.shape, CableStatus.CONVERGED, dtype=int)
    return CableStates(*directions, length.T, none, along.T, (vertical + half).T, stiff, pose.weight.T, status, passed)

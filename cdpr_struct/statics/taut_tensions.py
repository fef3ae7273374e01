"""Which tensions of least norm hold the platform, at thousands of poses at once, where every cable is taut?

Arrays are (cable, pose), so that every operation runs over long vectors; unknowns of a cable are its chord tension tau,
the vertical pull V at mid-cable and its unstrained length L (`closed_cables.py`).

One iteration takes a Newton step of (V, L) at every cable and one of the least
norm's conditions (a 6 x 6 system a pose) for all tau, both from one evaluation. A cable on a pulley then leaves it
where its tension at the frame now points; the conditions have the exact rates with moving exits.

Bounds act as in an active-set method: cables that would pass one are fixed in it, one after the other, and freed once
the cost wants them inside. What this leaves to `HoldingProblem.solve`: poses at which a cable hangs slack
(tau < w L), the last step is not negligible or no set of bounds settles; masts, guides, wind on cables, tilted or no
gravity, fewer than six cables. A pose's answer does not depend on those it is computed with.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.bounded_steps import EQUATIONS, StepProgram, least_norm
from cdpr_struct.statics.cable_models import SaggingModel
from cdpr_struct.statics.cable_response import let_out
from cdpr_struct.statics.cable_state import STEEPEST, CableStates, heading_and_span
from cdpr_struct.statics.catenary import CableStatus
from cdpr_struct.statics.catenary_length import force_z_curvature
from cdpr_struct.statics.closed_cables import Rates, TautGeometry, closing_step
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.pulley_exits import MovingExits, PulleyExits

_ITERATIONS = 10
_NEGLIGIBLE = 1e-13  # of the largest tension: the step after the last, as the last two foretell it
_FOLLOWS = 30.0  # times the product of the last two, measured up to 22: multipliers lag one iteration behind
_ITERATIONS_OVER_PULLEYS = 16
_SLOWEST = 1e-2  # by so much a step over pulleys is expected to shrink at most: where bounds act they shrink evenly
_CHUNK = 640
_ROUNDING = 1e-12  # of the tension: how far beyond its bound one may lie
_TAUTEST = 0.7  # of the weight of a straight cable: least chord tension to begin from
_RISING = 0.05  # least growth of the platform tension with the chord tension at which bounds are linearised
_CLOSED = 1e-7  # of the length: what the last step may close of the end-point equations; its square is left


Cable = tuple[np.ndarray, np.ndarray, np.ndarray]
"""tau, V and L, all (m, n)."""


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
    enough = arrays.cable_count >= EQUATIONS and len(problem.load) > 0
    other = arrays.is_tilted or arrays.is_weightless or arrays.has_tension_winches or arrays.has_cable_drag
    return (
        not (arrays.has_masts or arrays.has_guides or arrays.has_lumps or other)
        and enough
        and isinstance(problem.model, SaggingModel)
    )


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


def _geometry(problem: HoldingProblem) -> TautGeometry:
    """Of cables that start at the frame anchors."""
    arrays, unit = problem.arrays, problem.unit
    offset = problem.arms.points - arrays.frame_anchors
    heading, span = heading_and_span(offset)

    def first(value: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray((value if value.shape == span.shape else np.broadcast_to(value, span.shape)).T)

    along, rise = first(span), first(offset[..., 2])
    chord = np.hypot(along, rise)
    return TautGeometry(
        offset=np.stack([first(offset[..., 0]), first(offset[..., 1]), rise]),
        span=np.maximum(along, STEEPEST * chord),
        rise=rise,
        chord=chord,
        stiff=first(arrays.axial_stiffness),
        weight=first(arrays.weight),
        heading=np.stack([first(heading[..., i]) for i in range(2)]),
        arm=np.stack([first(problem.arms.arms[..., i]) for i in range(3)]) / unit[:, 3],
        load=np.ascontiguousarray((problem.load / unit).T),
        low=first(problem.low),
        high=first(problem.high),
    )


def _solve(problem: HoldingProblem) -> TautTensions:
    pose = _geometry(problem)
    exits = PulleyExits.of(problem.arrays, pose)
    pose, cable, good, iterations = _iterated(pose if exits is None else exits.straight(pose), exits)
    states = _states(problem, pose, exits, cable)
    return TautTensions(states, good & _inside(problem, states), iterations)


def _iterated(pose: TautGeometry, exits: PulleyExits | None) -> tuple[TautGeometry, Cable, np.ndarray, np.ndarray]:
    """The cables' geometry; tau, V, L (m, n); settled with all cables taut (n,) and iterations (n,)."""
    tau, vertical, length, side, settled, dual = _start(pose, pose.span / pose.chord)
    first = closing_step(pose, tau, vertical, length)
    vertical, length = vertical + first.vertical, length + first.length
    bend = force_z_curvature(pose.span, pose.rise, tau, pose.weight)
    good, error = ~settled, np.full_like(tau, np.inf)
    before, iterations = np.zeros(len(settled)), np.zeros(len(settled), dtype=int)
    for _ in range(_ITERATIONS if exits is None else _ITERATIONS_OVER_PULLEYS):
        pull, moving = closing_step(pose, tau, vertical, length), ~settled
        vertical, length = vertical + moving * pull.vertical, length + moving * pull.length
        error = np.where(moving, pull.length, error)
        cable = tau, vertical, length
        exit_ = None if exits is None else MovingExits.at(exits, pose, pull, cable)
        rates = Rates.from_fixed(pose, pull) if exit_ is None else exit_.rates
        step, dual, after = least_norm(_program(pose, rates, cable, bend, dual), side)
        step = np.where(moving, np.maximum(step, -0.5 * tau), 0.0)
        vertical, length = vertical + rates.vertical * step, length + rates.length * step
        size = np.abs(step).max(axis=0) / (tau + step).max(axis=0)
        if exit_ is not None:
            pose, moved = exit_.placed(rates, step, moving)
            size = np.maximum(size, moved)
        tau = tau + step
        iterations += moving
        slowest = _FOLLOWS * before if exits is None else _SLOWEST
        small = size * np.fmin(np.fmax(size / before, slowest), 1.0) <= _NEGLIGIBLE
        settled = settled | (small & (after == side).all(axis=0))
        before, side = size, after
        if settled.all():
            break
    taut = (np.abs(error) <= _CLOSED * length) & (tau >= pose.weight * length)
    return pose, (tau, vertical, length), settled & good & taut.all(axis=0), iterations


def _start(pose: TautGeometry, cos: np.ndarray) -> tuple[np.ndarray, ...]:
    """tau, V, L of straight cables (m, n) with half of their weight at each end, parabolas in length, their bounds'
    sides, and where there are none (n,)."""
    ones, sin = np.ones_like(cos), pose.rise / pose.chord
    low = np.maximum(pose.low, _TAUTEST * pose.weight * pose.chord)
    matrix = pose.columns(pose.pulls(cos, None, sin))
    half, none = 0.5 * pose.weight * pose.chord, np.zeros_like(cos)
    left = pose.load + pose.columns(pose.pulls(none, None, half)).sum(axis=1)
    program = StepProgram(ones, half * sin, matrix, left, low, np.maximum(pose.high, low))
    tau, dual, side = least_norm(program, np.zeros(cos.shape, dtype=int))
    hopeless = ~np.isfinite(tau).all(axis=0)
    tau = np.where(hopeless, low, np.clip(tau, low, program.high))
    length = pose.chord / (1.0 + tau / pose.stiff) * (1.0 + (pose.weight * pose.span / tau) ** 2 / 24.0)
    return tau, tau * sin, length, side, hopeless, dual


def _program(pose: TautGeometry, rates: Rates, cable: Cable, bend: np.ndarray, dual: np.ndarray) -> StepProgram:
    """The quadratic program around cables (tau, V, L) with closed end points, and multipliers (6, n)."""
    tau, vertical, length = cable
    level = tau * (pose.span / pose.chord)
    top = vertical + 0.5 * pose.weight * length
    up = dual[2] + dual[3] * pose.arm[1] - dual[4] * pose.arm[0]
    first = rates.along**2 + rates.up**2
    if rates.across is not None:
        first = first + rates.across**2
    gradient = level * rates.along + top * rates.up
    curvature = np.maximum(first + (top + up) * bend, 0.1 * first)
    left = pose.columns(pose.pulls(level, None, top)).sum(axis=1) + pose.load
    tension = np.hypot(level, top)
    pace = tension / np.where(gradient > _RISING * tension, gradient, np.nan)
    low, high = ((bound - tension) * pace for bound in (pose.low, pose.high))
    matrix = pose.columns(pose.pulls(rates.along, rates.across, rates.up))
    return StepProgram(curvature, gradient, matrix, left, low, high)


def _inside(problem: HoldingProblem, states: CableStates) -> np.ndarray:
    """(n,) bool: within the bounds but for rounding."""
    pull = states.tension_at_platform
    margin = _ROUNDING * pull
    inside = (pull >= problem.low - margin) & (pull <= problem.high + margin)
    return np.asarray(inside.all(axis=1))


def _states(problem: HoldingProblem, pose: TautGeometry, exits: PulleyExits | None, cable: Cable) -> CableStates:
    tau, vertical, length = cable
    level, half = tau * (pose.span / pose.chord), 0.5 * pose.weight * length
    bottom, stiff = np.hypot(level, vertical - half).T, pose.stiff.T
    wrapped = np.zeros(bottom.shape)
    if exits is not None:
        wrapped = exits.leaving(pose.pulls(level, None, vertical - half))[1].T / (1.0 + bottom / stiff)
    passed = np.broadcast_to(let_out(problem.arrays, bottom, stiff), bottom.shape)
    status = np.full(bottom.shape, CableStatus.CONVERGED, dtype=int)
    offset = np.moveaxis(pose.offset, (2, 1, 0), (0, 1, 2))
    heading = np.stack([*(part.T for part in pose.heading), np.zeros(bottom.shape)], axis=-1)
    pull = level.T, (vertical + half).T
    return CableStates(
        np.ascontiguousarray(offset), heading, length.T, wrapped, *pull, stiff, pose.weight.T, status, passed
    )

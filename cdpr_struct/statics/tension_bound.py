"""Bounds on cables as bounds on their chord tension.

At a fixed pose a cable is a one-parameter family in its chord tension tau. On its taut side the tension at the platform
rises with tau and the unstrained length falls, so "at least this tension", "at least this tension for its length"
(5.15) and "at most this length" (5.8) each say tau >= a number that is found cable by cable, before any optimisation.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.generated.tension_bound import lower_bound_printed
from cdpr_struct.statics.cable_models import HeldCables
from cdpr_struct.statics.cable_state import CableStates, span_and_rise
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.lost_cables import lost as without_state
from cdpr_struct.statics.unholdable_poses import behind_wheels, half_turn_error

MAX_ITERATIONS = 60
_MISSED = 1e-6  # relative step above which the tension was not found
_NOTHING = 1e-9  # of the first guess: less than this is no tension, to which weightless cables fall
_NEWTON = 20  # steps, after which the interval is halved
_EDGE = 1e-3  # relative, to which the least chord tension that has a state is found
_MET = 1e-9  # relative step after which the next one would be below rounding
_BISECTIONS = 12
_TURNING = 0.02  # least growth of the tension with the chord tension that still counts as the taut side

Wanted = Callable[[CableStates], np.ndarray]
"""Tension at the platform (k, m) [N] that cables in these states ought to have."""


def printed_bound(problem: HoldingProblem, b: float) -> Wanted:
    """Lower bound (5.15) as printed: b^2 / pi^2 times the weight of the unstrained cable.

    b : [rad/s], taken as a pure number: (5.10) lacks a unit. The cable's true frequency is b at a length of g metres
    and lower for longer cables.
    """
    gravity = np.broadcast_to(problem.arrays.gravity, problem.load.shape[:1])[:, None]
    density = problem.arrays.linear_density
    return lambda states: lower_bound_printed(b, density, gravity, states.total_length)


def constant(force: np.ndarray | float) -> Wanted:
    """The same tension whatever the state; (k, m) or a number [N]."""
    return lambda states: np.broadcast_to(np.asarray(force, dtype=float), states.length.shape)


def chord_tension_at(problem: HoldingProblem, wanted: Wanted) -> tuple[np.ndarray, np.ndarray]:
    """Chord tension at which each cable pulls as wanted, on its taut side.

    Newton from the taut side, where the tension is a rising convex function of the chord tension, or nearly so over
    pulleys. Where it leaves what lies between a chord tension that pulls too little and one that pulls too much, this
    interval is halved. A cable that would leave its pulley straight back has no state below some chord tension, and
    one that ends behind its wheel, when pulled straight, none above some: that one counts then.

    Returns
    -------
    chord_tension, tension : (k, m) [N], and the tension at the platform there. Where the cable's own weight makes it
    pull harder than wanted at any length, they are those of (nearly) its least tension; where it ends behind its wheel
    and cannot pull as wanted, those of (nearly) its largest.
    """
    behind = behind_wheels(problem.arrays, problem.arms.points)
    least = problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    tau = np.maximum(6.0 * least, 1.0)
    tau = np.maximum(tau, _shallow_guess(problem, wanted(_held(problem, tau).states)))
    lost, nothing = np.zeros(tau.shape, dtype=bool), _NOTHING * tau
    between = _Interval(least, np.full(tau.shape, np.inf), lost, lost)
    for round_ in range(MAX_ITERATIONS):
        held = _held(problem, tau)
        pull, growth = _pull_and_growth(held)
        bare = without_state(held.states)
        short = np.where(bare, np.where(behind, -np.inf, np.inf), wanted(held.states) - pull)
        lost = lost | ((growth < _TURNING) & (short < 0.0) & ~bare)
        between = between.narrowed(tau, np.where(lost, 0.0, short), bare)
        step = np.clip(short / np.maximum(growth, _TURNING), -0.6 * tau, 2.0 * tau + np.abs(pull))
        step = np.where(lost, 0.0, np.maximum(step, least - tau))
        step = between.kept(tau, step, round_ >= _NEWTON)
        tau, pull = tau + step, pull + growth * step
        if (np.abs(step) <= _MET * tau).all():
            break
    else:
        _require_met(float((np.abs(step) / np.maximum(tau, nothing)).max()))
    if lost.any() or between.at_edge.any():
        tau = np.where(lost, _turning_point(problem, tau), np.where(between.at_edge, between.edge, tau))
        pull = _held(problem, tau).states.tension_at_platform
    return tau, pull


def floor_at(problem: HoldingProblem, wanted: Wanted) -> tuple[np.ndarray, np.ndarray]:
    """`chord_tension_at` of a lower bound.

    Raises
    ------
    UnholdablePoseError : a cable behind its wheel cannot pull as hard.
    """
    tau, pull = chord_tension_at(problem, wanted)
    behind = behind_wheels(problem.arrays, problem.arms.points)
    if behind.any():
        asked = wanted(_held(problem, tau).states)
        short = behind & (pull < asked * (1.0 - _MISSED))
        if short.any():
            raise half_turn_error(problem.arrays, short)
    return tau, pull


@dataclass(frozen=True, slots=True, eq=False)
class _Interval:
    """Chord tensions (k, m) [N] that pull too little and too much, and whether the cable has no state there."""

    low: np.ndarray
    high: np.ndarray
    bare_low: np.ndarray
    bare_high: np.ndarray

    @property
    def at_edge(self) -> np.ndarray:
        """(k, m) bool: between the two, which are nearly alike, the cable begins or ends to have a state."""
        return np.asarray((self.bare_low | self.bare_high) & (self.high <= (1.0 + _EDGE) * self.low))

    @property
    def edge(self) -> np.ndarray:
        """(k, m) the one of the two at which it has one."""
        return np.where(self.bare_low, self.high, self.low)

    def narrowed(self, tau: np.ndarray, short: np.ndarray, bare: np.ndarray) -> "_Interval":
        """With what is `short` [N] at `tau` taken into account."""
        more, less = short > 0.0, short < 0.0
        return _Interval(
            np.where(more, tau, self.low),
            np.where(less, tau, self.high),
            np.where(more, bare, self.bare_low),
            np.where(less, bare, self.bare_high),
        )

    def kept(self, tau: np.ndarray, step: np.ndarray, halving: bool) -> np.ndarray:
        """The step (k, m), or if it leads out of the interval, or they are halved, the one to its middle."""
        out = (tau + step < self.low) | (tau + step > self.high) | halving
        out &= np.isfinite(self.high) & (np.abs(step) > _MET * tau)
        middle = np.sqrt(self.low * np.where(out, self.high, 1.0))
        return np.where(self.at_edge, 0.0, np.where(out, middle - tau, step))


def _require_met(missed: float) -> None:
    if missed > _MISSED:
        hint = "The bound on the cable forces may be out of reach of some cable; try another one."
        raise ConvergenceError("chord tension at the bound of the cable forces", missed, MAX_ITERATIONS, hint)


def _shallow_guess(problem: HoldingProblem, tension: np.ndarray) -> np.ndarray:
    """(k, m) chord tension of a shallow cable that pulls with `tension` [N] at the platform."""
    offset = problem.arms.points - problem.arrays.frame_anchors
    load, up = problem.arrays.cable_load(offset)
    half, (span, rise) = 0.5 * load, span_and_rise(offset, up)
    guess: np.ndarray = np.sqrt(np.maximum(tension**2 - (half * span) ** 2, 0.0)) - half * rise
    return guess


def _turning_point(problem: HoldingProblem, slack: np.ndarray) -> np.ndarray:
    """(k, m) chord tension just on the taut side of each cable's least tension; `slack` lies on the other side."""
    low = slack
    high = np.maximum(3.0 * low, 6.0 * problem.model.least_chord_tension(problem.arrays, problem.arms.points))
    for _ in range(_BISECTIONS):
        middle = np.sqrt(low * high)
        _, growth = _pull_and_growth(_held(problem, middle))
        low, high = np.where(growth < _TURNING, middle, low), np.where(growth < _TURNING, high, middle)
    return high


def chord_tension_at_length(problem: HoldingProblem, longest: np.ndarray | float) -> np.ndarray:
    """(k, m) chord tension [N] at which each cable is just `longest` [m] long, unstrained; 0 where it is not needed."""
    length = np.broadcast_to(np.asarray(longest, dtype=float), problem.arms.points.shape[:-1])
    tension = problem.model.states(problem.arrays, problem.arms.points, length).tension
    return np.where(np.isfinite(tension), tension, 0.0)


def _held(problem: HoldingProblem, tau: np.ndarray) -> HeldCables:
    return problem.model.hold(problem.arrays, problem.arms.points, tau)


def _pull_and_growth(held: HeldCables) -> tuple[np.ndarray, np.ndarray]:
    pull = held.states.tension_at_platform
    force = held.states.force_on_platform
    return pull, (force * held.force_rate).sum(axis=-1) / np.maximum(pull, 1e-300)

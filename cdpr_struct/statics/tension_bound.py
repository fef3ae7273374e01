"""Bounds on cables as bounds on their chord tension.

At a fixed pose a cable is a one-parameter family in its chord tension tau. On its taut side the tension at the platform
rises with tau and the unstrained length falls, so "at least this tension", "at least this tension for its length"
(5.15) and "at most this length" (5.8) each say tau >= a number that is found cable by cable, before any optimisation.
"""

from collections.abc import Callable

import numpy as np

from cdpr_struct.errors import ConvergenceError
from cdpr_struct.generated.tension_bound import lower_bound_printed
from cdpr_struct.statics.cable_models import HeldCables
from cdpr_struct.statics.cable_state import CableStates, span_and_rise
from cdpr_struct.statics.holding_tensions import HoldingProblem

MAX_ITERATIONS = 60
_MISSED = 1e-6  # relative step above which the tension was not found
_NOTHING = 1e-9  # of the first guess: less than this is no tension, to which weightless cables fall
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

    Newton from the taut side, where the tension is a rising convex function of the chord tension.

    Returns
    -------
    chord_tension, tension : (k, m) [N], and the tension at the platform there. Where the cable's own weight makes it
    pull harder than wanted at any length, they are those of (nearly) its least tension.
    """
    least = problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    tau = np.maximum(6.0 * least, 1.0)
    tau = np.maximum(tau, _shallow_guess(problem, wanted(_held(problem, tau).states)))
    lost, nothing = np.zeros(tau.shape, dtype=bool), _NOTHING * tau
    for _ in range(MAX_ITERATIONS):
        held = _held(problem, tau)
        pull, growth = _pull_and_growth(held)
        short = wanted(held.states) - pull
        lost |= (growth < _TURNING) & (short < 0.0)
        step = np.clip(short / np.maximum(growth, _TURNING), -0.6 * tau, 2.0 * tau + np.abs(pull))
        step = np.where(lost, 0.0, np.maximum(step, least - tau))
        tau, pull = tau + step, pull + growth * step
        if (np.abs(step) <= _MET * tau).all():
            break
    else:
        missed = float((np.abs(step) / np.maximum(tau, nothing)).max())
        if missed > _MISSED:
            hint = "The bound on the cable forces may be out of reach of some cable; try another one."
            raise ConvergenceError("chord tension at the bound of the cable forces", missed, MAX_ITERATIONS, hint)
    if lost.any():
        tau = np.where(lost, _turning_point(problem, tau), tau)
        pull = _held(problem, tau).states.tension_at_platform
    return tau, pull


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

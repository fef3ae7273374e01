"""The lowest natural frequency of each clamped cable, and the tension that brings it to a wanted value.

Exact for the linearised elastic catenary (any sag and inclination, tension varying along the cable), for as many
cables as there are in one go; it lies out of the cable's plane, as `lowest_clamped` shows. A cable on a pulley is taken
as held where it leaves the pulley.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

from cdpr_struct.dynamics.cable_dynamics import flattened
from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate
from cdpr_struct.dynamics.lowest_clamped import lowest_clamped
from cdpr_struct.dynamics.lowest_eigenvalue import lowest_eigenvalue
from cdpr_struct.dynamics.polynomial_basis import polynomial_basis
from cdpr_struct.dynamics.stiff_cable import bending_factor, load_factor, slenderness
from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.holding_tensions import HoldingProblem

MAX_ITERATIONS = 40
_TAUT_ORDER = 10
_SLACK_ORDERS = ((1.0, 10), (3.0, 12), (6.0, 16), (np.inf, 20))  # polynomials up to a hyperbolic angle: 1e-13
_ROUGH_ORDER = 6  # 1e-4 at an angle of 6, 1e-7 at 1
_SLACK = 0.3  # weight over twice the chord tension from which polynomials of the arc length no longer do
_CHUNK = 1024
_SLACK_NUMBERS = 1 << 17  # of the matrices of a chunk of slack cables, so that they fit the processor's memory
_MET, _NEARLY_MET = 1e-10, 1e-4
_ROUNDING = 1e-12  # steps of ln tau too small to tell a slope
SAFE = 1.0 + 1e-9  # the bound is met with this margin, so that rounding does not undercut it


def fundamental_frequency(
    cables: CableStates, linear_density: np.ndarray, extensions: Extensions | None = None
) -> np.ndarray:
    """Lowest natural frequency of cables with both ends held.

    Parameters
    ----------
    cables : CableStates (..., m), all pulling
    linear_density : (m,) or (..., m) mu [kg/m]
    extensions : of the robot; bending stiffness and added masses act, as on a taut string

    Returns
    -------
    (..., m) [rad/s].
    """
    return _frequencies(cables, linear_density) * _extra_factor(cables, linear_density, extensions)


def _extra_factor(cables: CableStates, density: np.ndarray, extensions: Extensions | None) -> np.ndarray | float:
    if extensions is None or not {"bending_stiffness", "added_mass"} & set(extensions.active):
        return 1.0
    slender = slenderness(extensions.bending_stiffness, cables.tension, cables.chord)
    load = load_factor(extensions.added_mass, density * cables.length, 1, extensions.added_mass_place)
    return np.asarray(bending_factor(slender, 1, extensions.bending_fixity) / np.sqrt(load))


def chord_tension_at_frequency(
    problem: HoldingProblem, linear_density: np.ndarray, b: float, extensions: Extensions | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Chord tension (k, m) [N] at which the lowest frequency of each cable is b [rad/s], and its platform tension [N].

    The frequency goes with the root of the tension but for a few per cent; a secant on that ratio takes out the rest.
    """
    least = problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    chord = np.linalg.norm(problem.arms.points - problem.arrays.frame_anchors, axis=-1)
    tau = np.maximum(linear_density * (b * chord / np.pi) ** 2, 2.0 * least)
    search = TensionSearch(problem, linear_density, b * SAFE, extensions)
    tau, slope = search.meet(tau, np.ones(tau.shape), rough=True)
    tau, _ = search.meet(tau, slope)
    return tau, problem.model.hold(problem.arrays, problem.arms.points, tau).states.tension_at_platform


@dataclass(frozen=True, slots=True, eq=False)
class TensionSearch:
    """Secant steps at the instants at which a cable is not at the frequency b yet; one that needs less than its least
    tension is."""

    problem: HoldingProblem
    density: np.ndarray
    b: float
    extensions: Extensions | None

    def meet(self, tau: np.ndarray, slope: np.ndarray, rough: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Chord tensions (k, m) [N] and the slopes of ln omega^2 over ln tau there, from first guesses of both.

        rough : with few polynomials, to where the frequencies of more of them differ

        Raises
        ------
        ConvergenceError : a cable's tension is not found.
        """
        tau, slope, problem, met = tau.copy(), slope.copy(), self.problem, _NEARLY_MET if rough else _MET
        least = np.broadcast_to(problem.model.least_chord_tension(problem.arrays, problem.arms.points), tau.shape)
        old, old_ratio = np.full(tau.shape, np.nan), np.full(tau.shape, np.nan)
        rows = np.arange(len(tau))
        for _ in range(MAX_ITERATIONS):
            states = problem.model.hold(problem.arrays, problem.arms.points[rows], tau[rows]).states
            frequency = _frequencies(states, self.density, rough) * _extra_factor(states, self.density, self.extensions)
            ratio = 2.0 * np.log(frequency / self.b)
            open_ = (np.abs(ratio) > met) & ((ratio < 0.0) | (tau[rows] > least[rows]))
            rows, ratio = rows[open_.any(axis=1)], ratio[open_.any(axis=1)]
            if not rows.size:
                return tau, slope
            place = np.log(tau[rows])
            slope[rows] = _secant(slope[rows], place - old[rows], ratio - old_ratio[rows])
            old[rows], old_ratio[rows] = place, ratio
            tau[rows] = np.maximum(tau[rows] * np.exp(np.clip(-ratio / slope[rows], -1.0, 1.0)), least[rows])
        hint = "The wanted frequency may be out of reach of some cable; try another --b."
        raise ConvergenceError(
            "tension at the wanted cable frequency", float(np.abs(ratio).max()), MAX_ITERATIONS, hint
        )


def _secant(known: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """Slopes from two places; those known before where there was no step, or none of use."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(np.abs(moved) > _ROUNDING, np.clip(changed / moved, 0.3, 3.0), known)


def _frequencies(cables: CableStates, linear_density: np.ndarray, rough: bool = False) -> np.ndarray:
    """(..., m) [rad/s]; rough: with few polynomials where a cable hangs slack."""
    shape = cables.length.shape
    flat = flattened(cables)
    density = np.broadcast_to(linear_density, shape).reshape(-1)
    frequency = np.full(density.shape, np.nan)
    half = 0.5 * flat.weight * flat.length
    taut = half <= _SLACK * np.hypot(flat.force_x, flat.force_z - half)
    for own in _chunks(np.flatnonzero(taut), _CHUNK):
        frequency[own] = np.sqrt(_of_taut(flat.at(own), density[own]))
    for order, members in _by_order(flat, np.flatnonzero(np.isnan(frequency)), rough):
        for own in _chunks(members, _SLACK_NUMBERS // order**2):
            frequency[own] = np.sqrt(_of_slack(flat.at(own), density[own], order))
    return frequency.reshape(shape)


def _chunks(members: np.ndarray, size: int) -> list[np.ndarray]:
    return [members[i : i + size] for i in range(0, len(members), size)]


def _by_order(cables: CableStates, slack: np.ndarray, rough: bool) -> list[tuple[int, np.ndarray]]:
    """Orders of polynomials, and the slack cables (of those numbers) that need them."""
    if rough or not slack.size:
        return [(_ROUGH_ORDER, slack)]
    wanted = np.searchsorted([angle for angle, _ in _SLACK_ORDERS], CatenaryCoordinate.of(cables.at(slack)).angle)
    return [(order, slack[wanted == i]) for i, (_, order) in enumerate(_SLACK_ORDERS)]


def _of_taut(cables: CableStates, density: np.ndarray) -> np.ndarray:
    """(k,) squared frequencies of cables (k,); nan where not proved."""
    return lowest_clamped(HangingCables.of(cables.at(None), density), _TAUT_ORDER)[:, 0]


def _of_slack(cables: CableStates, density: np.ndarray, order: int) -> np.ndarray:
    """The same of cables (k,) that hang, by polynomials of the catenary's own coordinate, in which all is smooth."""
    coordinate = CatenaryCoordinate.of(cables)
    nodes, mass, stiffness, pair = _products(order)
    arc, rate = coordinate.arc(nodes)
    vertical = coordinate.frame_vertical[:, None] + cables.weight[:, None] * arc
    tension = np.hypot(cables.force_x[:, None], vertical)
    soft = tension / (1.0 + tension / cables.axial_stiffness[:, None])
    whole = (stiffness @ (soft / rate).T)[pair], (mass @ (density[:, None] * rate).T)[pair]
    few = np.r_[: _ROUGH_ORDER - 2, -1]
    start, _ = lowest_eigenvalue(*(part[np.ix_(few, few)] for part in whole))
    squared, proved = lowest_eigenvalue(*whole, start)
    for i in np.flatnonzero(~proved):
        squared[i] = eigh(whole[0][..., i], whole[1][..., i], eigvals_only=True)[0]
    return squared


@cache
def _products(order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Gauss nodes (q,), weighted products of functions and of their slopes (n (n + 1) / 2, q), and which of them is
    that of functions i and j (n, n). The first function, nearly the lowest mode, comes last."""
    nodes, weights = legendre.leggauss(order + order // 2)
    values, slopes = (np.roll(part[:-2], -1, axis=0) for part in polynomial_basis(nodes, order))
    first, second = np.triu_indices(order - 1)
    pair = np.zeros((order - 1, order - 1), dtype=int)
    pair[first, second] = pair[second, first] = np.arange(len(first))
    mass, stiffness = (part[first] * part[second] * weights for part in (values, slopes))
    return nodes, mass, stiffness, pair

"""The lowest natural frequency of each clamped cable, and the tension that brings it to a wanted value.

Exact for the linearised elastic catenary (any sag and inclination, tension varying along the cable), for as many
cables as there are in one go; it lies out of the cable's plane, as `lowest_clamped` shows. A cable on a pulley is taken
as held where it leaves the pulley.
"""

from functools import cache

import numpy as np
from numpy.polynomial import legendre

from cdpr_struct.dynamics.cable_dynamics import flattened
from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.catenary_coordinate import CatenaryCoordinate
from cdpr_struct.dynamics.lowest_clamped import lowest_clamped
from cdpr_struct.dynamics.polynomial_basis import polynomial_basis
from cdpr_struct.dynamics.stiff_cable import bending_factor, load_factor, slenderness
from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.holding_tensions import HoldingProblem

MAX_ITERATIONS = 40
_TAUT_ORDER, _SLACK_ORDERS = 10, (12, 20)
_DEEP = 1.5  # hyperbolic angle of a cable from which the higher order is used
_SLACK = 0.3  # weight over twice the chord tension from which polynomials of the arc length no longer do
_CHUNK = 1024
_MET = 1e-10
SAFE = 1.0 + 1e-9  # the bound is met with this margin, so that rounding does not undercut it


def fundamental_frequency(
    cables: CableStates, linear_density: np.ndarray, extensions: Extensions | None = None
) -> np.ndarray:
    """Lowest natural frequency of cables with both ends held.

    Parameters
    ----------
    cables : CableStates (..., m), all pulling
    linear_density : (m,) or (..., m) mu [kg/m]
    extensions : of the robot; bending stiffness and masses at mid-cable act, as on a taut string

    Returns
    -------
    (..., m) [rad/s].
    """
    return _frequencies(cables, linear_density) * _extra_factor(cables, linear_density, extensions)


def _extra_factor(cables: CableStates, density: np.ndarray, extensions: Extensions | None) -> np.ndarray | float:
    if extensions is None or not {"bending_stiffness", "added_mass"} & set(extensions.active):
        return 1.0
    slender = slenderness(extensions.bending_stiffness, cables.tension, cables.chord)
    load = load_factor(extensions.added_mass, density * cables.length, 1)
    return np.asarray(bending_factor(slender, 1) / np.sqrt(load))


def chord_tension_at_frequency(
    problem: HoldingProblem, linear_density: np.ndarray, b: float, extensions: Extensions | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Chord tension (k, m) [N] at which the lowest frequency of each cable is b [rad/s], and its platform tension [N].

    The frequency goes with the root of the tension but for a few per cent; a secant on that ratio takes out the rest.
    """
    least = problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    chord = np.linalg.norm(problem.arms.points - problem.arrays.frame_anchors, axis=-1)
    tau = np.maximum(linear_density * (b * chord / np.pi) ** 2, 2.0 * least)
    tau = _meet(problem, linear_density, b * SAFE, tau, extensions)
    return tau, problem.model.hold(problem.arrays, problem.arms.points, tau).states.tension_at_platform


def _meet(
    problem: HoldingProblem,
    density: np.ndarray,
    b: float,
    tau: np.ndarray,
    extensions: Extensions | None,
) -> np.ndarray:
    """Secant steps at the instants at which a cable is not there yet; one that needs less than `least` is.

    Raises
    ------
    ConvergenceError : a cable's tension is not found.
    """
    tau, arrays = tau.copy(), problem.arrays
    least = np.broadcast_to(problem.model.least_chord_tension(arrays, problem.arms.points), tau.shape)
    old, old_ratio = np.zeros(tau.shape), np.ones(tau.shape)
    rows = np.arange(len(tau))
    for _ in range(MAX_ITERATIONS):
        states = problem.model.hold(arrays, problem.arms.points[rows], tau[rows]).states
        frequency = _frequencies(states, density) * _extra_factor(states, density, extensions)
        ratio = 2.0 * np.log(frequency / b)
        open_ = (np.abs(ratio) > _MET) & ((ratio < 0.0) | (tau[rows] > least[rows]))
        rows, ratio = rows[open_.any(axis=1)], ratio[open_.any(axis=1)]
        if not rows.size:
            return tau
        moved = np.log(tau[rows]) - old[rows]
        slope = np.where(old[rows] == 0.0, 1.0, (ratio - old_ratio[rows]) / np.where(moved == 0.0, 1.0, moved))
        slope = np.where(moved == 0.0, 1.0, np.clip(slope, 0.3, 3.0))
        old[rows], old_ratio[rows] = np.log(tau[rows]), ratio
        tau[rows] = np.maximum(tau[rows] * np.exp(np.clip(-ratio / slope, -1.0, 1.0)), least[rows])
    hint = "The wanted frequency may be out of reach of some cable; try another --b."
    raise ConvergenceError("tension at the wanted cable frequency", float(np.abs(ratio).max()), MAX_ITERATIONS, hint)


def _frequencies(cables: CableStates, linear_density: np.ndarray) -> np.ndarray:
    shape = cables.length.shape
    flat = flattened(cables)
    density = np.broadcast_to(linear_density, shape).reshape(-1)
    frequency = np.empty(density.shape)
    half = 0.5 * flat.weight * flat.length
    slack = half > _SLACK * np.hypot(flat.force_x, flat.force_z - half)
    for lowest, members in ((_of_taut, np.flatnonzero(~slack)), (_of_slack, np.flatnonzero(slack))):
        for i in range(0, len(members), _CHUNK):
            own = members[i : i + _CHUNK]
            frequency[own] = np.sqrt(lowest(flat.at(own), density[own]))
    return frequency.reshape(shape)


def _of_taut(cables: CableStates, density: np.ndarray) -> np.ndarray:
    """(k,) squared frequencies of cables (k,)."""
    return lowest_clamped(HangingCables.of(cables.at(None), density), _TAUT_ORDER)[:, 0]


def _of_slack(cables: CableStates, density: np.ndarray) -> np.ndarray:
    """The same of cables (k,) that hang, by polynomials of the catenary's own coordinate, in which all is smooth."""
    coordinate = CatenaryCoordinate.of(cables)
    order = _SLACK_ORDERS[int(coordinate.angle.max() > _DEEP)]
    nodes, mass, stiffness = _products(order)
    arc, rate = coordinate.arc(nodes)
    vertical = coordinate.frame_vertical[:, None] + cables.weight[:, None] * arc
    tension = np.hypot(cables.force_x[:, None], vertical)
    soft = tension / (1.0 + tension / cables.axial_stiffness[:, None])
    k, n = len(arc), order - 1
    root = np.linalg.inv(np.linalg.cholesky(((soft / rate) @ stiffness).reshape(k, n, n)))
    whole = root @ ((density[:, None] * rate) @ mass).reshape(k, n, n) @ np.swapaxes(root, 1, 2)
    largest: np.ndarray = np.linalg.eigvalsh(whole)[:, -1]  # of 1 / omega^2, so that rounding falls on fast modes
    return 1.0 / largest


@cache
def _products(order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss nodes (q,), and weighted products of the functions and of their slopes (q, n n)."""
    nodes, weights = legendre.leggauss(order + order // 2)
    both = (np.asarray(part)[:-2] for part in polynomial_basis(nodes, order))
    mass, stiffness = ((f[:, None, :] * f[None, :, :] * weights).reshape(-1, len(nodes)).T for f in both)
    return nodes, mass, stiffness

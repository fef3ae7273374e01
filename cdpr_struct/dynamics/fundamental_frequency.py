"""The lowest natural frequency of each clamped cable, and the tension that brings it to a wanted value.

Exact for the linearised elastic catenary (any sag and inclination, tension varying along the cable), for as many
cables as there are in one go; it lies out of the cable's plane, as `lowest_clamped` shows. A cable on a pulley is taken
as held where it leaves the pulley.
"""

import numpy as np
from numpy.polynomial import legendre

from cdpr_struct.dynamics.cable_dynamics import flattened
from cdpr_struct.dynamics.catenary_expansion import polynomial_basis
from cdpr_struct.dynamics.condensed_cables import HangingCables
from cdpr_struct.dynamics.lowest_clamped import lowest_clamped
from cdpr_struct.dynamics.stiff_cable import bending_factor, load_factor, slenderness
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.holding_tensions import HoldingProblem

MAX_ITERATIONS = 40
_TAUT_ORDER, _SLACK_ORDER = 10, 48
_SLACK = 0.3  # weight over twice the chord tension from which the higher order is used
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
    shape, least = tau.shape, problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    old, old_ratio = np.zeros(shape), np.ones(shape)
    for _ in range(MAX_ITERATIONS):
        states = problem.model.hold(problem.arrays, problem.arms.points, tau).states
        frequency = _frequencies(states, density) * _extra_factor(states, density, extensions)
        ratio = 2.0 * np.log(frequency / b)
        if (np.abs(ratio) <= _MET).all() or ((ratio >= 0.0) & (tau <= least)).all():
            break
        moved = np.log(tau) - old
        slope = np.where(old == 0.0, 1.0, (ratio - old_ratio) / np.where(moved == 0.0, 1.0, moved))
        slope = np.where(moved == 0.0, 1.0, np.clip(slope, 0.3, 3.0))
        old, old_ratio = np.log(tau), ratio
        tau = np.maximum(tau * np.exp(np.clip(-ratio / slope, -1.0, 1.0)), least)
    return tau


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
            frequency[own] = np.sqrt(lowest(HangingCables.of(flat.at(own).at(None), density[own])))
    return frequency.reshape(shape)


def _of_taut(cables: HangingCables) -> np.ndarray:
    """(k,) squared frequencies of cables (k, 1)."""
    return lowest_clamped(cables, _TAUT_ORDER)[:, 0]


def _of_slack(cables: HangingCables) -> np.ndarray:
    """The same by more polynomials, as they come: the largest of 1 / omega^2, so that rounding falls on fast modes."""
    nodes, weights = legendre.leggauss(2 * _SLACK_ORDER + 16)
    values, slopes = (np.asarray(part)[:-2] for part in polynomial_basis(nodes, _SLACK_ORDER))
    products = (slopes[:, None, :] * slopes[None, :, :] * weights).reshape(-1, len(nodes)).T
    across = cables.out_of_plane(nodes)[..., 0].T
    stiffness = (across @ products).reshape(-1, len(slopes), len(slopes))
    root = np.linalg.inv(np.linalg.cholesky(stiffness))
    mass = (values * weights) @ values.T
    largest: np.ndarray = np.linalg.eigvalsh(root @ mass @ np.swapaxes(root, 1, 2))[:, -1]
    return 1.0 / (largest * cables.per_squared[:, 0])

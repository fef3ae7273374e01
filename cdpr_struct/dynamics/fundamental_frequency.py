"""The lowest natural frequency of each clamped cable, and the tension that brings it to a wanted value.

Exact for the linearised elastic catenary (any sag and inclination, tension varying along the cable), for as many cables
as there are in one go: Galerkin's method on a few integrated Legendre polynomials, which give the first mode of a taut
cable to twelve digits. A cable on a pulley is taken as held where it leaves the pulley.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from cdpr_struct.dynamics.stiff_cable import bending_factor, load_factor, slenderness
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.holding_tensions import HoldingProblem

MAX_ITERATIONS = 40
_TAUT_ORDER, _SLACK_ORDER = 8, 48
_SLACK = 0.3  # weight over twice the chord tension from which the higher order is used
_CHUNK = 4096
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
    (..., m) [rad/s], out of plane or in plane, whichever is lower.
    """
    return _frequencies(cables, linear_density, True) * _extra_factor(cables, linear_density, extensions)


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
    for in_plane in (False, True):  # the cheap plane first, then what little the other changes
        tau = _meet(problem, linear_density, b * SAFE, np.maximum(tau, 2.0 * least), in_plane, extensions)
    return tau, problem.model.hold(problem.arrays, problem.arms.points, tau).states.tension_at_platform


def _meet(
    problem: HoldingProblem,
    density: np.ndarray,
    b: float,
    tau: np.ndarray,
    in_plane: bool,
    extensions: Extensions | None,
) -> np.ndarray:
    shape, least = tau.shape, problem.model.least_chord_tension(problem.arrays, problem.arms.points)
    old, old_ratio = np.zeros(shape), np.ones(shape)
    for _ in range(MAX_ITERATIONS):
        states = problem.model.hold(problem.arrays, problem.arms.points, tau).states
        frequency = _frequencies(states, density, in_plane) * _extra_factor(states, density, extensions)
        ratio = 2.0 * np.log(frequency / b)
        if (np.abs(ratio) <= _MET).all() or ((ratio >= 0.0) & (tau <= least)).all():
            break
        moved = np.log(tau) - old
        slope = np.where(old == 0.0, 1.0, (ratio - old_ratio) / np.where(moved == 0.0, 1.0, moved))
        slope = np.where(moved == 0.0, 1.0, np.clip(slope, 0.3, 3.0))
        old, old_ratio = np.log(tau), ratio
        tau = np.maximum(tau * np.exp(np.clip(-ratio / slope, -1.0, 1.0)), least)
    return tau


@dataclass(frozen=True, slots=True, eq=False)
class _Clamped:
    """Cables (k,) between fixed ends: horizontal and vertical pull at the platform end, and what they are made of."""

    horizontal: np.ndarray
    vertical: np.ndarray
    length: np.ndarray
    stiff: np.ndarray
    weight: np.ndarray
    density: np.ndarray

    def take(self, index: np.ndarray) -> "_Clamped":
        return _Clamped(*(getattr(self, name)[index] for name in self.__slots__))

    @property
    def slack(self) -> np.ndarray:
        """(k,) bool: so much sag that more polynomials are needed."""
        half = 0.5 * self.weight * self.length
        return half > _SLACK * np.hypot(self.horizontal, self.vertical - half)

    def lowest(self, order: int, in_plane: bool) -> np.ndarray:
        """Lowest frequency (k,) [rad/s]: out of plane only, or of both planes.

        The equation of motion in the unstrained coordinate is (D u')' + mu omega^2 u = 0 with D = EA t t^T +
        T / (1 + T/EA) (1 - t t^T), T the tension and t the tangent of the hanging cable.
        """
        nodes, weights = legendre.leggauss(2 * order + 16)
        slopes, mass = _basis(nodes, weights, order)
        size = len(slopes)
        products = (slopes[:, None, :] * slopes[None, :, :] * weights).reshape(-1, len(nodes)).T
        up = self.vertical[:, None] - 0.5 * (self.weight * self.length)[:, None] * (1.0 - nodes)
        tension = np.hypot(self.horizontal[:, None], up)
        across = tension / (1.0 + tension / self.stiff[:, None])
        scale = 4.0 / (self.density * self.length**2)
        squared = scale * _smallest((across @ products).reshape(-1, size, size), mass)
        if in_plane:
            extra = self.stiff[:, None] - across
            cos, sin = self.horizontal[:, None] / tension, up / tension
            blocks = (across + extra * cos**2, extra * cos * sin, across + extra * sin**2)
            xx, xz, zz = ((block @ products).reshape(-1, size, size) for block in blocks)
            stiffness = np.concatenate([np.concatenate([xx, xz], axis=2), np.concatenate([xz, zz], axis=2)], axis=1)
            squared = np.minimum(squared, scale * _smallest(stiffness, np.kron(np.eye(2), mass)))
        return np.sqrt(squared)


def _frequencies(cables: CableStates, linear_density: np.ndarray, in_plane: bool) -> np.ndarray:
    shape = cables.length.shape
    given = (
        cables.force_x, cables.force_z, cables.length, cables.axial_stiffness, cables.weight, linear_density,
    )  # fmt: skip
    clamped = _Clamped(*(np.broadcast_to(a, shape).reshape(-1) for a in given))
    frequency, slack = np.empty(clamped.length.shape), clamped.slack
    for order, members in ((_TAUT_ORDER, np.flatnonzero(~slack)), (_SLACK_ORDER, np.flatnonzero(slack))):
        for i in range(0, len(members), _CHUNK):
            own = members[i : i + _CHUNK]
            frequency[own] = clamped.take(own).lowest(order, in_plane)
    return frequency.reshape(shape)


def _basis(nodes: np.ndarray, weights: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal slopes (i, q) and mass matrix (i, i) of polynomials that vanish at both ends of -1..1."""
    polynomials = legendre.legvander(nodes, order).T
    k = np.arange(2, order + 1)[:, None]
    values = (polynomials[2:] - polynomials[:-2]) / np.sqrt(2.0 * (2 * k - 1))
    return np.sqrt((2 * k - 1) / 2.0) * polynomials[1:-1], (values * weights) @ values.T


def _smallest(stiffness: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Smallest omega^2 (k,) of stiffness (k, n, n) against one mass matrix, as the largest of 1 / omega^2: rounding
    then falls on the fast axial modes."""
    root = np.linalg.inv(np.linalg.cholesky(stiffness))
    largest: np.ndarray = np.linalg.eigvalsh(root @ mass @ np.swapaxes(root, 1, 2))[:, -1]
    return 1.0 / largest

"""Bands of one cable's natural frequencies, within its own tolerances."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from scipy.special import ndtri

from cdpr_struct.dynamics.clamped_catenary import clamped_frequencies, enough_polynomials
from cdpr_struct.generated import catenary
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.catenary import solve_end_forces
from cdpr_struct.statics.pulled_cables import pulled_cables

Held = Literal["force", "ends"]
HELD: tuple[Held, ...] = get_args(Held)
"""What stays as entered: the force at the end, as a load cell tells it, or the places of both ends, which are off by
their anchors; the force then follows."""
NUMBERS = ("length", "ends", "axial stiffness", "density", "force")
"""What may be off; of the ends their distances along x and z."""
_PLACES = ((0,), (1, 2), (3,), (4,), (5,))
_STEP = 0.02  # sigmas, of a difference
_AT_ONCE = 128  # cables whose frequencies are computed together
_SEED = 22
_TWO_PLANES = 2


@dataclass(frozen=True, slots=True, eq=False)
class CableBands:
    """Of k frequencies across the cable's plane and, behind them, k in it.

    low, high, sigma : (2 k,) [Hz];  shares : (5, 2 k) of the variance of each that come of `NUMBERS`
    slack_sigmas : force at the end in sigmas of itself
    """

    low: np.ndarray
    high: np.ndarray
    sigma: np.ndarray
    shares: np.ndarray
    slack_sigmas: float


@dataclass(frozen=True, slots=True, eq=False)
class UncertainCable:
    """A cable that hangs from the origin, pulled at its end.

    force : (2,) x, z at the end [N];  length : unstrained [m];  axial_stiffness : [N];  density : [kg/m]
    gravity : [m/s^2];  tolerances : length, anchors, EA, density, load cell
    """

    force: np.ndarray
    length: float
    axial_stiffness: float
    density: float
    gravity: float
    tolerances: Tolerances
    held: Held = "force"

    @property
    def sigma(self) -> np.ndarray:
        """(6,) of the length, of the end's x and z [m], of ln EA, of ln mu, of the force [N]; zero of what follows."""
        own, pull = self.tolerances, float(np.linalg.norm(self.force))
        cell = float(np.hypot(own.load_cell_gain * pull, own.load_cell_bias_N)) if self.held == "force" else 0.0
        apart = np.sqrt(2.0) * own.anchor_m if self.held == "ends" else 0.0
        return np.array([own.length_m, apart, apart, own.axial_stiffness, own.linear_density, cell])

    def numbers(self, normal: np.ndarray, count: int) -> np.ndarray:
        """(n, 2 count + 1) frequencies across the plane and in it [Hz], and the force at the end [N].

        normal : (n, 6) by how many sigmas the numbers of a cable are off
        """
        changes = normal * self.sigma
        parts = np.array_split(changes, max(1, -(-len(changes) // _AT_ONCE)))
        return np.concatenate([self._of(part, count) for part in parts])

    def _of(self, change: np.ndarray, count: int) -> np.ndarray:
        length = self.length + change[:, 0]
        stiff, density = self.axial_stiffness * np.exp(change[:, 3]), self.density * np.exp(change[:, 4])
        weight = density * self.gravity
        pull = np.array([abs(self.force[0]), self.force[1]])
        if self.held == "force":
            force = pull * (1.0 + change[:, 5:] / np.linalg.norm(pull))
            end = np.stack(catenary.end_point(force[:, 0], force[:, 1], length, stiff, weight), axis=-1)
        else:
            as_entered = catenary.end_point(
                pull[0], pull[1], self.length, self.axial_stiffness, self.density * self.gravity
            )
            end = np.array(as_entered) + change[:, 1:3]
            found = solve_end_forces(end[:, 0], end[:, 1], length, stiff, weight)
            force = np.stack([found.force_x, found.force_z], axis=-1)
        cables = pulled_cables(force, end, length, stiff, weight)
        in_plane, across = clamped_frequencies(cables, density, enough_polynomials(cables, count))
        hertz = np.concatenate([across[:, :count], in_plane[:, :count]], axis=1) / (2.0 * np.pi)
        return np.concatenate([hertz, np.linalg.norm(force, axis=1, keepdims=True)], axis=1)

    def bands(self, count: int, level: float) -> CableBands:
        """Central bands to first order that hold with a probability `level`, each frequency by itself."""
        ways = _STEP * np.eye(len(self.sigma))
        own, found = np.split(self.numbers(np.concatenate([0.0 * ways[:1], ways, -ways]), count), [1])
        up, down = np.split(found, 2)
        rates = (up - down) / (2.0 * _STEP)
        hertz, force = own[0, :-1], float(own[0, -1])
        relative = rates[:, :-1] / hertz
        sigma = np.linalg.norm(relative, axis=0)
        reach = ndtri(0.5 + 0.5 * level) * sigma
        parts = np.array([(relative[list(place)] ** 2).sum(axis=0) for place in _PLACES])
        margin = force / max(float(np.linalg.norm(rates[:, -1])), 1e-300)
        shares = parts / np.maximum(parts.sum(axis=0), 1e-300)
        return CableBands(hertz * np.exp(-reach), hertz * np.exp(reach), sigma * hertz, shares, margin)

    def drawn(self, samples: int, count: int) -> np.ndarray:
        """(n, 2 count) frequencies of cables drawn from the tolerances, each computed anew [Hz]."""
        normal = np.random.default_rng(_SEED).standard_normal((samples, len(self.sigma)))
        return self.numbers(normal, count)[:, : _TWO_PLANES * count]

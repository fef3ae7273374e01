"""Do cable forces along a motion keep their bounds, if the robot is off by its tolerances?

The winches follow the lengths that the robot as entered needs. At each instant the true robot is balanced under the
same inertia forces, a little elsewhere and with other tensions. It is one robot all along: the same draws at every
instant.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri

from cdpr_struct.bands.drawn_robots import drawn_rests
from cdpr_struct.bands.frequency_bands import drawn_changes
from cdpr_struct.bands.likeliest_robot import about_the_means, likeliest_rests, required
from cdpr_struct.bands.locked_response import LockedStations
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.robot.tolerances import Spread

MOST_INSTANTS = 300
"""Instants of a motion that are looked at, evenly chosen."""
_CHECKED = 8  # of them at which robots are drawn and brought to balance
_TINY = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class ForceBands:
    """Tensions at the platform of m cables at n instants [N], within the tolerances.

    instant : (n,) which of the distribution's;  tension : (n, m) of the robot as entered;  sigma : (n, m)
    band : (n, m, 2)
    slack, below, above : (n, m) probability of no tension at all, of less than the lower, of more than the upper bound
    all_taut, all_above, all_below : that every cable keeps them along the whole motion
    missing : (d,) by how much the least tension of each of d drawn robots lies below its lower bound, negative: above
    """

    instant: np.ndarray
    tension: np.ndarray
    sigma: np.ndarray
    band: np.ndarray
    slack: np.ndarray
    below: np.ndarray
    above: np.ndarray
    all_taut: float
    all_above: float
    all_below: float
    missing: np.ndarray

    def raised(self, probability: float) -> float:
        """By how much more than the lower bound the robot as entered should pull, so that with this probability every
        tension of the true robot lies above it [N]; never below zero."""
        return max(0.0, float(np.quantile(self.missing, probability)))


@dataclass(frozen=True, slots=True, eq=False)
class DrawnForces:
    """Tensions of drawn robots in balance at c instants.

    place : (c,) among the instants of `ForceBands`;  ends : (c, m, 2) of the central band [N]
    lost  : robots without a balance
    """

    place: np.ndarray
    ends: np.ndarray
    lost: int


@dataclass(frozen=True, slots=True, eq=False)
class UncertainForces:
    """Forces along a motion on sagging or spring cables, and which robots are probable."""

    found: TrajectoryDistribution
    spread: Spread

    @property
    def instant(self) -> np.ndarray:
        """(n,) instants that are looked at."""
        count = len(self.found.trajectory)
        return np.unique(np.linspace(0, count - 1, min(count, MOST_INSTANTS)).round().astype(int))

    def bands(self, level: float) -> ForceBands:
        """Central bands to first order that hold with a probability `level`, each tension by itself.

        Raises
        ------
        CdprError : with its likeliest numbers the robot finds no balance somewhere.
        """
        shared, instant = self.found.distribution, self.instant
        shape = (len(instant), shared.tensions.shape[1])
        tension, (lower, upper) = shared.tensions[instant], (self._bound(end)[instant] for end in ("lower", "upper"))
        wrench, spread = self._wrench[instant], about_the_means(self.spread)
        points = required(likeliest_rests(self._points(instant), self.spread, self.found.model, wrench))
        changes, middle, sigma = drawn_changes(spread), np.empty(shape), np.empty(shape)
        least, missing, excess = (np.full(len(changes), start) for start in (np.inf, -np.inf, -np.inf))
        for row, point in enumerate(points):
            stations = LockedStations.about(point, self.found.model, wrench[row], spread)
            rates = stations.slope(stations.rests.cables.tension_at_platform)
            middle[row], sigma[row] = point.cables.tension_at_platform, spread.sigma(rates)
            drawn = middle[row] + changes @ rates
            least = np.minimum(least, drawn.min(axis=1))
            missing = np.maximum(missing, (lower[row] - drawn).max(axis=1))
            excess = np.maximum(excess, (drawn - upper[row]).max(axis=1))
        safe = np.maximum(sigma, _TINY)
        reach = ndtri(0.5 + 0.5 * level) * np.array([-1.0, 1.0])
        below = (ndtr((limit - middle) / safe) for limit in (0.0, lower, upper))
        slack, under, within = below
        return ForceBands(
            instant, tension, sigma, middle[..., None] + sigma[..., None] * reach, slack, under, 1.0 - within,
            float((least > 0.0).mean()), float((missing <= 0.0).mean()), float((excess <= 0.0).mean()), missing,
        )  # fmt: skip

    def drawn(self, samples: int, level: float) -> DrawnForces:
        """Robots drawn from the tolerances and balanced anew, at a few instants."""
        instant = self.instant
        place = np.unique(np.linspace(0, len(instant) - 1, min(len(instant), _CHECKED)).round().astype(int))
        ends, lost, wrench = [], 0, self._wrench
        for point, number in zip(self._points(instant[place]), instant[place], strict=True):
            rests, kept = drawn_rests(point, self.spread, samples, self.found.model, wrench[number])
            pulled = rests.cables.tension_at_platform
            ends.append(np.quantile(pulled, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=0).T)
            lost += samples - len(kept)
        return DrawnForces(place, np.array(ends), lost)

    @property
    def _wrench(self) -> np.ndarray:
        """(k, 6) of the platform's inertia."""
        return self.found.trajectory.inertia_wrench(self.found.robot.platform)

    def _bound(self, which: str) -> np.ndarray:
        """(k, m) [N]."""
        shared = self.found.distribution
        return np.asarray(np.broadcast_to(getattr(shared, which), shared.tensions.shape))

    def _points(self, instant: np.ndarray) -> list[OperatingPoint]:
        """The robot as entered at instants (n,)."""
        path, cables = self.found.trajectory, self.found.distribution.cables
        return [
            OperatingPoint(self.found.robot, path.position[i], path.rotation[i], cables.at(int(i))) for i in instant
        ]

"""A campaign about a point: residuals linear in the readings' noise, in tolerances, and in the sizes of causes.

With the true readings y - n and numbers z of the robot the residual R(n, z) is zero. About a point,

    R - R_n n0 - R_z z0 = -R_n n - R_z z,   or   r = A u + X z,   u = n / sigma.

Each block of states that share a reading has rows and noise of its own; z belongs to all.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.recorded import Recorded
from cdpr_struct.diagnosis.tolerances import tolerance_count, tolerated
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import static_residuals
from cdpr_struct.robot.robot_arrays import RobotArrays

Change = Callable[[RobotArrays, np.ndarray], RobotArrays]
_STEP = 0.05  # of a sigma, of differences: the residuals are smooth, and all but straight so near


@dataclass(frozen=True, slots=True, eq=False)
class Term:
    """A change of the robot by numbers theta0 = basis @ (sigma * z), z (d,) standard normal under its prior."""

    change: Change
    basis: np.ndarray
    sigma: np.ndarray

    def applied(self, arrays: RobotArrays, z: np.ndarray) -> RobotArrays:
        """The robot with z (..., 1, d) put in; the axes before d are batch and states of its fields."""
        return self.change(arrays, (z * self.sigma) @ self.basis.T)


def tolerance_term(data: Recorded) -> Term:
    """Tolerances as the first term of every hypothesis."""
    count, tolerances = tolerance_count(data.cables), data.campaign.tolerances
    return Term(lambda arrays, u: tolerated(arrays, tolerances, u), np.eye(count), np.ones(count))


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """Where a campaign is linearised: terms with their numbers z (d,) each, noise (S, 6 + 2 m) in sigmas."""

    terms: tuple[Term, ...]
    z: tuple[np.ndarray, ...]
    noise: np.ndarray

    @classmethod
    def entered(cls, data: Recorded) -> "Point":
        """Everything as entered, and as read."""
        term = tolerance_term(data)
        return cls((term,), (np.zeros(len(term.sigma)),), np.zeros_like(data.sigma))

    def with_term(self, term: Term, z: np.ndarray | None = None) -> "Point":
        """The point with one more term, at zero unless given."""
        own = np.zeros(len(term.sigma)) if z is None else z
        return replace(self, terms=(*self.terms, term), z=(*self.z, own))

    def robot(self, data: Recorded) -> RobotArrays:
        """The robot at the point."""
        arrays = data.arrays
        for term, z in zip(self.terms, self.z, strict=True):
            arrays = term.applied(arrays, z[None])
        return arrays

    def readings(self, data: Recorded, more: np.ndarray | None = None) -> Readings:
        """The readings less their noise at the point, and `more` (..., S, 6 + 2 m) sigmas of it."""
        noise = self.noise if more is None else self.noise + more
        return less(data, data.readings, noise)


def less(data: Recorded, readings: Readings, noise: np.ndarray) -> Readings:
    """Readings less noise (..., S, 6 + 2 m) in sigmas."""
    pose, tension, length = np.split(noise * data.sigma, [6, 6 + data.cables], axis=-1)
    return readings.less(pose, tension, length)


@dataclass(frozen=True, slots=True, eq=False)
class Slopes:
    """Residuals at a point and what noise does to them: r (S, 6 + m), by_noise (S, 6 + m, 6 + 2 m) = -dR/du."""

    r: np.ndarray
    by_noise: np.ndarray


def slopes(data: Recorded, point: Point) -> Slopes:
    """Residuals and their slopes by the noise of the readings, each reading of all states moved at once."""
    count = 6 + 2 * data.cables
    steps = np.concatenate([np.zeros((1, 1, count)), _STEP * np.eye(count)[:, None, :]])
    found = residuals(data, point.robot(data), point.readings(data, steps))
    return Slopes(found[0], -np.moveaxis(found[1:] - found[0], 0, -1) / _STEP)


def residuals(data: Recorded, arrays: RobotArrays, readings: Readings) -> np.ndarray:
    """(..., S, 6 + m)."""
    return static_residuals(arrays, readings, data.known, data.radius)


def columns(data: Recorded, point: Point, terms: Sequence[Term], base: np.ndarray | None = None) -> list[np.ndarray]:
    """-dR/dz (S, 6 + m, d) of further terms at a point, each from zero."""
    arrays, readings = point.robot(data), point.readings(data)
    start = residuals(data, arrays, readings) if base is None else base
    return [_columns(data, arrays, readings, term, start) for term in terms]


def _columns(data: Recorded, arrays: RobotArrays, readings: Readings, term: Term, start: np.ndarray) -> np.ndarray:
    moved = term.applied(arrays, _STEP * np.eye(len(term.sigma))[:, None, :])
    found = residuals(data, moved, readings)
    return -np.moveaxis(np.broadcast_to(found, (len(term.sigma), *start.shape)) - start, 0, -1) / _STEP


def own_columns(data: Recorded, point: Point, base: np.ndarray) -> np.ndarray:
    """-dR/dz (S, 6 + m, t) of the point's own terms, at their numbers."""
    readings, parts = point.readings(data), []
    for i, term in enumerate(point.terms):
        arrays = data.arrays
        for j, (other, z) in enumerate(zip(point.terms, point.z, strict=True)):
            steps = z + _STEP * np.eye(len(z))[:, None, :] if i == j else z[None]
            arrays = other.applied(arrays, steps)
        found = np.broadcast_to(residuals(data, arrays, readings), (len(term.sigma), *base.shape))
        parts.append(-np.moveaxis(found - base, 0, -1) / _STEP)
    return np.concatenate(parts, axis=-1)

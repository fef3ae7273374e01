"""A campaign about a point: residuals linear in the readings' noise, in tolerances, and in the sizes of causes.

With the true readings y - n and numbers z of the robot the residual R(n, z) is zero. About a point,

    R - R_n n0 - R_z z0 = -R_n n - R_z z,   or   r = A u + X z,   u = n / sigma.

Each block of states that share a reading has rows and noise of its own; z belongs to all.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache

import numpy as np

from cdpr_struct.observation.nearby_rest import NearbyRest
from cdpr_struct.observation.readings import Readings
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.residuals.vibrations import Vibrating
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.tolerances import tolerance_count, tolerated
from cdpr_struct.statics.swivel_angle import within_turn


@dataclass(frozen=True, slots=True, eq=False)
class Outside:
    """Columns -dR/dz of what is no change of the robot: static (S, 6 + m, d), of single cables' ln f (r, d), of
    swivel angles (w, d).

    Peaks of the robot are left out: a reading changes them little, and other points have other modes.
    """

    static: np.ndarray
    cables: np.ndarray
    swivels: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence["Outside"]) -> "Outside":
        """Columns side by side."""
        return cls(*(np.concatenate([getattr(p, f.name) for p in parts], axis=-1) for f in fields(cls)))

    @property
    def count(self) -> int:
        """d"""
        return int(self.static.shape[-1])

    def times(self, sigma: np.ndarray) -> "Outside":
        """Columns times factors (d,)."""
        return Outside(self.static * sigma, self.cables * sigma, self.swivels * sigma)

    def shared(self, share: np.ndarray, of: "RowStates") -> "Outside":
        """Columns of numbers z (d,) that make numbers share (S, k, d) @ z of each state in place of its k columns."""
        cables = (self.cables[:, None] @ share[of.cables])[:, 0]
        return Outside(self.static @ share, cables, (self.swivels[:, None] @ share[of.swivels])[:, 0])


@dataclass(frozen=True, slots=True, eq=False)
class RowStates:
    """State of each frequency of a single cable (r,), and of each swivel angle (w,)."""

    cables: np.ndarray
    swivels: np.ndarray


Change = Callable[[RobotArrays, np.ndarray], RobotArrays]
_KEPT = 16  # points whose model is kept: those of the hypotheses that a search goes back to
_STEP = 0.05  # of a sigma, of differences: the residuals are smooth, and all but straight so near


@dataclass(frozen=True, slots=True, eq=False)
class Term:
    """A change of the robot by numbers theta0 = basis @ (sigma * z), z (d,) standard normal under its prior.

    columns : of a law outside the model instead, -dR/dz as it stands; it changes no robot
    """

    change: Change
    basis: np.ndarray
    sigma: np.ndarray
    columns: Outside | None = None

    @classmethod
    def outside(cls, columns: Outside) -> "Term":
        """A law outside the model."""
        return cls(_nothing, np.eye(columns.count), np.ones(columns.count), columns)

    def applied(self, arrays: RobotArrays, z: np.ndarray) -> RobotArrays:
        """The robot with z (..., 1, d) put in; the axes before d are batch and states of its fields."""
        return self.change(arrays, (z * self.sigma) @ self.basis.T)


def _nothing(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return arrays


def tolerance_term(data: Recorded) -> Term:
    """Tolerances as the first term of every hypothesis."""
    count, tolerances = tolerance_count(data.cables, data.arrays.has_pulleys), data.campaign.tolerances
    return Term(lambda arrays, u: tolerated(arrays, tolerances, u), np.eye(count), np.ones(count))


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """Where a campaign is linearised: terms with their numbers z (d,) each, noise (S, 6 + 2 m) in sigmas."""

    terms: tuple[Term, ...]
    z: tuple[np.ndarray, ...]
    noise: np.ndarray

    @classmethod
    @lru_cache(maxsize=_KEPT)
    def entered(cls, data: Recorded) -> "Point":
        """Everything as entered, and as read."""
        term = tolerance_term(data)
        return cls((term,), (np.zeros(len(term.sigma)),), np.zeros_like(data.sigma))

    def with_term(self, term: Term, z: np.ndarray | None = None) -> "Point":
        """The point with one more term, at zero unless given."""
        own = np.zeros(len(term.sigma)) if z is None else z
        return replace(self, terms=(*self.terms, term), z=(*self.z, own))

    def towards(self, other: "Point", share: float) -> "Point":
        """A share of the way to another point of the same terms; all of it is that point."""
        z = tuple(own + share * (there - own) for own, there in zip(self.z, other.z, strict=True))
        return other if share == 1.0 else replace(self, z=z, noise=self.noise + share * (other.noise - self.noise))

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
class Rows:
    """Residuals, or their columns with one more axis (d).

    static (S, 6 + m, ...) [N, m];  cables (r, ...) : ln f of single cables;  robot (F, M, ...) : predictions of the
    robot's ln f, against which peaks are held;  sizes (a, ...) : ln of modal constants;  swivels (w, ...) : [rad]
    """

    static: np.ndarray
    cables: np.ndarray
    robot: np.ndarray
    sizes: np.ndarray
    swivels: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence["Rows"]) -> "Rows":
        """Columns side by side."""
        return cls(*(np.concatenate([getattr(p, f.name) for p in parts], axis=-1) for f in fields(cls)))

    def times(self, z: np.ndarray) -> "Rows":
        """Columns times numbers z (d,), or (d, e)."""
        return Rows(*(getattr(self, f.name) @ z for f in fields(self)))

    def only_static(self, columns: np.ndarray) -> "Rows":
        """Columns (S, 6 + m, d) of what acts on static rows alone, in the form of these residuals."""
        d = columns.shape[-1]
        others = (self.cables, self.robot, self.sizes, self.swivels)
        return Rows(columns, *(np.zeros((*part.shape, d)) for part in others))

    def of_outside(self, columns: Outside) -> "Rows":
        """Columns of what is no change of the robot, in the form of these residuals."""
        return replace(self.only_static(columns.static), cables=columns.cables, swivels=columns.swivels)


@dataclass(frozen=True, eq=False)
class Local:
    """A campaign about a point: the robot and the readings there, and the states near it, at rest and vibrating.

    r : residuals at the point; of the robot's frequencies zero, as they are predictions

    Without slots, as columns are kept once they were asked for.
    """

    data: Recorded
    point: Point
    arrays: RobotArrays
    nearby: NearbyRest
    vibrating: Vibrating | None
    r: Rows

    @classmethod
    @lru_cache(maxsize=_KEPT)
    def about(cls, data: Recorded, point: Point) -> "Local":
        """The states that the readings less their noise mean for the point's robot; kept for the last few points."""
        arrays, readings = point.robot(data), point.readings(data)
        nearby = NearbyRest.about(arrays, readings, data.known, data.radius)
        found, measured = None, data.vibrations
        cables, robot, sizes = np.zeros(0), np.zeros((0, 0)), np.zeros(0)
        if measured is not None:
            found = Vibrating.about(data.campaign, data.known, measured, arrays, readings)
            cables, robot = measured.log_hertz - found.cables.log_hertz, np.zeros_like(found.log_hertz)
            sizes = measured.sizes.log - found.log_sizes(arrays)[0]
        static, turned = nearby.residuals(arrays, readings), np.zeros(0)
        if len(data.swivels):
            turned = data.swivels.missed(nearby.swivels(arrays, readings, data.swivels.reference))
        return cls(data, point, arrays, nearby, found, Rows(static, cables, robot, sizes, turned))

    @cached_property
    def by_noise(self) -> Rows:
        """-dR/du, each reading of all states moved at once: d = 6 + 2 m."""
        steps = _STEP * np.eye(self.data.sigma.shape[1])[:, None, :]
        return self._slope(self.arrays, self.point.readings(self.data, steps), len(steps))

    def columns(self, term: Term) -> Rows:
        """-dR/dz of one more term, from zero."""
        if term.columns is not None:
            return self.r.of_outside(term.columns)
        moved = term.applied(self.arrays, _STEP * np.eye(len(term.sigma))[:, None, :])
        return self._slope(moved, self.point.readings(self.data), len(term.sigma))

    def of_three(self, change: Change, step: float) -> Outside:
        """-dR by each of three numbers of a change, a unit."""
        found = self.columns(Term(change, np.eye(3), np.full(3, step)))
        return Outside(found.static, found.cables, found.swivels).times(np.full(3, 1.0 / step))

    def of_reading(self, which: slice) -> Outside:
        """-dR by some readings (d of 6 + 2 m) of each row's own state, a unit; zero of those that nobody read."""
        unit = np.where(self.data.read, 1.0 / self.data.sigma, 0.0)[:, which]
        static = self.by_noise.static[..., which] * unit[:, None]
        cables = self.by_noise.cables[..., which] * unit[self.states_of_rows.cables]
        return Outside(static, cables, self.by_noise.swivels[..., which] * unit[self.data.swivels.state])

    def acting_on(self, static: np.ndarray) -> Outside:
        """Columns (S, 6 + m, d) of what acts on static rows alone."""
        d = static.shape[-1]
        return Outside(static, np.zeros((len(self.r.cables), d)), np.zeros((len(self.r.swivels), d)))

    def noisy_static(self) -> np.ndarray:
        """(S, 6 + m) static residuals with the noise of the point put back, its robot as it is."""
        return self.r.static + np.einsum("srj,sj->sr", self.by_noise.static, self.point.noise)

    @property
    def states_of_rows(self) -> RowStates:
        """Which state each frequency of a single cable and each swivel angle belongs to."""
        measured, cables = self.data.vibrations, np.zeros(0, dtype=int)
        if measured is not None:
            cables = np.asarray(measured.states[measured.rows.state])
        return RowStates(cables, self.data.swivels.state)

    @cached_property
    def own_columns(self) -> Rows:
        """-dR/dz of the point's own terms, at their numbers."""
        parts, readings = [], self.point.readings(self.data)
        for i, term in enumerate(self.point.terms):
            if term.columns is not None:
                parts.append(self.r.of_outside(term.columns))
                continue
            arrays = self.data.arrays
            for j, (other, z) in enumerate(zip(self.point.terms, self.point.z, strict=True)):
                steps = z + _STEP * np.eye(len(z))[:, None, :] if i == j else z[None]
                arrays = other.applied(arrays, steps)
            parts.append(self._slope(arrays, readings, len(term.sigma)))
        return Rows.joined(parts)

    def told(self) -> np.ndarray:
        """(t,) numbers of the point's terms that the robot there has; zero those of laws outside the model."""
        pairs = zip(self.point.terms, self.point.z, strict=True)
        return np.concatenate([z if term.columns is None else 0.0 * z for term, z in pairs])

    def _slope(self, arrays: RobotArrays, readings: Readings, count: int) -> Rows:
        """-dR by `count` steps of size `_STEP`, which robots or readings (count, ...) have taken."""
        found = np.broadcast_to(self.nearby.residuals(arrays, readings), (count, *self.r.static.shape))
        static = np.moveaxis(self.r.static - found, 0, -1) / _STEP
        turned = self._turned(arrays, readings, count)
        if self.vibrating is None:
            return replace(self.r.only_static(static), swivels=turned)
        cables, robot, mixed = self.vibrating.changes(arrays, readings, count)
        sizes = mixed + self.vibrating.log_sizes(arrays) - self.vibrating.measured.sizes.log + self.r.sizes
        cables, robot, sizes = (np.moveaxis(part, 0, -1) / _STEP for part in (cables, robot, sizes))
        return Rows(static, cables, robot, sizes, turned)

    def _turned(self, arrays: RobotArrays, readings: Readings, count: int) -> np.ndarray:
        """(w, count) -dR/dz of swivel angles by steps as in `_slope` [rad]."""
        own = self.data.swivels
        if not len(own):
            return np.zeros((0, count))
        missed = own.missed(self.nearby.swivels(arrays, readings, own.reference))
        change = within_turn(self.r.swivels - np.broadcast_to(missed, (count, len(own))))
        return np.asarray(np.moveaxis(change, 0, -1) / _STEP)

"""What would a sensor say that is not there, and how surely? Of every state, by what a fit knows of the robot.

With readings' errors u and the robot's numbers z about a point (u0, z0) of a state, as in `residuals.linearised`,

    r + A u0 = A u + X (z - z0) + floor,   u ~ N(0, V), z - z0 ~ N(0, C),

where C is what the fit left open of tolerances and causes, and V holds a wide variance where nothing was read. A sensor
that is there is predicted without its own reading, so that both can be compared. Each state stands by itself.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.whole_sizes import over_scales
from cdpr_struct.hypotheses.judge import Judged, judged
from cdpr_struct.observation.motion import inertial
from cdpr_struct.observation.readings import LEAST_TENSION, Readings, true_tension
from cdpr_struct.observation.rest import at_states
from cdpr_struct.residuals.assembled import floor_of_states
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.linearised import Local, Point, Term
from cdpr_struct.residuals.recorded import LENGTH, POSITION, ROTATION, SWIVEL, TENSION, Recorded
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays

_ROUNDS = 4  # of linearisation about the likeliest readings; near the data the steps shrink by ten and more each
_ANY = 30.0  # times what tensions are expected to be: a pretension of any size
_TAUT = 2.0  # times the tension as which slack cables count
_STILL = 0.02  # sigmas: a state that moves less has been found
_STEP = 1e-3  # sigmas, of tensions that cells mean: they are linear in all but friction


@dataclass(frozen=True, slots=True, eq=False)
class VirtualSensors:
    """Predictions for S states of a robot with m cables, (S, 6 + 2 m) each.

    value   : position of the platform [m], its angles [rad], tensions at the platform [N], lengths as encoders say them
        [m]; of a sensor that was read, without its own reading
    sigma   : one standard deviation of that; of angles about the world's axes
    reading : what was read, nan where nothing was;  noise : one sigma of the reading's own error, as the fit found it
    names   : (S,) of the states;  time : (S,) [s], nan where it is not known
    settled : (S,) whether a state stayed where it was linearised last: of others, bands are rough
    """

    value: np.ndarray
    sigma: np.ndarray
    reading: np.ndarray
    noise: np.ndarray
    names: tuple[str, ...]
    time: np.ndarray
    settled: np.ndarray

    @property
    def cables(self) -> int:
        """m."""
        return (self.value.shape[1] - 6) // 2

    def off(self) -> np.ndarray:
        """(S, 6 + 2 m) readings less predictions, in sigmas of both together; nan where nothing was read."""
        return np.asarray((self.reading - self.value) / np.hypot(self.sigma, self.noise))


def opened(data: Recorded) -> Recorded:
    """With nothing known beforehand of tensions that nobody read.

    A fit of causes takes them for about as large as an estimate, in every state anew: for tensions themselves, that
    would tell the common pretension of all states, which nobody measured.
    """
    unread = data.unread.copy()
    unread[:, 6 : 6 + data.cables] *= _ANY
    return replace(data, unread=unread)


def refitted(found: Judged, data: Recorded) -> Judged:
    """The hypothesis of a fit once more, for readings that `opened` gave."""
    where = layout(data)
    return judged(data, where, found.hypothesis, replace(found.point, noise=np.zeros_like(data.sigma)))


def virtual_sensors(found: Judged, data: Recorded, fitted: np.ndarray, zeros: np.ndarray) -> VirtualSensors:
    """Predictions for all states of readings, which need not be those that were fitted.

    fitted : (S,) bool, states that the fit has seen: what they said of the robot's numbers is not counted twice
    zeros : (m,) [m] where relative encoders begin: their readings stand in `data` less these
    """
    data = _accelerated(replace(data, vibrations=None))
    terms, z, covariance = _robot_numbers(found)
    prior = np.where(data.read, _factors(found, data.cables) ** 2, (data.unread / data.sigma) ** 2)
    noise = _taut(data, np.zeros_like(data.sigma))
    for _ in range(_ROUNDS):
        state = _States.about(data, Point(terms, z, noise), covariance, prior).unseen(fitted)
        moved, noise = noise, _taut(data, state.likeliest())
        settled = (np.abs(noise - moved) * data.read).max(axis=1) < _STILL
        if settled.all():
            break
    value, sigma = np.zeros_like(prior), np.zeros_like(prior)
    for own in _sensors(data.cables):
        value[:, own], sigma[:, own] = state.without(own, (data.unread / data.sigma)[:, own] ** 2)
    return _told(data, found, (value, sigma), zeros, settled)


def _accelerated(data: Recorded) -> Recorded:
    """With the platform's inertia in the balance wherever poses tell it: a fit has it only where tensions were read."""
    if data.campaign.frames is not None:
        return data
    moved, unknown = inertial(data.campaign.states, where_pulled=False)
    return replace(data, known=replace(data.known, inertial=moved, acceleration=unknown))


def _taut(data: Recorded, noise: np.ndarray) -> np.ndarray:
    """Errors of readings with which no cable is slack: about a slack one, nothing has a slope."""
    tension = slice(6, 6 + data.cables)
    most = (data.readings.tension - _TAUT * LEAST_TENSION) / data.sigma[:, tension]
    return np.concatenate([noise[:, :6], np.minimum(noise[:, tension], most), noise[:, tension.stop :]], axis=1)


def _told(
    data: Recorded, found: Judged, predicted: tuple[np.ndarray, np.ndarray], zeros: np.ndarray, settled: np.ndarray
) -> VirtualSensors:
    """Predictions in the readings' own terms; values of angles are given as turns of the readings [rad]."""
    value, sigma = predicted
    m, states = data.cables, data.campaign.states
    turned = data.readings.less(np.pad(-value[:, 3:6], ((0, 0), (3, 0))), np.zeros(m), np.zeros(m)).rotation
    value[:, 3:6] = angles_from_rotation(turned)
    value[:, 6 + m :] += zeros
    reading = np.concatenate([states.position, states.angles, states.tension, states.length + zeros], axis=1)
    noise = data.sigma * _factors(found, m)
    return VirtualSensors(value, sigma, reading, noise, states.names, states.time, settled)


def _robot_numbers(found: Judged) -> tuple[tuple[Term, ...], tuple[np.ndarray, ...], np.ndarray]:
    """Terms that change the robot, their numbers and covariance; without drift and what is of single states."""
    mean, covariance = over_scales(found)
    parts, values = found.hypothesis.parts, found.split(mean)
    used = [True, *[False] * (len(values) - 1 - len(parts))]
    used += [part.law is None and part.cause.carrier != "state" for part in parts]
    kept = np.concatenate([np.full(len(own), use) for own, use in zip(values, used, strict=True)])
    terms = tuple(term for term, use in zip(found.point.terms, used, strict=True) if use)
    return terms, tuple(own for own, use in zip(values, used, strict=True) if use), covariance[np.ix_(kept, kept)]


def _factors(found: Judged, cables: int) -> np.ndarray:
    """(6 + 2 m,) factor on the stated sigma of each reading's kind; one of kinds that the fit did not see."""
    seen = np.asarray((found.model.readings.members > 0.0).any(axis=1))
    tau = np.ones(SWIVEL + 1)
    tau[: len(seen)] = np.where(seen, found.fit.noise.tau, 1.0)
    return np.asarray(np.repeat(tau[[POSITION, ROTATION, TENSION, LENGTH]], (3, 3, cables, cables)))


def _sensors(cables: int) -> Iterator[slice]:
    """Readings that one sensor gives together: a position, an orientation, a tension, a length."""
    yield slice(0, 3)
    yield slice(3, 6)
    for i in range(6, 6 + 2 * cables):
        yield slice(i, i + 1)


@dataclass(frozen=True, slots=True, eq=False)
class _States:
    """S states about a point: y = A u + X dz + floor.

    y (S, n), A (S, n, q), X (S, n, t), floor (S, n);  prior (S, q) of u, covariance (t, t) or (S, t, t) of dz
    base (S, q) : what is predicted at the point;  slope (S, q) : of it by u;  by_z (S, q, t) : by dz
    """

    y: np.ndarray
    A: np.ndarray
    X: np.ndarray
    floor: np.ndarray
    prior: np.ndarray
    covariance: np.ndarray
    base: np.ndarray
    slope: np.ndarray
    by_z: np.ndarray

    @classmethod
    def about(cls, data: Recorded, point: Point, covariance: np.ndarray, prior: np.ndarray) -> "_States":
        local = Local.about(data, point)
        A, X = local.by_noise.static, local.own_columns.static
        y = local.r.static + np.einsum("snq,sq->sn", A, point.noise)
        base, slope, by_z = _outputs(data, point)
        return cls(y, A, X, floor_of_states(data), prior, covariance, base, slope, by_z)

    def unseen(self, fitted: np.ndarray) -> "_States":
        """Numbers of the robot as all states but each fitted one tell them.

        A state that bends so much that it would leave less than nothing (a slack cable) stays counted.
        """
        if not fitted.any():
            return self
        known = self._solved(self.prior, np.concatenate([self.X, self.y[..., None]], axis=2), of_robot=False)
        told, whole = self.X.swapaxes(1, 2) @ known, np.linalg.inv(self.covariance)
        less = fitted & (np.linalg.eigvalsh(whole - told[..., :-1])[:, 0] > 0.0)
        told = np.where(less[:, None, None], told, 0.0)
        covariance = np.linalg.inv(whole - told[..., :-1])
        shift = -np.einsum("stu,su->st", covariance, told[..., -1])
        y, base = self.y - np.einsum("snt,st->sn", self.X, shift), self.base + np.einsum("sqt,st->sq", self.by_z, shift)
        return replace(self, y=y, base=base, covariance=covariance)

    def likeliest(self) -> np.ndarray:
        """(S, q) errors of all readings."""
        solved = self._solved(self.prior, self.y[..., None])[..., 0]
        return np.asarray(self.prior * np.einsum("snq,sn->sq", self.A, solved))

    def without(self, own: slice, variance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and sigmas (S, k) of some outputs, their own readings as uncertain as if nobody had read them."""
        prior = self.prior.copy()
        prior[:, own] = variance
        slope, by_z = self.slope[:, own], self.by_z[:, own] @ self.covariance
        shared = (slope * variance)[:, None] * self.A[:, :, own] + self.X @ by_z.swapaxes(1, 2)
        known = self._solved(prior, np.concatenate([shared, self.y[..., None]], axis=2))
        before = slope**2 * variance + np.einsum("skt,skt->sk", by_z, self.by_z[:, own])
        left = before - np.einsum("snk,snk->sk", shared, known[..., :-1])
        value = self.base[:, own] + np.einsum("snk,sn->sk", shared, known[..., -1])
        return value, np.sqrt(np.maximum(left, 0.0))

    def _solved(self, prior: np.ndarray, right: np.ndarray, of_robot: bool = True) -> np.ndarray:
        """(S, n, k) inverse covariance of y times right-hand sides; of_robot : with what is open of the robot."""
        whole = (self.A * prior[:, None]) @ self.A.swapaxes(1, 2)
        whole += self.X @ self.covariance @ self.X.swapaxes(1, 2) if of_robot else 0.0
        np.einsum("snn->sn", whole)[...] += self.floor**2
        return np.asarray(np.linalg.solve(whole, right))


def _outputs(data: Recorded, point: Point) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Predictions (S, q) with no error of the readings, and slopes by these errors and by numbers of the robot.

    In place of angles stands the turn from the reading.
    """
    m, readings = data.cables, data.readings
    at = point.readings(data)
    tension = _meant(data, point.robot(data), at)
    pulled = _meant(data, point.robot(data), replace(at, tension=at.tension + _STEP * data.sigma[:, 6 : 6 + m]))
    slope = -data.sigma
    slope[:, 6 : 6 + m] = -(pulled - tension) / _STEP
    unmoved = tension - slope[:, 6 : 6 + m] * point.noise[:, 6 : 6 + m]
    base = np.concatenate([readings.position, np.zeros((len(tension), 3)), unmoved, readings.length], axis=1)
    by_z = np.zeros((*base.shape, sum(map(len, point.z))))
    steps = zip(_stepped(data.arrays, point), point.z, strict=True)
    moved = [np.broadcast_to(_meant(data, arrays, at), (len(z), *tension.shape)) for arrays, z in steps]
    by_z[:, 6 : 6 + m] = np.moveaxis(np.concatenate(moved) - tension, 0, -1) / _STEP
    return base, slope, by_z


def _stepped(arrays: RobotArrays, point: Point) -> Iterator[RobotArrays]:
    """The point's robot with each number of a term a step further, (d, 1) of them, term after term."""
    for i in range(len(point.terms)):
        found = arrays
        for j, (term, z) in enumerate(zip(point.terms, point.z, strict=True)):
            found = term.applied(found, z + _STEP * np.eye(len(z))[:, None] if i == j else z[None])
        yield found


def _meant(data: Recorded, arrays: RobotArrays, readings: Readings) -> np.ndarray:
    """(..., S, m) tensions at the platform [N]; batch axes are those of the robot."""
    return true_tension(at_states(arrays, data.known), readings, data.known)

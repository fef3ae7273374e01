"""Where did the platform rest in states whose pose was not read in full? As lengths, balance and all else say.

First the equilibrium at the lengths that were read, which is near, then the pose and tensions that fit all readings of
the state best: a least-squares problem of its own in each state, of all that was read and a wide prior on the rest.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.errors import CdprError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import at_states, static_residuals
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.equilibrium import rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward

_BALANCE, _FIT = 0.05, 1e-4  # N, m: how exactly balance and the lengths of cables are met
_ROUNDS = 60  # of the least-squares problem; a few are enough near the answer
_STILL = 1e-3  # of a sigma, or of a prior's: so small is a step that matters no more
_STEP, _PULL = 1e-5, 1e-3  # m, rad, and N, of differences
_FIELDS = ("position", "rotation", "tension", "length")  # of `Readings`
_FIRST, _LESS, _MORE, _LEAST, _MOST = 1e-3, 0.2, 5.0, 1e-9, 1e9  # damping, and how it goes on


def at_lengths(
    arrays: RobotArrays, known: Circumstances, readings: Readings, read: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Positions (S, 3) and rotations (S, 3, 3) with equilibria at the lengths read where a pose reading is missing.

    read (S, 6) : bool, of the pose.  Numbers of the pose that were read stay. Where a length is missing, or there is no
    equilibrium, the pose stays as it is.
    """
    position, rotation = readings.position.copy(), readings.rotation.copy()
    lacking = ~read.all(axis=1) & np.isfinite(readings.length).all(axis=1)
    there = at_states(arrays, known)
    for placed in (True, False):
        some = np.flatnonzero(lacking & (read[:, :3].all(axis=1) == placed))
        if not len(some):
            continue
        start = position[some] if placed else None
        try:
            found = forward(there.take(some), readings.length[some], start, rotation[some], known.model)
        except CdprError:
            continue
        at = found.converged[:, None]
        position[some] = np.where(at & ~read[some, :3], found.position, position[some])
        before, after = angles_from_rotation(rotation[some]), angles_from_rotation(found.rotation)
        angles = np.where(at & ~read[some, 3:], after, before)
        rotation[some] = np.array([rotation_from_angles(*own) for own in angles])
    return position, rotation


@dataclass(frozen=True, slots=True, eq=False)
class Spread:
    """One sigma of each reading of S states (S, 6 + 2 m), as stated or of what was not read, and which were read."""

    sigma: np.ndarray
    read: np.ndarray
    unread: np.ndarray

    @property
    def of_all(self) -> np.ndarray:
        """(S, 6 + 2 m)."""
        return np.where(self.read, self.sigma, self.unread)


def fitted_poses(
    arrays: RobotArrays, known: Circumstances, readings: Readings, spread: Spread, radius: float
) -> Readings:
    """Readings whose missing poses are those that fit all else; missing tensions and lengths follow them."""
    some = np.flatnonzero(~spread.read[:, :6].all(axis=1))
    if not len(some):
        return readings
    m = arrays.cable_count
    own = Readings(*(getattr(readings, name)[some] for name in _FIELDS))
    shift = _Fit(arrays, known.at(some), own, spread.of_all[some], radius).solved()
    pose, tension = np.split(np.where(spread.read[some, : 6 + m], 0.0, shift), [6], axis=1)
    fitted = own.less(pose, tension, np.zeros((len(some), m)))
    gap = static_residuals(arrays, own.less(shift[:, :6], shift[:, 6:], np.zeros(m)), known.at(some), radius)[:, 6:]
    length = np.where(spread.read[some, 6 + m :], own.length, own.length - gap)
    position, rotation, tensions, lengths = (np.array(getattr(readings, n)) for n in _FIELDS)
    position[some], rotation[some] = fitted.position, _kept(own.rotation, pose[:, 3:])
    tensions[some], lengths[some] = fitted.tension, length
    return replace(readings, position=position, rotation=rotation, tension=tensions, length=lengths)


def _kept(rotation: np.ndarray, turn: np.ndarray) -> np.ndarray:
    return np.asarray(rotation_from_vector(-turn) @ rotation)


class _Fit:
    """Least squares of K states in errors of pose and tensions (K, 6 + m) of their readings."""

    def __init__(
        self, arrays: RobotArrays, known: Circumstances, readings: Readings, sigma: np.ndarray, radius: float
    ) -> None:
        self.arrays, self.known, self.readings, self.radius = arrays, known, readings, radius
        self.m = arrays.cable_count
        self.own = sigma[:, : 6 + self.m]
        rows = np.full((len(sigma), 6), _BALANCE)
        self.rows = np.concatenate([rows, np.hypot(sigma[:, 6 + self.m :], _FIT)], axis=1)

    def residuals(self, error: np.ndarray) -> np.ndarray:
        """(..., K, 6 + m) balance and lengths, in `rows`, at errors (..., K, 6 + m)."""
        there = self.readings.less(error[..., :6], error[..., 6:], np.zeros(self.m))
        return static_residuals(self.arrays, there, self.known, self.radius) / self.rows

    def solved(self) -> np.ndarray:
        """(K, 6 + m) errors, by damped Gauss-Newton steps; the best found where they have not settled."""
        k, n = self.own.shape
        error, damping = np.zeros((k, n)), np.full(k, _FIRST)
        r = self.residuals(error)
        for _ in range(_ROUNDS):
            slope = self._slope(error, r) * self.own[:, None, :]
            u = error / self.own
            normal = np.swapaxes(slope, 1, 2) @ slope + np.eye(n)
            damped = normal + damping[:, None, None] * np.einsum("kii->ki", normal)[:, :, None] * np.eye(n)
            down = np.einsum("krn,kr->kn", slope, r) + u
            step = -np.linalg.solve(damped, down[..., None])[..., 0]
            trial = error + step * self.own
            other = self.residuals(trial)
            better = self._cost(trial, other) <= self._cost(error, r)
            error = np.where(better[:, None], trial, error)
            r = np.where(better[:, None], other, r)
            damping = np.clip(damping * np.where(better, _LESS, _MORE), _LEAST, _MOST)
            if (better & (np.abs(step).max(axis=1) < _STILL)).all():
                break
        return error

    def _cost(self, error: np.ndarray, r: np.ndarray) -> np.ndarray:
        return np.asarray((r**2).sum(axis=-1) + ((error / self.own) ** 2).sum(axis=-1))

    def _slope(self, error: np.ndarray, r: np.ndarray) -> np.ndarray:
        """(K, 6 + m, 6 + m) change of the residuals, the rows, with the errors [1/m, 1/rad, 1/N]."""
        n = error.shape[1]
        size = np.concatenate([np.full(6, _STEP), np.full(self.m, _PULL)])
        moved = self.residuals(error + (size * np.eye(n))[:, None, :])
        return np.asarray(np.moveaxis((moved - r) / size[:, None, None], 0, -1))

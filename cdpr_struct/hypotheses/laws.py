"""Laws outside the library, told by the channel through which they act.

Whatever happens to a robot acts through a force on the platform, the place of its weight, or an error of a reading
(tension, length, pose) that depends on something known: position, tilt, payload, tension, length, direction of the last
motion. Each channel is a family of such laws with random coefficients, linear in them; none changes the model.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Pattern
from cdpr_struct.residuals.linearised import Local
from cdpr_struct.robot.robot_arrays import plus

UNKNOWN = "unknown"
"""Name of every hypothesis that no cause of the library explains."""
_PRIOR = 0.4  # of the typical sizes below, at the scale 1: all coefficients of a law together
_FORCE, _PLACE, _LENGTH = 10.0, 0.01, 2e-3  # typical sizes [N], [m], [m]
_TENSION = 0.02  # of the mean tension
_POSE = 5.0  # sigmas of the tracker
_PERIODS = 24  # of errors that repeat along the cable, between
_SHORTEST_PERIOD = 0.15  # m, and half the range of lengths: a small drum's turn
_LEAST_LENGTHS = 8  # lengths of a cable: fewer hold no period


@dataclass(frozen=True, slots=True, eq=False)
class Law:
    """A family of laws: words for its channel, and columns -dR/dz (S, 6 + m, d), z of the order of one."""

    channel: str
    words: str
    columns: np.ndarray


def laws(local: Local) -> list[Law]:
    """Every family that the data of a campaign could show, about a point."""
    parts = _Parts.of(local)
    found = [*_of_force_and_place(parts), *_of_tensions(parts), *_of_lengths(parts), *_of_poses(parts)]
    return [law for law in found if law.columns.size and np.abs(law.columns).max() > 0.0]


OUTSIDE = Cause(UNKNOWN, "a law that the library does not know", (), lambda arrays, theta: arrays)


def patterns(found: list[Law]) -> tuple[Pattern, ...]:
    """Each law as a pattern of its own, all channels equally likely, and within one all its laws."""
    channels = [law.channel for law in found]
    rows, start, total = [], 0, sum(law.columns.shape[-1] for law in found)
    for law in found:
        d = law.columns.shape[-1]
        basis = np.zeros((total, d))
        basis[start : start + d] = np.eye(d)
        start += d
        named = tuple(Parameter(f"{law.channel}_{i}", "1", _PRIOR / np.sqrt(d)) for i in range(d))
        rows.append(Pattern(law.words, basis, named, 1.0 / (len(set(channels)) * channels.count(law.channel))))
    return tuple(rows)


@dataclass(frozen=True, slots=True, eq=False)
class _Parts:
    """What one unit of each kind of error does to a state's rows, (S, 6 + m, .), and what is known of the states."""

    pose: np.ndarray
    tension: np.ndarray
    length: np.ndarray
    force: np.ndarray
    place: np.ndarray
    position: np.ndarray
    turn: np.ndarray
    payload: np.ndarray
    pull: np.ndarray
    approach: np.ndarray
    lengths: np.ndarray
    typical: float

    @classmethod
    def of(cls, local: Local) -> "_Parts":
        data, m = local.data, local.data.cables
        by_noise = local.by_noise().static
        sigma, read = data.sigma, data.read
        readings, known = data.readings, data.known
        spread = np.maximum(readings.position.std(axis=0), 1e-3)
        turn = Rotation.from_matrix(readings.rotation).as_rotvec()
        tension = by_noise[..., 6 : 6 + m] / sigma[:, None, 6 : 6 + m] * read[:, None, 6 : 6 + m]
        length = by_noise[..., 6 + m :] / sigma[:, None, 6 + m :] * read[:, None, 6 + m :]
        moved = local.of_three(lambda arrays, z: plus(arrays, force=z), 0.1)
        placed = local.of_three(lambda arrays, z: plus(arrays, center_of_mass=z), 1e-4)
        return cls(
            pose=by_noise[..., :6] * read[:, None, :6], tension=tension, length=length, force=moved, place=placed,
            position=(readings.position - readings.position.mean(axis=0)) / spread,
            turn=turn / max(float(np.abs(turn).max()), 1e-3),
            payload=known.payload / max(float(np.ptp(known.payload)), 1e-9),
            pull=readings.tension / known.mean_tension - 1.0, approach=known.approach,
            lengths=readings.length, typical=_TENSION * known.mean_tension,
        )  # fmt: skip


def _law(effect: np.ndarray, features: np.ndarray) -> np.ndarray:
    """(S, r, f * k): each of k kinds of effect (S, r, k) in proportion to each feature (S, f)."""
    columns = np.einsum("srk,sf->srfk", effect, features)
    return np.asarray(columns.reshape((*effect.shape[:2], -1)))


def _of_force_and_place(parts: _Parts) -> Iterator[Law]:
    x = parts.position
    squares = np.stack([x[:, i] * x[:, j] for i in range(3) for j in range(i, 3)], axis=1)
    load = np.stack([parts.payload, parts.payload**2], axis=1)
    tilted = np.linalg.norm(parts.turn, axis=1, keepdims=True)
    words = "a force on the platform that changes with position or payload"
    for features in (x, np.abs(x), squares, load):
        yield Law("force", words, _FORCE * _law(parts.force, features))
    words = "a centre of mass that moves with tilt or payload"
    for features in (parts.turn, tilted, load, x):
        yield Law("place", words, _PLACE * _law(parts.place, features))


def _of_tensions(parts: _Parts) -> Iterator[Law]:
    effect, pull = parts.typical * parts.tension, parts.pull
    whole, words = pull + 1.0, "the load cells: a law other than gain and zero"
    m = pull.shape[1]
    yield Law("tension", words, np.stack([np.einsum("srm,sm->sr", effect, pull**p) for p in (2, 3)], axis=-1))
    yield Law("tension", words, np.concatenate([effect * pull[:, None, :] ** p for p in (2, 3)], axis=-1))
    cross = np.einsum("srm,sj->srmj", effect, whole)[..., ~np.eye(m, dtype=bool)]
    yield Law("tension", words, cross)
    for neighbour in (1, -1):
        yield Law("tension", words, np.einsum("srm,sm->sr", effect, np.roll(whole, neighbour, axis=1))[..., None])
    for power in (2, 3):
        yield Law("tension", words, np.einsum("srm,sm->sr", effect, whole**power)[..., None])
    if np.any(parts.approach):
        yield from _signed("tension_direction", "the load cells", effect, parts.approach)


def _signed(channel: str, who: str, effect: np.ndarray, approach: np.ndarray) -> Iterator[Law]:
    words, signed = f"{who}: an error with the sign of the last motion", effect * approach[:, None, :]
    yield Law(channel, words, signed.sum(axis=-1, keepdims=True))
    yield Law(channel, words, signed)


def _of_lengths(parts: _Parts) -> Iterator[Law]:
    effect, value = _LENGTH * parts.length, parts.lengths
    centred = (value - value.mean()) / max(float(value.std()), 1e-3)
    words = "the lengths: a law other than scale and zero"
    yield Law("length", words, np.stack([np.einsum("srm,sm->sr", effect, centred**p) for p in (2, 3)], axis=-1))
    yield Law("length", words, np.concatenate([effect * centred[:, None, :] ** p for p in (2, 3)], axis=-1))
    if len(np.unique(value[:, 0])) >= _LEAST_LENGTHS:
        words = "the lengths: an error that repeats along the cable"
        longest = 0.5 * max(float(np.ptp(value)), 0.4)
        for period in np.geomspace(_SHORTEST_PERIOD, longest, _PERIODS):
            angle = 2.0 * np.pi * value[:, None, :] / period
            waves = [effect * np.cos(angle), effect * np.sin(angle)]
            yield Law("length_periodic", words, np.stack([wave.sum(axis=-1) for wave in waves], axis=-1))
            yield Law("length_periodic", words, np.concatenate(waves, axis=-1))
    if np.any(parts.approach):
        yield from _signed("length_direction", "the lengths", effect, parts.approach)


def _of_poses(parts: _Parts) -> Iterator[Law]:
    words, x = "the tracker: an error that changes with the pose", parts.position
    for features in (x, parts.turn, np.stack([(x[:, :2] ** 2).sum(axis=1)], axis=1)):
        yield Law("pose", words, _POSE * _law(parts.pose, features))

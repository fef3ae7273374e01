"""Laws outside the library, identified by the quantity through which they act.

Whatever happens to a robot acts through a force on the platform, the place of its weight, or an error of a reading
(tension, length, pose), and it changes with something known: position, tilt, payload, time, tension, length, direction
of the last motion. Each channel is a family of such laws with random coefficients, linear in them; none changes the
model. Where no formula is in sight, a Gaussian process over the position stands for any smooth one (Kennedy and
O'Hagan, Bayesian calibration of computer models, 2001).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Pattern
from cdpr_struct.hypotheses.periods import likeliest_periods
from cdpr_struct.residuals.linearised import Local, Outside, RowStates
from cdpr_struct.robot.changed_arrays import plus

UNKNOWN = "unknown"
"""Name of every hypothesis that no cause of the library explains."""
_PRIOR = 0.4  # of the typical sizes below, at the scale 1: all coefficients of a law together
_FORCE, _PLACE, _LENGTH = 10.0, 0.01, 2e-3  # typical sizes [N], [m], [m]
_TENSION = 0.02  # of the mean tension
_POSE = 5.0  # sigmas of the tracker
_TILTED = 10.0  # sigmas rms of tilts: noise that a law of the tilt takes off then adds a nat in 200 readings
_SMOOTH = 10  # functions that a Gaussian process over the position is made of
_LEAST_LENGTHS = 8  # lengths of a cable: fewer hold no period
_CELLS, _LENGTHS = "an error of the load cells", "an error of the cable lengths"


@dataclass(frozen=True, slots=True, eq=False)
class Law:
    """A family of laws: words for its channel, and columns -dR/dz of d numbers z of the order of one.

    stands_for : how many of its channel it was picked from, for each that was picked
    """

    channel: str
    words: str
    columns: Outside
    stands_for: float = 1.0


def laws(local: Local) -> list[Law]:
    """Every family that the data of a campaign could show, about a point."""
    known = _Known.of(local)
    found = [*_of_force_and_place(local, known), *_of_tensions(local, known)]
    found += [*_of_lengths(local, known), *_of_poses(local, known)]
    return [law for law in found if law.columns.count and np.abs(law.columns.static).max() > 0.0]


OUTSIDE = Cause(UNKNOWN, "a law outside the library", (), lambda arrays, theta: arrays)


def patterns(found: list[Law]) -> tuple[Pattern, ...]:
    """Each law as a pattern of its own, all channels equally likely, and within one all its laws."""
    channels = [law.channel for law in found]
    rows, start, total = [], 0, sum(law.columns.count for law in found)
    for law in found:
        d = law.columns.count
        basis = np.zeros((total, d))
        basis[start : start + d] = np.eye(d)
        start += d
        named = tuple(Parameter(f"{law.channel}_{i}", "1", _PRIOR / np.sqrt(d)) for i in range(d))
        weight = 1.0 / (len(set(channels)) * channels.count(law.channel) * law.stands_for)
        rows.append(Pattern(law.words, basis, named, weight))
    return tuple(rows)


@dataclass(frozen=True, slots=True, eq=False)
class _Known:
    """What is known of the S states, of the order of one; `of_states` (S, f) by words, others (S, m) by cable."""

    of_states: dict[str, np.ndarray]
    pull: np.ndarray
    lengths: np.ndarray
    approach: np.ndarray
    tension: float

    @classmethod
    def of(cls, local: Local) -> "_Known":
        readings, known = local.data.readings, local.data.known
        x = (readings.position - readings.position.mean(axis=0)) / np.maximum(readings.position.std(axis=0), 1e-3)
        turn = _tilts(local)
        turn = turn / max(float(np.abs(turn).max()), 1e-3)
        load = known.payload / max(float(np.ptp(known.payload)), 1e-9)
        day = np.linspace(-1.0, 1.0, len(x))  # states are filed in the order in which they were measured
        of_states = {
            "the position": x,
            "the position, alike on both sides": np.abs(x),
            "the position squared": np.stack([x[:, i] * x[:, j] for i in range(3) for j in range(i, 3)], axis=1),
            "the position, smoothly": _smooth(x),
            "the payload": np.stack([load, load**2], axis=1),
            "the tilt": turn,
            "the size of the tilt": np.linalg.norm(turn, axis=1, keepdims=True),
            "time": np.stack([day, day**2], axis=1),
        }
        typical = known.mean_tension
        return cls(of_states, readings.tension / typical - 1.0, readings.length, known.approach, typical)


def _tilts(local: Local) -> np.ndarray:
    """(S, 3) rotation vectors as read, or less their noise at the point where tilts do not stand out of it.

    Read tilts that are mostly noise would make a law of the tilt out of that noise: it could take it off.
    """
    read = Rotation.from_matrix(local.data.readings.rotation).as_rotvec()
    if np.sqrt(np.mean(read**2)) > _TILTED * np.sqrt(np.mean(local.data.sigma[:, 3:6] ** 2)):
        return np.asarray(read)
    return np.asarray(Rotation.from_matrix(local.point.readings(local.data).rotation).as_rotvec())


def _smooth(x: np.ndarray) -> np.ndarray:
    """(S, f) largest parts of a Gaussian process of unit variance over places x (S, 3), correlated over one unit."""
    square = ((x[:, None] - x) ** 2).sum(axis=-1)
    values, vectors = np.linalg.eigh(np.exp(-0.5 * square))
    count = min(_SMOOTH, len(x))
    return np.asarray(vectors[:, -count:] * np.sqrt(np.maximum(values[-count:], 0.0) * count))


@dataclass(frozen=True, slots=True, eq=False)
class _Channel:
    """What one unit of each of k errors does, and the state of each row of the frequencies and swivel angles."""

    name: str
    words: str
    effect: Outside
    states: RowStates

    def law(self, words: str, share: np.ndarray, stands_for: float = 1.0) -> Law:
        """Numbers z (d,) that make the errors share (S, k, d) @ z of the states."""
        return Law(self.name, f"{self.words} {words}", self.effect.shared(share, self.states), stands_for)

    def each(self, features: np.ndarray) -> np.ndarray:
        """(S, k, k f): each error in proportion to each feature (S, f)."""
        k = self.effect.count
        return np.einsum("kl,sf->sklf", np.eye(k), features).reshape((len(features), k, -1))

    def alike(self, features: np.ndarray) -> np.ndarray:
        """(S, k, f): all errors alike in proportion to each feature (S, f)."""
        return np.repeat(features[:, None], self.effect.count, axis=1)

    def both(self, words: str, value: np.ndarray, stands_for: float = 1.0) -> Iterator[Law]:
        """In proportion to values (S, k, f) of each, alike for all and each with a factor of its own."""
        s, k, f = value.shape
        yield self.law(f"{words}, all alike", value, stands_for)
        own = np.einsum("kl,skf->sklf", np.eye(k), value).reshape((s, k, k * f))
        yield self.law(f"{words}, each its own", own, stands_for)


def _of_force_and_place(local: Local, known: _Known) -> Iterator[Law]:
    moved = local.of_three(lambda arrays, z: plus(arrays, force=z), 0.1).times(np.full(3, _FORCE))
    force = _Channel("force", "a force on the platform that changes with", moved, local.states_of_rows)
    for words, features in known.of_states.items():
        yield force.law(words, force.each(features))
    outwards = _outwards(local.data.readings.position)
    held = np.broadcast_to(np.eye(3), (len(outwards), 3, 3))  # a hose may also push at rest
    yield force.law("the distance from the middle, outwards", np.concatenate([held, outwards], axis=-1))
    states = len(known.pull)
    yield force.law("every state", force.each(np.sqrt(states) * np.eye(states)))
    placed = local.of_three(lambda arrays, z: plus(arrays, center_of_mass=z), 1e-4).times(np.full(3, _PLACE))
    place = _Channel("place", "a centre of mass that moves with", placed, local.states_of_rows)
    for words in ("the position", "the payload", "the tilt", "the size of the tilt", "time"):
        yield place.law(words, place.each(known.of_states[words]))


def _of_tensions(local: Local, known: _Known) -> Iterator[Law]:
    m, pull = local.data.cables, known.pull
    effect = local.of_reading(slice(6, 6 + m)).times(np.full(m, _TENSION * known.tension))
    cells = _Channel("tension", _CELLS, effect, local.states_of_rows)
    whole = pull + 1.0
    powers = [pull[..., None] ** p for p in (2, 3)]
    yield from cells.both("that bends with the tension", np.concatenate(powers, axis=-1))
    cross = np.einsum("kl,sj->sklj", np.eye(m), whole)[:, :, ~np.eye(m, dtype=bool)]
    yield cells.law("that changes with the other tensions", cross)
    for neighbour, words in ((1, "last"), (-1, "next")):
        yield cells.law(f"with the {words} cable's tension", np.roll(whole, neighbour, axis=1)[..., None])
    before = np.concatenate([whole[:1], whole[:-1]])  # states are filed in the order in which they were measured
    yield from cells.both("that lags behind the state before", (before - whole)[..., None])
    later = np.linspace(0.0, 1.0, len(whole))[:, None]  # calibrated before the first state
    worn = whole[..., None] * np.stack([later, later**2], axis=-1)
    yield from cells.both("in proportion to the tension that changes with time", worn)
    for power, words in ((2, "square"), (3, "cube")):
        yield cells.law(f"with the {words} of the tension", whole[..., None] ** power)
    yield from _of_readings(cells, known)
    yield from _signed(cells, known.approach)


def _of_readings(channel: _Channel, known: _Known) -> Iterator[Law]:
    """Errors that change with the state: alike for all cables, and each its own where that takes few numbers."""
    for words, features in known.of_states.items():
        yield channel.law(f"that changes with {words}, all alike", channel.alike(features))
        if features.shape[1] <= 3:
            yield channel.law(f"that changes with {words}, each its own", channel.each(features))


def _signed(channel: _Channel, approach: np.ndarray) -> Iterator[Law]:
    if np.any(approach):
        own = _Channel(f"{channel.name}_direction", channel.words, channel.effect, channel.states)
        yield from own.both("with the sign of the last motion", approach[..., None])


def _of_lengths(local: Local, known: _Known) -> Iterator[Law]:
    m, value = local.data.cables, known.lengths
    effect = local.of_reading(slice(6 + m, None)).times(np.full(m, _LENGTH))
    lengths = _Channel("length", _LENGTHS, effect, local.states_of_rows)
    centred = (value - value.mean()) / max(float(value.std()), 1e-3)
    yield from lengths.both("that bends with the length", np.stack([centred**2, centred**3], axis=-1))
    yield from _of_readings(lengths, known)
    if len(np.unique(value[:, 0])) >= _LEAST_LENGTHS:
        waving = _Channel("length_periodic", "a periodic error of the cable lengths", effect, local.states_of_rows)
        periods, tried = likeliest_periods(value, local.noisy_static()[:, 6:])
        for period in periods:
            angle = 2.0 * np.pi * value / period
            waves = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
            yield from waving.both(f"every {period:.3f} m", waves, tried / len(periods))
    yield from _signed(lengths, known.approach)


def _of_poses(local: Local, known: _Known) -> Iterator[Law]:
    sigma = local.data.sigma[:, :6].mean(axis=0) * _POSE
    for words, which in (("position", slice(0, 3)), ("orientation", slice(3, 6))):
        effect = local.of_reading(which).times(sigma[which])
        tracker = _Channel("pose", f"an error of the tracker's {words} that changes with", effect, local.states_of_rows)
        for feature, values in known.of_states.items():
            yield tracker.law(feature, tracker.each(values))
        if words == "position":
            yield tracker.law("the distance from the middle, outwards", _outwards(local.data.readings.position))


def _outwards(position: np.ndarray) -> np.ndarray:
    """(S, 3, 2) with the distance and with its cube, as lenses move what a camera sees and hoses pull."""
    x = position - position.mean(axis=0)
    x = x / max(float(np.sqrt((x**2).sum(axis=-1).mean())), 1e-3)
    return np.stack([x, (x**2).sum(axis=-1, keepdims=True) * x], axis=-1)

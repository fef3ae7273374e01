"""Is what is left over still structured? Laws outside the library, told by the channel through which they act.

Whatever happens to a robot acts through a force on the platform, the place of its weight, or an error of a reading
(tension, length, pose, frequency) that depends on something known: position, tilt, payload, tension, length,
direction of the last motion. Each channel is a family of such laws with random coefficients; its evidence is that of
a cause.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter, Pattern
from cdpr_struct.diagnosis.evidence import Candidate
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.world import World

_WIDTHS = (0.2, 1.0, 5.0)  # of the prior, beside the scales of every cause
_FORCE, _PLACE, _LENGTH = 10.0, 0.01, 2e-3  # typical sizes [N], [m], [m]
_TENSION = 0.02  # of the mean tension
_POSE = 5.0  # sigmas of the tracker
_PERCENT = 1.0  # of a frequency
_PERIODS = 24
_LEAST_ROWS = 8


@dataclass(frozen=True, slots=True, eq=False)
class Channel:
    """A family of laws: where it acts, in words, and alternatives of residual changes (n, d) per typical size."""

    name: str
    words: str
    columns: list[np.ndarray]


def channels(setting: Setting, world: World, readings: Readings, null: NullModel) -> list[Candidate]:
    """Channels that these data can show, as candidates beside the causes."""
    parts = _Parts(setting, world, readings, null)
    return [_candidate(channel, null) for channel in _all(parts) if channel.columns]


def _candidate(channel: Channel, null: NullModel) -> Candidate:
    """Every alternative at every width is a pattern."""
    sizes = [c.shape[1] for c in channel.columns]
    patterns, start = [], 0
    for size in sizes:
        basis = np.zeros((sum(sizes), size))
        basis[start : start + size] = np.eye(size)
        for width in _WIDTHS:
            named = tuple(Parameter(f"{channel.name}_{i}", "1", width / np.sqrt(size)) for i in range(size))
            patterns.append(Pattern("", basis, named, 1.0 / (len(sizes) * len(_WIDTHS))))
        start += size
    cause = Cause(channel.name, channel.words, (), _nothing)
    return Candidate(cause, null.white(np.hstack(channel.columns)), patterns)


def _nothing(world: World, theta: np.ndarray) -> World:
    """Channels have no model that could be applied."""
    return world


class _Parts:
    """Changes of the residuals by what happens in each state, (n, S, .), and what is known of the states."""

    def __init__(self, setting: Setting, world: World, readings: Readings, null: NullModel) -> None:
        states, self.setting = setting.campaign.states, setting
        self.m, self.count = world.cables, len(states.names)
        s, m, n = self.count, self.m, len(setting.labels)
        self.pose = null.columns[:, : 6 * s].reshape((n, s, 6))
        sigma = np.where(np.isfinite(states.tension_sigma), states.tension_sigma, 1.0)
        self.tension = null.columns[:, 6 * s : (6 + m) * s].reshape((n, s, m)) / sigma
        self.length, self.locks = self._lengths(null, s, m), int(states.lock.max()) + 1
        base = residuals(setting, world, readings, small=True)
        self.force = self._by_state(residuals(setting, world.plus(force=0.1 * np.eye(3)), readings, True) - base) / 0.1
        moved = residuals(setting, world.plus(center_of_mass=1e-4 * np.eye(3)), readings, True) - base
        self.place = self._by_state(moved) / 1e-4
        spread = np.maximum(readings.position.std(axis=0), 1e-3)
        self.position = (readings.position - readings.position.mean(axis=0)) / spread
        turn = Rotation.from_matrix(readings.rotation).as_rotvec()
        self.turn = turn / max(float(np.abs(turn).max()), 1e-3)
        self.payload = setting.known.payload / max(float(np.ptp(setting.known.payload)), 1e-9)
        mean = setting.known.mean_tension
        self.typical = _TENSION * mean
        self.pull = np.nan_to_num(readings.tension, nan=mean) / mean - 1.0
        self.approach = setting.known.approach

    def _lengths(self, null: NullModel, s: int, m: int) -> np.ndarray:
        """(n, locks, m) per metre of length reading."""
        states = self.setting.campaign.states
        locks = int(states.lock.max()) + 1
        sigma = np.ones((locks, m))
        known = np.flatnonzero(states.lock >= 0)
        sigma[states.lock[known]] = np.where(np.isfinite(states.length_sigma[known]), states.length_sigma[known], 1.0)
        columns = null.columns[:, (6 + m) * s : (6 + m) * s + locks * m]
        result: np.ndarray = columns.reshape((len(columns), locks, m)) / sigma
        return result

    def _by_state(self, effect: np.ndarray) -> np.ndarray:
        """(n, S, k) from the joint effect (k, n) on all states."""
        result = np.zeros((effect.shape[1], self.count, effect.shape[0]))
        rows = np.arange(effect.shape[1])
        result[rows, self.setting.labels.state] = effect.T
        return result

    def of_lock(self, value: np.ndarray) -> np.ndarray:
        """(locks, ...) value of the first state of each lock."""
        lock = self.setting.campaign.states.lock
        return value[[int(np.flatnonzero(lock == k)[0]) for k in range(self.locks)]]


def _law(effect: np.ndarray, features: np.ndarray) -> np.ndarray:
    """(n, f * k): each of k kinds of effect (n, S, k) in proportion to each feature (S, f)."""
    columns: np.ndarray = np.einsum("nsk,sf->nfk", effect, features).reshape((len(effect), -1))
    return columns


def _all(parts: _Parts) -> Iterator[Channel]:
    squares = np.einsum("si,sj->sij", parts.position, parts.position).reshape((parts.count, -1))[:, [0, 1, 2, 4, 5, 8]]
    load = np.stack([parts.payload, parts.payload**2], axis=1)
    force, place = _FORCE * parts.force, _PLACE * parts.place
    yield Channel(
        "force_law", "a force on the platform that changes with position or payload",
        [_law(force, parts.position), _law(force, np.abs(parts.position)), _law(force, squares), _law(force, load)],
    )  # fmt: skip
    tilted = np.linalg.norm(parts.turn, axis=1, keepdims=True)
    yield Channel(
        "place_law", "a centre of mass that moves with tilt or payload",
        [_law(place, parts.turn), _law(place, tilted), _law(place, load), _law(place, parts.position)],
    )  # fmt: skip
    if parts.setting.held.size:
        yield from _of_tensions(parts)
    if parts.locks:
        yield from _of_lengths(parts)
    yield from _of_poses_and_frequencies(parts)


def _of_tensions(parts: _Parts) -> Iterator[Channel]:
    effect = parts.typical * parts.tension
    bent = [np.einsum("nsm,sm->n", effect, parts.pull**p)[:, None] for p in (2, 3)]
    own = [np.einsum("nsm,sm->nm", effect, parts.pull**p) for p in (2, 3)]
    cross = np.einsum("nsm,sj->nmj", effect, parts.pull + 1.0)
    curved = [np.einsum("nsm,sm->n", effect, (parts.pull + 1.0) ** p)[:, None] for p in (2, 3)]  # right at zero
    others = ~np.eye(parts.m, dtype=bool)
    ring = [np.einsum("nsm,sm->n", effect, np.roll(parts.pull + 1.0, k, axis=1))[:, None] for k in (1, -1)]
    found = [np.hstack(bent), np.hstack(own), cross[:, others], *ring, *curved]
    yield Channel("tension_law", "the load cells: a law other than gain and zero", found)
    if np.any(parts.approach):
        signed = np.einsum("nsm,sm->nm", effect, parts.approach)
        found = [signed.sum(axis=1, keepdims=True), signed]
        yield Channel("tension_direction", "the load cells: an error with the sign of the last motion", found)
    columns = effect.reshape((len(effect), -1))
    yield Channel("tension_scatter", "the load cells: more scatter than stated", [columns])


def _of_lengths(parts: _Parts) -> Iterator[Channel]:
    lock = parts.setting.campaign.states.lock
    value = parts.of_lock(parts.setting.campaign.states.length)
    known = np.isfinite(value)
    effect = _LENGTH * np.where(known, parts.length, 0.0)
    value = np.where(known, value, np.nanmean(value))
    centred = (value - value.mean()) / max(float(value.std()), 1e-3)
    bent = [np.einsum("nsm,sm->n", effect, centred**p)[:, None] for p in (2, 3)]
    own = [np.einsum("nsm,sm->nm", effect, centred**p) for p in (2, 3)]
    yield Channel("length_law", "the lengths: a law other than scale and zero", [np.hstack(bent), np.hstack(own)])
    if len(value) >= _LEAST_ROWS:
        waves = []
        for period in np.geomspace(0.15, 0.5 * max(float(np.ptp(value)), 0.4), _PERIODS):
            turn = 2.0 * np.pi * value / period
            parts_of = [np.einsum("nsm,sm->nm", effect, wave) for wave in (np.cos(turn), np.sin(turn))]
            waves.append(np.hstack([p.sum(axis=1, keepdims=True) for p in parts_of]))
            waves.append(np.hstack(parts_of))
        yield Channel("length_periodic", "the lengths: an error that repeats along the cable", waves)
    if np.any(parts.approach):
        sign = np.array([parts.approach[np.flatnonzero(lock == k)[0]] for k in range(parts.locks)])
        signed = np.einsum("nsm,sm->nm", effect, sign)
        found = [signed.sum(axis=1, keepdims=True), signed]
        yield Channel("length_direction", "the lengths: an error with the sign of the last motion", found)
    yield Channel("length_scatter", "the lengths: more scatter than stated", [effect.reshape((len(effect), -1))])


def _of_poses_and_frequencies(parts: _Parts) -> Iterator[Channel]:
    effect = _POSE * parts.pose
    found = [_law(effect, parts.position), _law(effect, parts.turn), effect.reshape((len(effect), -1))]
    yield Channel("pose_law", "the tracker: an error that changes with the pose", found)
    labels, setting = parts.setting.labels, parts.setting
    rows = np.flatnonzero(labels.block == "CF")
    if rows.size >= _LEAST_ROWS:
        mode, state = setting.cable_rows.mode, setting.cable_rows.state
        pull = parts.pull[state, setting.cable_rows.cable]
        features = np.stack([mode - mode.mean(), (mode - mode.mean()) ** 2, pull, pull**2], axis=1)
        yield Channel("cable_frequency_law", "the cable frequencies: a law of mode or tension", [
            _rows_of(rows, len(labels), features)])  # fmt: skip
    rows = np.flatnonzero(labels.block == "RF")
    if rows.size >= _LEAST_ROWS:
        log = np.log(setting.campaign.robot_frequencies.hertz)
        features = np.stack([log**0, log - log.mean(), (log - log.mean()) ** 2], axis=1)
        yield Channel("robot_frequency_law", "the robot frequencies: a law of frequency", [
            _rows_of(rows, len(labels), features)])  # fmt: skip


def _rows_of(rows: np.ndarray, count: int, features: np.ndarray) -> np.ndarray:
    columns = np.zeros((count, features.shape[1]))
    columns[rows] = _PERCENT * features
    return columns

"""Modes in accelerations under unknown random forces: stable poles, their scatter over blocks, a check by halves."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.ambient_choice import AmbientChoice
from cdpr_struct.measurement.periodic_forces import periodic_forces
from cdpr_struct.measurement.pole_scatter import Scatter, scatter
from cdpr_struct.measurement.pole_tracks import Track, tracks
from cdpr_struct.measurement.subspace_poles import Poles, hankel, poles

BLOCKS = 20  # contiguous parts of a record whose scatter gives sigmas
MOST_ORDER = 100  # states
EVERY = 10  # states between the orders over whose poles a mode is averaged
LEAST_SHARE = 0.3  # of all orders at which the poles of a mode are stable
LEAST_ASKED = 5  # orders of a mode that the user asks for
_SIZE = 360  # rows of the Hankel matrix, about
_FEWEST_ROWS, _MOST_ROWS = 20, 60  # block rows
_LARGEST_SIGMA = 0.01  # of a frequency: a pole less certain is no mode
_LARGEST_RATIO = 10.0  # the same in units of the least that a mode of its damping can have
_FOUND = 0.8  # of the blocks without which a mode must still be found
_ALIKE, _SPLIT = 2.0, 0.2  # sigmas and 1 - assurance within which two tracks are one mode
_WANTED = 0.05  # of a frequency asked for: how far its mode may be


@dataclass(frozen=True, slots=True, eq=False)
class AmbientModes:
    """k modes identified in an ambient record of c channels, in ascending order.

    hertz, hertz_sigma     : (k,) undamped natural frequency [Hz]
    damping, damping_sigma : (k,) ratio [-]
    shape  : (k, c) complex, the largest component 1, accelerations
    orders : (k,) number of model orders at which it is stable
    halves : (k,) frequency of the second half of the record less that of the first, in its own sigmas; nan if a half
             does not show the mode
    periodic : (k,) bool, no mode but a periodic force
    """

    hertz: np.ndarray
    hertz_sigma: np.ndarray
    damping: np.ndarray
    damping_sigma: np.ndarray
    shape: np.ndarray
    orders: np.ndarray
    halves: np.ndarray
    periodic: np.ndarray

    def __len__(self) -> int:
        return len(self.hertz)


@dataclass(frozen=True, slots=True, eq=False)
class Diagram:
    """Stabilisation diagram: p poles of all orders.

    order, hertz, damping : (p,) number of states, [Hz], [-]
    track  : (p,) bool, stable: it goes on from a pole of a lower order, or into one of a higher
    chosen : (p,) number of the mode that it is part of, -1 for none
    """

    order: np.ndarray
    hertz: np.ndarray
    damping: np.ndarray
    stable: np.ndarray
    chosen: np.ndarray


def ambient_modes(signal: np.ndarray, step: float, choice: AmbientChoice) -> tuple[AmbientModes, Diagram]:
    """Modes of a signal (n, c), thinned to what its band needs.

    step : between samples [s]
    """
    spread = signal.std(axis=0)
    rows = block_rows(signal.shape[1])
    whole = hankel((signal - signal.mean(axis=0)) / spread, rows, BLOCKS)
    found = poles(whole.matrix, rows, _most(rows * signal.shape[1] // 2, choice), step)
    all_tracks = tracks(found)
    candidates = _candidates(found, all_tracks, choice)
    about = scatter(whole, found, candidates, step, step * len(signal), choice.order or EVERY)
    kept = _kept(found, candidates, about, step * len(signal), choice)
    chosen = about.take(kept)
    periodic = periodic_forces(signal, step, chosen.hertz, chosen.damping)
    modes = _modes(found, [candidates[i] for i in kept], chosen, spread, periodic)
    return modes, _diagram(found, all_tracks, [candidates[i] for i in kept])


def block_rows(channels: int) -> int:
    """Block rows of the Hankel matrix: lags up to twice as many samples are used."""
    return int(np.clip(_SIZE // channels, _FEWEST_ROWS, _MOST_ROWS))


def _most(largest: int, choice: AmbientChoice) -> int:
    """Highest model order: the user's, or as many as there are or are useful.

    Raises
    ------
    InputError : an order above what the channels allow.
    """
    if choice.order is not None and choice.order > largest:
        raise InputError("order", "", choice.order, f"at most {largest} with so many channels")
    return choice.order or min(MOST_ORDER, largest - largest % 2)


def _candidates(found: Poles, all_tracks: list[Track], choice: AmbientChoice) -> list[Track]:
    """Tracks that may be modes: long ones, or all poles of the order that the user chose."""
    if choice.order is not None:
        last = len(found.order) - 1
        own = np.flatnonzero(np.isfinite(found.pole[last]))
        return [Track(np.array([last]), np.array([k])) for k in own]
    least = LEAST_ASKED if choice.frequencies else LEAST_SHARE * len(found.order)
    return [t for t in all_tracks if len(t) >= least and (found.order[t.order] % EVERY == 0).any()]


def _kept(found: Poles, candidates: list[Track], about: Scatter, duration: float, choice: AmbientChoice) -> np.ndarray:
    """Numbers of the candidates that are modes, by frequency."""
    low, high = (0.0, np.inf) if choice.band is None else choice.band
    good = (about.hertz >= low) & (about.hertz <= high)
    if choice.frequencies:
        return _wanted(about, good, choice)
    good &= about.hertz_sigma < np.minimum(_LARGEST_SIGMA * about.hertz, _LARGEST_RATIO * _least_sigma(about, duration))
    good &= (about.found >= _FOUND) & np.isfinite(about.halves)
    kept: list[int] = []
    for i in sorted(np.flatnonzero(good).tolist(), key=lambda i: -len(candidates[i])):
        if not any(_same(found, (candidates[i], candidates[k]), about.take(np.array([i, k]))) for k in kept):
            kept.append(i)
    return np.array(sorted(kept, key=lambda i: float(about.hertz[i])), dtype=int)


def _least_sigma(about: Scatter, duration: float) -> np.ndarray:
    """(k,) sigma of a frequency [Hz] that no method can go below (Gersch, 1974), in a record without noise."""
    ratio = np.maximum(about.damping, 1e-6)
    return np.asarray(about.hertz * np.sqrt(ratio / (4.0 * np.pi * about.hertz * duration)))


def _same(found: Poles, two: tuple[Track, Track], about: Scatter) -> bool:
    """Whether two tracks are one mode, whose pole splits at some orders: alike in frequency and shape."""
    one, other = (_shape(found, track) for track in two)
    near = abs(about.hertz[0] - about.hertz[1]) < _ALIKE * np.hypot(*about.hertz_sigma)
    return bool(near and abs(np.vdot(one, other)) ** 2 > 1.0 - _SPLIT)


def _shape(found: Poles, track: Track) -> np.ndarray:
    """(c,) the direction that the poles of all orders share, of unit length."""
    shape: np.ndarray = np.linalg.svd(found.shape[track.order, track.pole], full_matrices=False)[2][0]
    return shape


def _wanted(about: Scatter, good: np.ndarray, choice: AmbientChoice) -> np.ndarray:
    """Numbers of the candidates nearest to the frequencies that the user asked for.

    Raises
    ------
    InputError : one that no stable pole is near.
    """
    good = good & (about.found >= _FOUND)
    kept: list[int] = []
    for hertz in sorted(choice.frequencies):
        off = np.where(good, np.abs(about.hertz / hertz - 1.0), np.inf)
        off[kept] = np.inf
        if not off.size or off.min() > _WANTED:
            near = ", ".join(f"{f:.4g}" for f in np.sort(about.hertz[good])) or "none"
            raise InputError(
                "frequencies_hz", "", hertz, f"a frequency that a stable pole is near; there are {near} Hz"
            )
        kept.append(int(off.argmin()))
    return np.array(kept, dtype=int)


def _modes(found: Poles, chosen: list[Track], about: Scatter, spread: np.ndarray, periodic: np.ndarray) -> AmbientModes:
    shapes = np.zeros((len(chosen), len(spread)), dtype=complex)
    for i, track in enumerate(chosen):
        mean = _shape(found, track) * spread
        shapes[i] = mean / mean[np.abs(mean).argmax()]
    length = np.array([len(t) for t in chosen], dtype=int)
    return AmbientModes(
        about.hertz, about.hertz_sigma, about.damping, about.damping_sigma, shapes, length, about.halves, periodic
    )


def _diagram(found: Poles, all_tracks: list[Track], chosen: list[Track]) -> Diagram:
    stable, part = np.zeros(found.pole.shape, dtype=bool), np.full(found.pole.shape, -1)
    for track in all_tracks:
        stable[track.order, track.pole] = len(track) > 1
    for number, track in enumerate(chosen):
        part[track.order, track.pole] = number
    there = np.isfinite(found.pole)
    pole, order = found.pole[there], np.broadcast_to(found.order[:, None], there.shape)[there]
    return Diagram(order, np.abs(pole) / (2.0 * np.pi), -pole.real / np.abs(pole), stable[there], part[there])

"""Frequencies and damping ratios of decays, window by window, and what large motion and friction predict for them."""

from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from cdpr_struct.dynamics.backbone import platform_partners
from cdpr_struct.dynamics.large_motion import LargeMotion
from cdpr_struct.dynamics.presliding_friction import end_tensions, end_turns, rubbing_modes
from cdpr_struct.errors import CdprError
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.neighbours import pole_doubt
from cdpr_struct.measurement.signal_states import channel_weight, modal_amplitudes

READING = 1e-3  # beside the sigma of a window: relative of a frequency, and of a damping ratio [-]
_LABELS = 100  # numbers of modes a record
BOTH, FRAME, PLATFORM_ENDS = "both", "frame", "platform"


@dataclass(frozen=True, slots=True, eq=False)
class AmplitudeRows:
    """n readings of a mode in a window of a decay; rows of one mode of one record follow each other.

    case, record, mode : (n,) name, number of the record, and number of the mode in all records
    log_hertz, hertz_sigma, damping, damping_sigma : (n,) ln of Hz, relative, [-], [-]
    amplitude : (n,) of the mode [m], turns at the platform's radius
    large : (n,) share by which large motion shifts the frequency, at the amplitudes of all modes of the record
    motions : of the w windows of all records, as `rubbing_modes` takes them: turns (w, k, 2 m, 3), omega and modal
        amplitudes (w, k);  tension : (w, 2 m) of the cable at each end [N]
    place : (n, 2) window and mode of each row in `motions`
    """

    case: tuple[str, ...]
    record: np.ndarray
    mode: np.ndarray
    log_hertz: np.ndarray
    hertz_sigma: np.ndarray
    damping: np.ndarray
    damping_sigma: np.ndarray
    amplitude: np.ndarray
    large: np.ndarray
    motions: tuple[np.ndarray, np.ndarray, np.ndarray]
    tension: np.ndarray
    place: np.ndarray

    def __len__(self) -> int:
        return len(self.log_hertz)

    def centred(self, values: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """(n, ...) less each mode's mean, weighted by 1 / sigma^2."""
        found, weight = np.array(values, dtype=float), 1.0 / sigma**2
        for label in np.unique(self.mode):
            own = self.mode == label
            found[own] -= np.tensordot(weight[own], found[own], axes=1) / weight[own].sum()
        return found

    def friction(self, presliding: np.ndarray) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        """Shifts and damping ratios (a, n) by friction at some ends of the cables, per metre of moment over tension.

        presliding : (a,) angles over which the moment builds up [rad]
        """
        count, (turns, omega, amplitudes) = len(presliding), self.motions
        tiled = (np.concatenate([part] * count) for part in (turns, omega, amplitudes))
        angles = np.repeat(presliding, len(omega))
        found = rubbing_modes(next(tiled), angles, next(tiled), next(tiled))
        half = self.tension.shape[1] // 2
        some = {BOTH: slice(None), FRAME: slice(half), PLATFORM_ENDS: slice(half, None)}
        window, own = self.place.T
        each = [part.reshape(count, *omega.shape, -1) * self.tension[:, None] for part in (found.shift, found.damping)]
        shift, damping = (
            {name: part[:, window, own, ends].sum(axis=-1) for name, ends in some.items()} for part in each
        )
        return shift, damping


def probability_still(identified: tuple[Identified, ...]) -> float | None:
    """That constant frequencies differ so much from window to window; None without decays read in windows."""
    square, freedom = 0.0, 0
    for item in identified:
        for i in _read(item):
            known, hertz, sigma, _, _ = _readings(item, i)
            weight = 1.0 / (sigma**2 + READING**2)
            square += float((weight * np.log(hertz / np.exp((weight * np.log(hertz)).sum() / weight.sum())) ** 2).sum())
            freedom += len(known) - 1
    return float(chdtrc(freedom, square)) if freedom else None


def amplitude_rows(identified: tuple[Identified, ...]) -> AmplitudeRows | None:
    """Rows of all decays with two windows or more, of the modes that are the platform's; None without any."""
    found = [part for number, item in enumerate(identified) if (part := _record(number, item)) is not None]
    if not found:
        return None
    modes = max(part.omega.shape[1] for part in found)
    motions = (
        np.concatenate([_padded(part.turns, modes, 0.0) for part in found]),
        np.concatenate([_padded(part.omega, modes, None) for part in found]),
        np.concatenate([_padded(part.amplitudes, modes, 0.0) for part in found]),
    )
    before = np.cumsum([0, *(len(part.omega) for part in found)])
    place = [part.place + np.array([first, 0]) for first, part in zip(before, found, strict=False)]
    columns = np.concatenate([part.rows for part in found]).T
    return AmplitudeRows(
        tuple(name for part in found for name in part.case),
        columns[0].astype(int),
        columns[1].astype(int),
        *(columns[2], columns[3], columns[4], columns[5], columns[6], columns[7]),
        motions,
        np.concatenate([part.tension for part in found]),
        np.concatenate(place),
    )


def _read(item: Identified) -> list[int]:
    """Modes that join the campaign, have a partner, and were read in two windows or more."""
    windows = item.windows
    if item.state is None or windows is None or item.record.kind == "frf":
        return []
    often = np.isfinite(windows.hertz).sum(axis=0) > 1
    return np.flatnonzero(item.used & (item.partner >= 0) & often).tolist()


def _readings(item: Identified, i: int) -> tuple[np.ndarray, ...]:
    """Windows (r,) in which mode i is clear; its frequency [Hz] there, relative sigma, damping ratio and sigma.

    Sigmas include what neighbouring modes may do that the signals do not distinguish.
    """
    windows = item.windows
    assert windows is not None
    known = np.flatnonzero(np.isfinite(windows.hertz[:, i]))
    hertz = windows.hertz[known, i]
    doubt = pole_doubt(item, float(windows.middle[1] - windows.middle[0]))[i] / hertz
    sigma = np.hypot(windows.hertz_sigma[known, i] / hertz, doubt)
    return known, hertz, sigma, windows.damping[known, i], np.hypot(windows.damping_sigma[known, i], doubt)


@dataclass(frozen=True, slots=True, eq=False)
class _Record:
    """One decay: rows (n, 8) and places (n, 2), and the motion in its w windows."""

    case: list[str]
    rows: np.ndarray
    place: np.ndarray
    turns: np.ndarray
    omega: np.ndarray
    amplitudes: np.ndarray
    tension: np.ndarray


def _record(number: int, item: Identified) -> _Record | None:
    """None where nothing was read in windows, or large motion does not know the robot."""
    if item.state is None or item.windows is None or not _read(item):
        return None
    state = item.state
    try:
        motion = LargeMotion.about(state.point)
        partners = dict(platform_partners(motion, state.modes.platform, state.modes.platform_energy))
        peaks = [i for i in range(len(item.modes)) if int(item.partner[i]) in partners]
        if not {*_read(item)} & {*peaks}:
            return None
        own = [int(item.partner[i]) for i in peaks]
        numbers = [partners[p] for p in own]
        coefficients = motion.leading(numbers) * np.array([motion.reach(k) for k in numbers]) ** 2
    except CdprError:
        return None
    modal = _filled(np.stack([modal_amplitudes(item, i, p) for i, p in zip(peaks, own, strict=True)], axis=1))
    rows, place = _rows(number, item, peaks, modal**2 @ coefficients.T)
    count, tension = len(modal), end_tensions(state.point)
    turns = end_turns(state.point, state.modes.platform[own])
    return _Record(
        [item.record.case] * len(rows), rows, place, np.broadcast_to(turns, (count, *turns.shape)),
        np.tile(state.modes.omega[own], (count, 1)), modal, np.tile(tension, (count, 1)),
    )  # fmt: skip


def _rows(number: int, item: Identified, peaks: list[int], shift: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Record, mode, ln f, sigma, damping, sigma, amplitude [m] and shift by large motion; window and place of each."""
    windows, state = item.windows, item.state
    assert windows is not None
    assert state is not None
    size = np.linalg.norm(windows.amplitude * channel_weight(state, item.record), axis=2)
    rows, place, used = [], [], _read(item)
    for k, i in ((k, i) for k, i in enumerate(peaks) if i in used):
        known, hertz, sigma, damping, loss_sigma = _readings(item, i)
        for w, *read in zip(known.tolist(), np.log(hertz), sigma, damping, loss_sigma, strict=True):
            rows.append((number, _LABELS * number + i, *read, size[w, i], shift[w, k]))
            place.append((w, k))
    return np.array(rows).reshape((-1, 8)), np.array(place, dtype=int).reshape((-1, 2))


def _filled(modal: np.ndarray) -> np.ndarray:
    """(w, k) amplitudes; a mode that is not clear in a window has its smallest one there."""
    least = np.where(np.isfinite(modal), modal, np.inf).min(axis=0)
    return np.asarray(np.where(np.isfinite(modal), modal, np.where(np.isfinite(least), least, 0.0)))


def _padded(values: np.ndarray, modes: int, blank: float | None) -> np.ndarray:
    """(w, k, ...) with modes at rest added; their frequency is that of the first."""
    extra = np.repeat(values[:, :1], modes - values.shape[1], axis=1)
    return np.concatenate([values, extra if blank is None else np.full_like(extra, blank)], axis=1)

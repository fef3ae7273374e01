"""Why do the frequencies of a decay change with its amplitude: large motion, friction at the cables' ends, or neither?

Large motion is no free parameter: it is what the exact statics predict at the amplitudes that were read. Friction has
two: the length r by which a cable's tension makes the moment r T at which its ends slide, and the angle over which
that moment builds up; frame ends and platform ends may have their own. Each mode keeps a frequency and a damping ratio
of its own, so that only changes count. Readings have Student's t about the prediction, since modes that exchange
energy are read badly in a short window.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from cdpr_struct.diagnosis.amplitude_rows import (
    BOTH,
    FRAME,
    PLATFORM_ENDS,
    READING,
    AmplitudeRows,
    amplitude_rows,
    probability_still,
)
from cdpr_struct.hypotheses.detectable import FALSE_ALARMS, NAMED
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.loss import Loss

_USUAL = Loss()
_FREEDOM = 4.0  # of Student's t
_ANGLES = np.deg2rad(np.geomspace(0.02, 2.0, 9))  # prior of the presliding angle, level in its logarithm
_RADII = {1: np.geomspace(1e-6, 1e-2, 81), 2: np.geomspace(1e-6, 1e-2, 33)}  # prior of r [m], of one or two

HYPOTHESES = ((BOTH,), (PLATFORM_ENDS,), (FRAME,), (PLATFORM_ENDS, FRAME))
"""Where friction acts: alike at both ends, at one of them, or at each with sizes of its own."""
Table = tuple[dict[str, np.ndarray], dict[str, np.ndarray]]
"""Shifts and damping ratios per metre, as `AmplitudeRows.friction` gives them."""
Sized = tuple[float, float, float]
"""Median, 2.5 % and 97.5 %."""


@dataclass(frozen=True, slots=True)
class EndFriction:
    """Friction at some ends of the cables: moment over tension [m], and the angle [rad] over which it builds up."""

    ends: str
    radius: Sized
    angle: Sized


@dataclass(frozen=True, slots=True, eq=False)
class FrictionFit:
    """Friction beside large motion.

    parts : one, or two where both ends have their own;  gain : evidence against large motion alone [nat]
    shift : (n,) mean share by which it shifts each row;  held_out : (n,) the same as predicted by the other records
    """

    parts: tuple[EndFriction, ...]
    gain: float
    shift: np.ndarray
    held_out: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class AmplitudeFinding:
    """status : adequate (no change beyond noise), large_motion, friction, or unknown (neither explains the change)

    p_still : of frequencies that do not change;  large_gain : of large motion against small [nat]
    fits : of friction, likeliest first;  rows : None where frequencies do not change, or no mode is the platform's
    """

    status: str
    p_still: float
    large_gain: float
    fits: tuple[FrictionFit, ...]
    rows: AmplitudeRows | None

    @property
    def rivals(self) -> tuple[FrictionFit, ...]:
        """Fits of friction that the data do not tell from the likeliest."""
        return tuple(fit for fit in self.fits if fit.gain > self.fits[0].gain - _USUAL.nats_of_a_class)


def changes(rows: AmplitudeRows, values: np.ndarray) -> np.ndarray:
    """(modes,) by how much values (n,) change from the first to the last window of each mode."""
    ends = [np.flatnonzero(rows.mode == label)[[0, -1]] for label in dict.fromkeys(rows.mode.tolist())]
    return np.array([values[last] - values[first] for first, last in ends])


def amplitude_finding(identified: tuple[Identified, ...]) -> AmplitudeFinding | None:
    """Weigh small motion, large motion, and friction at some ends beside it; None without decays read in windows."""
    p_still = probability_still(identified)
    if p_still is None:
        return None
    rows = amplitude_rows(identified) if p_still < FALSE_ALARMS else None
    if rows is None:
        return AmplitudeFinding("adequate" if p_still >= FALSE_ALARMS else "unknown", p_still, 0.0, (), None)
    return weighed(rows, p_still)


def weighed(rows: AmplitudeRows, p_still: float) -> AmplitudeFinding:
    """The same of rows whose frequencies change."""
    small, large = (_log_likelihood(rows, _left(rows, moved)[:, None]).sum() for moved in (0.0, rows.large))
    tables, gain = rows.friction(_ANGLES), float(large - small)
    fits = tuple(sorted((_fit(rows, tables, ends) for ends in HYPOTHESES), key=lambda fit: -fit.gain))
    still = float(np.median(np.abs(changes(rows, rows.log_hertz)))) < READING  # single modes were misread
    status = "large_motion" if gain >= NAMED else "adequate" if still else "unknown"
    if fits[0].gain >= NAMED and _transfers(rows, fits[0]):
        status = "friction"
    return AmplitudeFinding(status, p_still, gain, fits, rows)


def held_out_rms(rows: AmplitudeRows, shift: np.ndarray | float) -> float:
    """Error (rms, weighted by 1 / sigma^2) of predicted changes of ln f from the first to the last window."""
    error = changes(rows, rows.log_hertz - shift)
    ends = [rows.hertz_sigma[rows.mode == label][[0, -1]] for label in dict.fromkeys(rows.mode.tolist())]
    weight = 1.0 / (np.square(ends).sum(axis=1) + READING**2)
    return float(np.sqrt((weight * error**2).sum() / weight.sum()))


def _transfers(rows: AmplitudeRows, fit: FrictionFit) -> bool:
    """Whether records are predicted better by the friction of the others than by large motion alone."""
    if len(np.unique(rows.record)) < 2:
        return False
    return held_out_rms(rows, rows.large + fit.held_out) < held_out_rms(rows, rows.large)


def _left(rows: AmplitudeRows, moved: np.ndarray | float) -> np.ndarray:
    """(n, 2) whitened changes of ln f beyond `moved`, and of damping ratios."""
    return _white(rows, rows.log_hertz - moved, rows.damping)


def _white(rows: AmplitudeRows, log_hertz: np.ndarray, damping: np.ndarray) -> np.ndarray:
    columns = []
    for value, own in ((log_hertz, rows.hertz_sigma), (damping, rows.damping_sigma)):
        sigma = np.hypot(own, READING)
        columns.append(rows.centred(value, sigma) / sigma)
    return np.stack(columns, axis=-1)


def _log_likelihood(rows: AmplitudeRows, left: np.ndarray) -> np.ndarray:
    """(records, sizes) of whitened rows (n, sizes, 2), without the constant."""
    each = -0.5 * (_FREEDOM + 1.0) * np.log1p(left**2 / _FREEDOM).sum(axis=-1)
    return np.stack([each[rows.record == number].sum(axis=0) for number in np.unique(rows.record)])


def _fit(rows: AmplitudeRows, tables: Table, ends: tuple[str, ...]) -> FrictionFit:
    """Evidence on the grid of angles and radii, and predictions of each record by the others."""
    begin, radii = _left(rows, rows.large), _RADII[len(ends)]
    sizes = np.stack([axis.ravel() for axis in np.meshgrid(*[radii] * len(ends), indexing="ij")])
    angles = list(product(range(len(_ANGLES)), repeat=len(ends)))
    shifts = np.stack([[tables[0][end][a] for a, end in zip(some, ends, strict=True)] for some in angles])
    each = []
    for some in angles:
        laws = np.stack([_white(rows, *(table[end][a] for table in tables)) for a, end in zip(some, ends, strict=True)])
        each.append(_log_likelihood(rows, begin[:, None] - np.einsum("ps,pnj->nsj", sizes, laws)))
    log = np.stack(each, axis=1)  # record, angles, sizes
    held_out = np.zeros(len(rows))
    for number, own in zip(np.unique(rows.record), log, strict=True):
        mine = rows.record == number
        held_out[mine] = _mean_shift(log.sum(axis=0) - own, shifts[:, :, mine], sizes)
    whole, null = log.sum(axis=0), _log_likelihood(rows, begin[:, None]).sum()
    weight = np.exp(whole - whole.max())
    gain = float(whole.max() + np.log(weight.mean()) - null)
    by_axis = weight.reshape([len(_ANGLES)] * len(ends) + [len(radii)] * len(ends))
    parts = tuple(
        EndFriction(end, _quantiles(radii, _margin(by_axis, len(ends) + k)), _quantiles(_ANGLES, _margin(by_axis, k)))
        for k, end in enumerate(ends)
    )
    return FrictionFit(parts, gain, _mean_shift(whole, shifts, sizes), held_out)


def _margin(weight: np.ndarray, axis: int) -> np.ndarray:
    return np.asarray(weight.sum(axis=tuple(k for k in range(weight.ndim) if k != axis)))


def _mean_shift(log: np.ndarray, shifts: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """(n,) posterior mean of radii (p, s) times shifts per radius (angles, p, n), by weights (angles, s)."""
    weight = np.exp(log - log.max())
    return np.asarray(np.einsum("as,ps,apn->n", weight / weight.sum(), sizes, shifts, optimize=True))


def _quantiles(values: np.ndarray, weight: np.ndarray) -> Sized:
    share = np.cumsum(weight) / weight.sum()
    low, middle, high = (float(np.exp(np.interp(q, share, np.log(values)))) for q in (0.025, 0.5, 0.975))
    return middle, low, high

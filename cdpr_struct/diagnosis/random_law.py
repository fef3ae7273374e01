"""What is left after `unknown`, as a random law: forces, moments and lengths that are off anew in every state.

Whatever the law is, in each state it acts as a wrench on the platform and as errors of lengths. Their sizes are those
under which the readings are likeliest: of each kind one rms, found by expectation and maximisation (Dempster, Laird,
Rubin 1977) beside tolerances and noise. What sensors alone may have wrong stays noise.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.peak_noise import SCALES
from cdpr_struct.hypotheses.causes.cause import Parameter, Pattern
from cdpr_struct.hypotheses.hypothesis import Hypothesis, Part
from cdpr_struct.hypotheses.judge import Judged, judged
from cdpr_struct.hypotheses.laws import OUTSIDE
from cdpr_struct.inference.evidence import Fit, fit
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.residuals.assembled import stacked
from cdpr_struct.residuals.layout import Layout
from cdpr_struct.residuals.linearised import Local, Outside
from cdpr_struct.residuals.recorded import LENGTH, Recorded
from cdpr_struct.robot.changed_arrays import plus
from cdpr_struct.robot.remainder import Remainder

_FORCE, _LENGTH = 30.0, 5e-3  # rms to begin with [N], [m]; moments are those forces over the platform's radius
_ROUNDS = 12  # of expectation and maximisation
_STEP = 0.1  # N and N m, by which columns are differentiated


@dataclass(frozen=True, slots=True, eq=False)
class RandomLaw:
    """The fit beside which errors are random, and their sizes."""

    judged: Judged
    remainder: Remainder


def random_law(data: Recorded, where: Layout, null: Judged) -> RandomLaw:
    """Of a campaign of which no cause explains what is wrong; null : nothing wrong, as it was fitted."""
    local = Local.about(data, null.point)
    errors = _errors(local)
    columns = stacked(where, local.r.of_outside(Outside.joined([column for column, _ in errors])))
    kinds = np.repeat(np.arange(len(errors)), [column.count for column, _ in errors])
    start = np.array([size for _, size in errors])
    tried = [_grown(null, columns, kinds, start, noise) for noise in (NoiseState.stated(null.model.groups), None)]
    size, found = max(tried, key=lambda one: one[1].log_evidence)
    parts = tuple(_part(column, rms) for (column, _), rms in zip(errors, size, strict=True))
    law = judged(data, where, Hypothesis(parts, null.hypothesis.drift), null.point, found.noise)
    return RandomLaw(law, _remainder(data, law, size))


def _errors(local: Local) -> list[tuple[Outside, float]]:
    """Columns of the force, moment and lengths of every state, a unit, and the rms of each to begin with."""
    count, m = len(local.data.sigma), local.data.cables
    force = local.of_three(lambda arrays, z: plus(arrays, force=z), _STEP)
    moment = local.of_three(lambda arrays, z: plus(arrays, moment=z), _STEP)
    length = local.of_reading(slice(6 + m, None))
    sizes = (_FORCE, _FORCE * local.data.radius, _LENGTH)
    found = [(one, size) for one, size in zip((force, moment, length), sizes, strict=True) if one.static.any()]
    return [(one.shared(_own(count, one.count), local.states_of_rows), size) for one, size in found]


def _own(states: int, errors: int) -> np.ndarray:
    """(S, k, S k) share of each number in each state's k errors: one of its own."""
    return np.einsum("kl,st->sktl", np.eye(errors), np.eye(states)).reshape((states, errors, -1))


def _grown(
    null: Judged, columns: Sequence[np.ndarray], kinds: np.ndarray, size: np.ndarray, noise: NoiseState | None
) -> tuple[np.ndarray, Fit]:
    """Rms of each kind of error, and the fit with them, from sizes of the noise on; default: those of the null."""
    noise, known = null.fit.noise if noise is None else noise, null.model.parameters
    lists = None if null.lists is None else null.lists.copy()
    for _ in range(_ROUNDS):
        model = null.model.with_columns([shelf * size[kinds] for shelf in columns])
        found = fit(model, noise, lists, null.fit.soft)
        noise = found.noise
        square = found.z_mean[known:] ** 2 + np.diagonal(found.z_covariance)[known:]
        size = size * np.sqrt(np.bincount(kinds, square) / np.bincount(kinds))
    return size, found


def _part(columns: Outside, rms: float) -> Part:
    """Errors of an rms, each of a state by itself."""
    named = tuple(Parameter(str(i), "1", rms) for i in range(columns.count))
    return Part(OUTSIDE, Pattern(OUTSIDE.name, np.eye(columns.count), named, 1.0), 1.0, columns)


def _remainder(data: Recorded, law: Judged, size: np.ndarray) -> Remainder:
    """As predictions need it: a robot's lengths are off by what its encoders are off beyond their sigma, too."""
    force, moment, *length = (float(rms) for rms in size)
    encoders = _beyond(float(law.fit.noise.tau[LENGTH])) * float(data.sigma[:, 6 + data.cables :].mean())
    off = float(np.hypot(length[0], encoders)) if length else 0.0
    return Remainder(force, moment, off, _scatter(law))


def _scatter(law: Judged) -> float:
    """Sigma of ln f by which peaks scatter about their modes beyond what is stated, odd ones included."""
    last = None if law.lists is None else law.lists.association.assignment
    if law.lists is None or last is None or not last.number.sum():
        return 0.0
    peaks, number = law.lists.association, last.number.sum(axis=0)
    factor = float(peaks.noise.tau[0] * np.sqrt(number @ SCALES**2 / number.sum()))
    return _beyond(factor) * float(np.median(peaks.peaks.sd[peaks.peaks.present]))


def _beyond(factor: float) -> float:
    """What must be added to a sigma, in squares, to make it larger by a factor."""
    return float(np.sqrt(max(factor**2 - 1.0, 0.0)))

"""What is left after `unknown`, as a random law: forces, moments and lengths that are off anew in every state.

Whatever the law is, in each state it acts as a wrench on the platform and as errors of lengths, those of each cable and
of all alike. Their sizes are those under which the readings are likeliest: one rms of each part of the wrench and of
both errors of lengths, found by expectation and maximisation (Dempster, Laird, Rubin 1977) beside tolerances and
noise. What sensors alone may have wrong stays noise.
"""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.association.peak_noise import SCALES
from cdpr_struct.errors import CdprError
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import Judged, judged
from cdpr_struct.inference.evidence import Fit, fit
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.residuals.assembled import Lists, errors_of_states, linear_model
from cdpr_struct.residuals.layout import Layout, noise_of_states
from cdpr_struct.residuals.linearised import Local, Outside
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.robot.changed_arrays import plus
from cdpr_struct.robot.remainder import Remainder

_FORCE, _LENGTH = 30.0, 5e-3  # rms to begin with [N], [m]; moments are those forces over the platform's radius
_ROUNDS = 12  # of expectation and maximisation
_STEP = 0.1  # N and N m, by which columns are differentiated


@dataclass(frozen=True, slots=True, eq=False)
class RandomLaw:
    """A fit with random errors in every state, and their rms."""

    judged: Judged
    remainder: Remainder


def random_law(data: Recorded, where: Layout, null: Judged) -> RandomLaw:
    """Of a campaign of which no cause explains what is wrong; null : nothing wrong, as it was fitted.

    Whether sensors drift is not known beside an unknown law: what changes with time counts for the robot.
    """
    null = judged(data, where, Hypothesis(), noise=null.fit.noise) if null.hypothesis.drift else null
    sizes = np.repeat([_FORCE, _FORCE * data.radius, _LENGTH], (3, 3, 2))
    starts = (NoiseState.stated(null.model.groups), null.fit.noise)
    found = max((_fitted(data, where, null, sizes, noise) for noise in starts), key=lambda one: one[0].log_evidence)
    with suppress(CdprError, np.linalg.LinAlgError):  # where these numbers are the robot may have no stable equilibrium
        there = replace(null, point=found[0].likeliest(data, where))
        found = _fitted(data, where, there, found[1], found[0].fit.noise)
    return RandomLaw(found[0], _remainder(data, where, *found))


def _fitted(
    data: Recorded, where: Layout, about: Judged, size: np.ndarray, noise: NoiseState
) -> tuple[Judged, np.ndarray]:
    """Linearised about a point, the fit beside errors of the likeliest rms (8,): force, moment, lengths, all alike."""
    local = Local.about(data, about.point)
    model, lists = linear_model(local, where), Lists.of(local, where)
    assigned = None if lists is None else lists.at_point(about.fit.z_covariance)
    kinds = np.array([*range(6), *([6] * data.cables), 7])
    columns = errors_of_states(local, where, Outside.joined(_errors(local)))
    for _ in range(_ROUNDS):
        scale = size[kinds]
        noisy = model.with_noise([own * np.tile(scale, own.shape[2] // len(kinds)) for own in columns])
        found = fit(noisy, noise, lists, assigned)
        noise = found.noise
        size = size * _grown(found, columns, kinds)
    return replace(about, model=noisy, lists=lists, fit=found), size


def _errors(local: Local) -> list[Outside]:
    """Columns of the force, moment and lengths of each state, and of all lengths alike, a unit."""
    force = local.of_three(lambda arrays, z: plus(arrays, force=z), _STEP)
    moment = local.of_three(lambda arrays, z: plus(arrays, moment=z), _STEP)
    lengths = local.of_reading(slice(6 + local.data.cables, None))
    alike = np.ones((local.data.states, local.data.cables, 1))
    return [force, moment, lengths, lengths.shared(alike, local.states_of_rows)]


def _grown(found: Fit, columns: list[np.ndarray], kinds: np.ndarray) -> np.ndarray:
    """(k,) rms of the errors of each kind that act, in sizes that they were given; one where none act."""
    number = int(kinds.max()) + 1
    square, count = np.zeros(number), np.zeros(number)
    for own, mean, variance in zip(columns, found.noise_mean, found.noise_variance, strict=True):
        acts, last = own.any(axis=1), mean.shape[1] - own.shape[2]
        of = np.broadcast_to(np.tile(kinds, own.shape[2] // len(kinds)), acts.shape)
        square += np.bincount(of[acts], (mean**2 + variance)[:, last:][acts], number)
        count += np.bincount(of[acts], minlength=number)
    return np.sqrt(np.where(count > 0, square / np.maximum(count, 1), 1.0))


def _remainder(data: Recorded, where: Layout, law: Judged, size: np.ndarray) -> Remainder:
    """As predictions need it: a robot's lengths are off by what its encoders are off beyond their sigma, too, odd
    readings included: a clamp that slips once will do so again."""
    lengths, (x, y, z, rx, ry, rz, own, alike) = slice(6 + data.cables, None), size.tolist()
    read = data.read[:, lengths]
    if not read.any():
        return Remainder((x, y, z), (rx, ry, rz), frequency=_scatter(law))
    off = noise_of_states(data, where, law.fit.noise_mean)[:, lengths][read]
    own = float(np.hypot(own, _beyond(float(np.sqrt(np.mean(off**2)))) * data.sigma[:, lengths][read].mean()))
    return Remainder((x, y, z), (rx, ry, rz), own, alike, _scatter(law))


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

"""Whether steady stray peaks are those of an internal mode: against everything that the library makes of them.

A large change of a cause leaves strays, too. So the campaign without the peaks, at the price of one unknown frequency,
is held against the best fits to all of it, large changes included.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.causes.internal_mode import MOVING, POSES, Steady, correction, poses
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.prepared import SIGNIFICANT, Budget, Prepared, grounded, judged
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.diagnosis.robot_rows import pairing_of
from cdpr_struct.diagnosis.selection import FURTHER, select
from cdpr_struct.diagnosis.setting import modes_in
from cdpr_struct.diagnosis.steady_peaks import moves_alone, steady_peaks
from cdpr_struct.diagnosis.stray_peaks import ONE, clears
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.side_by_side import side_by_side

_CLEAR = (6.0, 12.0)  # nats beyond the best of the library, seen at enough poses, and at one fewer
_OWN = 3.0  # nats beyond a mode of the model that is off by one factor
_FAR = 10.0  # nats beyond the most that an internal mode can bring
_TRIED = 2  # groups of peaks
_LOST = 0.5 + float(np.log(100.0 * np.sqrt(2.0 * np.pi)))  # nats of a modal constant of which nothing is known [%]


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """An internal mode: what to say of it, its log evidence against the null, and the rest of the data prepared."""

    correction: Correction
    gain: float
    rest: Prepared


def internal_mode(campaign: Campaign, full: Prepared, plan: Budget) -> Found | None:
    """The internal mode that explains steady stray peaks, if nothing else does."""
    groups = [steady for steady in _candidates(campaign, full) if not _outdone(full, steady)]

    def without(one: tuple[Steady, float]) -> _Trial | None:
        return _without(campaign, full, *one, plan)

    tried = side_by_side(without, [(steady, moving) for steady in groups for moving in MOVING], ())
    each = [_likelier(tried[len(MOVING) * i : len(MOVING) * (i + 1)]) for i in range(len(groups))]
    row = max(zip(groups, each, strict=True), key=lambda row: row[1].gain if row[1] else -np.inf, default=None)
    if row is None or row[1] is None:
        return None
    steady, best = row[0], row[1]
    seen = poses(campaign.states, campaign.robot_frequencies.state[steady.rows])
    margin = _CLEAR[0] if seen >= POSES else _CLEAR[1]
    return best if _stands(full, best.gain - margin, best.rest, plan) else None


def _candidates(campaign: Campaign, full: Prepared) -> list[Steady]:
    """Groups of peaks at enough poses that no mode off by one factor explains as well."""
    ground, peaks = full.ground, campaign.robot_frequencies
    if ground.strays < ONE or poses(campaign.states, peaks.state) < POSES - 1:
        return []
    model = modes_in(ground.setting, ground.world)
    pairing = pairing_of(ground.setting, model, wary=False)
    return [
        steady
        for steady in steady_peaks(peaks, pairing)
        if poses(campaign.states, peaks.state[steady.rows]) >= POSES - 1
        and moves_alone(peaks, steady, pairing, model.modes) > _OWN
    ][:_TRIED]


def _outdone(full: Prepared, steady: Steady) -> bool:
    """Whether a cause alone explains everything, by far better than an internal mode can explain it."""
    best = full.search.rank()[0]
    return clears(best) and best.gain > _most_gain(full, steady) + _FAR


def _most_gain(full: Prepared, steady: Steady) -> float:
    """Log evidence against the null if the peaks were an internal mode's, and all others just where they should be."""
    ground = full.ground
    vibration = np.isin(ground.setting.labels.block, ("RF", "FA"))
    own = np.flatnonzero(ground.setting.labels.block == "RF")[steady.rows]
    rest, others = np.flatnonzero(~vibration), np.setdiff1d(np.flatnonzero(vibration), own)
    order = np.concatenate([rest, others])
    lower = np.linalg.cholesky(ground.null.covariance[np.ix_(order, order)])
    z = ground.null.white_among(rest, ground.null.r)
    level = 0.5 * float(z @ z) + float(np.log(np.diagonal(lower)).sum())
    return ground.level - level + _of_frequencies(steady, len(own))


def _of_frequencies(steady: Steady, rows: int) -> float:
    """Log density of the peaks' frequencies, and what the evidence of the other residuals lacks without `rows`."""
    return steady.log_density - len(steady.rows) * float(np.log(100.0)) + 0.5 * rows * float(np.log(2.0 * np.pi))


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """A campaign without the peaks, its log evidence against the null, and what its causes are judged on."""

    correction: Correction
    gain: float
    ground: Ground
    fine: NullModel


def _likelier(tried: Sequence[_Trial | None]) -> Found | None:
    """The first whose rest is noise, or the likeliest, of campaigns with more and more doubt of the other peaks."""
    best: Found | None = None
    for trial in tried:
        if trial is None or trial.gain < max(min(_CLEAR), best.gain if best else -np.inf):
            continue
        best = Found(trial.correction, trial.gain, judged(trial.ground, trial.fine))
        if best.rest.p_value >= SIGNIFICANT:
            break
    return best


def _without(campaign: Campaign, full: Prepared, steady: Steady, moving: float, plan: Budget) -> _Trial | None:
    """The campaign without the peaks; None where it cannot be computed."""
    made = correction(campaign, steady, moving)
    try:
        ground, fine = grounded(made.campaign, plan)
    except (InputError, np.linalg.LinAlgError):
        return None
    constants = len(full.ground.setting.constants) - len(ground.setting.constants)
    rows = len(full.ground.null.r) - len(ground.null.r)
    gain = full.ground.level - ground.level + _of_frequencies(steady, rows) - constants * _LOST
    return _Trial(made, gain, ground, fine)


def _stands(full: Prepared, gain: float, rest: Prepared, plan: Budget) -> bool:
    """Whether an internal mode beats a cause alone; or, with a cause on top, as many as the plan allows."""
    alone = full.search.rank()
    if gain > max(alone[0].gain, 0.0):
        return True
    if rest.p_value >= SIGNIFICANT or clears(alone[0]):
        return False
    rival = select(full.search, FURTHER, plan.causes).fit
    if rival is None or gain > rival.gain:
        return True
    return not clears(rival) and gain + max(rest.search.rank()[0].gain - FURTHER, 0.0) > rival.gain

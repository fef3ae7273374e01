"""The whole diagnosis of a campaign: significance, handling of the data, causes, held-out gain."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.evidence import choices, largest_gains, screen
from cdpr_struct.diagnosis.handling_screen import best_correction
from cdpr_struct.diagnosis.heldout import Held, groups_of, left_out, predicted, transfer, weakest
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.prepared import (
    BUDGETS,
    DRAWS,
    SEED,
    SIGNIFICANT,
    Budget,
    Prepared,
    p_of_noise,
    prepare,
)
from cdpr_struct.diagnosis.refit import Fit, Ground, screen_beyond
from cdpr_struct.diagnosis.remainder import channels
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.selection import Selection, select
from cdpr_struct.diagnosis.stray_peaks import p_of_strays, strays_left
from cdpr_struct.measurement.campaign import Campaign

FURTHER = 6.0  # nats that each further cause must bring
NAMED = 5.0  # nats that a named cause must bring
ADEQUATE = 1e-3
_MOST_CORRECTIONS = 2


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosis:
    """Everything found.

    entered      : the null as entered with all frequencies counted;  ground : what hypotheses were judged on
    corrections  : handling errors and shortcuts found, in the order of their discovery, with their log evidence
    selection    : physical causes on top of them;  p_value of the null as entered, p_value_left after corrections,
                   p_adequate of what was chosen
    weakest      : (causes,) nats that each keeps with the group left out that it needs most
    held, fudge  : held-out residuals of the choice and of a generic fit (common EA and load cell gain)
    outside      : laws outside the library, on top of the chosen causes
    """

    campaign: Campaign
    entered: NullModel
    entered_setting: Setting
    ground: Ground
    corrections: list[tuple[Correction, float]]
    selection: Selection
    p_value: float
    p_value_left: float
    p_adequate: float
    weakest: np.ndarray
    held: Held | None
    fudge: Held | None
    transfer: dict[str, float]
    outside: "Outside"
    not_testable: dict[str, str]


@dataclass(frozen=True, slots=True)
class Outside:
    """The best law outside the library, by the channel through which it acts.

    words, gain : the channel, and what it adds to the log evidence of the chosen causes, or of the null without any
    limit : what channels add to noise in one case of forty
    """

    words: str
    gain: float
    limit: float


def diagnose(campaign: Campaign, budget: str = "small", progress: Callable[[str], None] = lambda _: None) -> Diagnosis:
    """Diagnose a campaign.

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    plan = BUDGETS[budget]
    progress("simulating what was measured")
    entered = prepared = prepare(campaign, plan)
    progress("checking units, signs and channels")
    found: list[tuple[Correction, float]] = []
    while prepared.p_value < SIGNIFICANT and len(found) < _MOST_CORRECTIONS:
        better = best_correction(campaign, prepared.fine.level)
        if better is None:
            break
        found.append(better)
        campaign = better[0].campaign
        prepared = prepare(campaign, plan)
    progress("fitting causes")
    selection = _selected(prepared, plan, bool(found))
    progress("predicting what was left out")
    ground, fit, groups = prepared.ground, selection.fit, groups_of(prepared.ground.setting)
    before = prepared.fine.r
    return Diagnosis(
        campaign=campaign, entered=entered.fine, entered_setting=entered.ground.setting, ground=ground,
        corrections=found, selection=selection, p_value=entered.p_value,
        p_value_left=prepared.p_value,
        p_adequate=_p_adequate(ground, fit),
        weakest=weakest(fit, groups) if fit else np.zeros(0), held=left_out(fit, before, groups) if fit else None,
        fudge=_fudge(prepared, groups) if fit else None, transfer=transfer(fit, before) if fit else {},
        outside=_outside(prepared, fit), not_testable=prepared.not_testable,
    )  # fmt: skip


def _p_adequate(ground: Ground, fit: Fit | None) -> float:
    """Of what is left: its chi^2, and peaks of the robot that no mode explains."""
    noise = float(chi2.sf(fit.adequacy(), len(fit.white))) if fit else p_of_noise(ground.null)
    return min(noise, p_of_strays(strays_left(ground, fit), len(ground.setting.robot_log)))


def _selected(prepared: Prepared, plan: Budget, corrected: bool) -> Selection:
    """Causes, if anything is significant; on top of corrected data a first cause counts as a further one."""
    if prepared.p_value >= SIGNIFICANT:
        return Selection(None, [], [])
    selection = select(prepared.ground, FURTHER, plan.causes)
    if corrected and selection.first[0].gain < FURTHER:
        return Selection(None, selection.first, [])
    return selection


def _outside(prepared: Prepared, fit: Fit | None) -> Outside:
    """The best law outside the library on top of the chosen causes."""
    ground = prepared.ground
    if not prepared.channels:
        return Outside("", -np.inf, np.inf)
    draws = np.random.default_rng(SEED + 1).standard_normal((len(ground.z), DRAWS))
    limit = float(np.quantile(largest_gains(prepared.channels, draws), 0.975))
    if fit is None:
        best = screen(prepared.channels, ground.z)[0]
    else:
        there = channels(fit.ground.setting, fit.world, ground.readings, fit.ground.null)
        best = screen_beyond(fit, there)[0]
    return Outside(best.candidate.cause.title, best.gain, limit)


def _fudge(prepared: Prepared, groups: np.ndarray) -> Held:
    """Held-out residuals of a generic fit: common EA and load cell gains."""
    ground, fine, columns = prepared.ground, prepared.fine, []
    for candidate in ground.candidates:
        if candidate.name in ("axial_stiffness", "load_cell_gain"):
            alike = next(c for c in choices(candidate) if c.pattern.label == "all alike" and c.scale == 1.0)
            columns.append(-ground.null.lower @ alike.signature)
    labels = ground.setting.labels
    generic = np.hstack(columns) if columns else np.zeros((len(labels), 1))
    return predicted(labels, fine.r, fine.r, generic, fine.covariance, groups)

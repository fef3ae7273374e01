"""The whole diagnosis of a campaign: significance, handling of the data, causes, held-out gain."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.causes.internal_mode import NAME
from cdpr_struct.diagnosis.evidence import Screened, choices, largest_gains
from cdpr_struct.diagnosis.handled_data import handled
from cdpr_struct.diagnosis.heldout import Held, groups_of, left_out, predicted, transfer, weakest
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.prepared import BUDGETS, SIGNIFICANT, Budget, Prepared
from cdpr_struct.diagnosis.refit import Fit, Ground, screen_beyond
from cdpr_struct.diagnosis.remainder import channels
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.selection import FURTHER, Selection, select
from cdpr_struct.diagnosis.significance import DRAWS, OUTSIDE, SEED, p_of_noise
from cdpr_struct.diagnosis.stray_peaks import p_of_strays, strays_left
from cdpr_struct.diagnosis.suspect_reading import Suspect
from cdpr_struct.diagnosis.whole_readings import whole_readings
from cdpr_struct.measurement.campaign import Campaign

NAMED = 5.0  # nats that a named cause must bring
ADEQUATE = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosis:
    """Everything found.

    entered      : the null as entered with all frequencies counted;  ground : what hypotheses were judged on
    corrections  : handling errors and shortcuts found, in the order of their discovery, with their log evidence
    aside        : single readings that contradict all others, their sigmas widened if anything was significant
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
    aside: list[Suspect]
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
    one_law, instead : the law that stands best for several of the chosen causes, and its log evidence against them
    """

    words: str
    gain: float
    limit: float
    one_law: str = ""
    instead: float = -np.inf


def diagnose(campaign: Campaign, budget: str = "small", progress: Callable[[str], None] = lambda _: None) -> Diagnosis:
    """Diagnose a campaign.

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    plan = BUDGETS[budget]
    data = handled(whole_readings(campaign), plan, progress)
    prepared, entered, found = data.prepared, data.entered, data.corrections
    progress("fitting causes")
    selection = _selected(prepared, plan, bool(found))
    progress("predicting what was left out")
    ground, fit, groups = prepared.ground, selection.fit, groups_of(prepared.ground.setting)
    before, named = prepared.fine.r, [c.cause for c, _ in found]
    return Diagnosis(
        campaign=data.campaign, entered=entered.fine, entered_setting=entered.ground.setting, ground=ground,
        corrections=found, aside=data.aside, selection=selection, p_value=entered.p_value,
        p_value_left=prepared.p_value,
        p_adequate=_p_adequate(ground, fit),
        weakest=weakest(fit, groups, selection.caught) if fit else np.zeros(0),
        held=left_out(fit, before, groups) if fit else None,
        fudge=_fudge(prepared, groups) if fit else None, transfer=transfer(fit, before) if fit else {},
        outside=_outside(prepared, selection),
        not_testable={k: why for k, why in prepared.not_testable.items() if k != NAME or k not in named},
    )  # fmt: skip


def _p_adequate(ground: Ground, fit: Fit | None) -> float:
    """Of what is left: its chi^2, and peaks of the robot that no mode explains."""
    noise = float(chi2.sf(fit.adequacy(), len(fit.white))) if fit else p_of_noise(ground.null)
    return min(noise, p_of_strays(strays_left(ground, fit), len(ground.setting.robot_log)))


def _selected(prepared: Prepared, plan: Budget, corrected: bool) -> Selection:
    """Causes, if anything is significant; on top of corrected data a first cause counts as a further one."""
    if prepared.p_value >= SIGNIFICANT:
        return Selection(None, [], [])
    law = prepared.outside
    outside = -np.inf if law is None else law.gain - max(prepared.ground.ahead, 0.0)
    selection = select(prepared.search, FURTHER, plan.causes, outside)
    if corrected and selection.first[0].gain < FURTHER:
        return Selection(None, selection.first, [])
    return selection


def _outside(prepared: Prepared, selection: Selection) -> Outside:
    """The best law outside the library on top of the chosen causes, and instead of all or all but one of them."""
    ground, fit, alone = prepared.ground, selection.fit, prepared.outside
    if alone is None:
        return Outside("", -np.inf, np.inf)
    draws = np.random.default_rng(SEED + 1).standard_normal((len(ground.z), DRAWS))
    limit = float(np.quantile(largest_gains(prepared.channels, draws), 0.975))
    if fit is None:
        return Outside(alone.candidate.cause.title, alone.gain, limit)
    best = _beyond(fit)
    on_top = Outside(best.candidate.cause.title, best.gain, limit)
    if len(fit.names) == 1:
        return on_top
    others = [(alone, FURTHER - ground.ahead)]
    others += [(_beyond(one), one.gain) for one in selection.first if one.names[0] in fit.names]
    law, kept = max(others, key=lambda other: other[0].gain + other[1])
    return replace(on_top, instead=law.gain + kept + OUTSIDE - fit.gain, one_law=law.candidate.cause.title)


def _beyond(fit: Fit) -> Screened:
    """The best law outside the library on top of a fit."""
    ground = fit.ground
    return screen_beyond(fit, channels(ground.setting, fit.world, ground.readings, ground.null))[0]


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

"""The whole diagnosis of a campaign: significance, handling of the data, causes, held-out gain."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.causes.registry import causes_for
from cdpr_struct.diagnosis.evidence import Candidate, candidates, choices, largest_gains, screen
from cdpr_struct.diagnosis.handling_screen import best_correction
from cdpr_struct.diagnosis.heldout import Held, groups_of, left_out, predicted, transfer, weakest
from cdpr_struct.diagnosis.null_model import (
    NullModel,
    likeliest_tolerances,
    null_model,
    null_with_bending,
    relinearised,
    tolerated,
)
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.refit import Fit, Ground
from cdpr_struct.diagnosis.remainder import channels
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.selection import Selection, select
from cdpr_struct.diagnosis.setting import anchored, make_setting, with_equilibria
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign

FURTHER = 6.0  # nats that each further cause must bring
NAMED = 5.0  # nats that a named cause must bring
SIGNIFICANT = 0.04
ADEQUATE = 1e-3
_TAIL_SHARE = 0.75  # of the false alarms that may come from the largest evidence; the rest from chi^2
_OUTSIDE = -2.0  # ln prior of a law outside the library, beside that of a cause
_NULL_DRAWS = 1000
SEED = 20240229


@dataclass(frozen=True, slots=True)
class Budget:
    """Random draws of the null, how many causes are refitted at each step, and at most taken."""

    draws: int
    refits: int
    causes: int = 2


BUDGETS = {"small": Budget(24, 3), "full": Budget(200, 6, 3)}


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosis:
    """Everything found.

    ground, fine : what hypotheses were judged on, and the null as entered with all frequencies counted
    corrections  : handling errors and shortcuts found, in the order of their discovery, with their log evidence
    selection    : physical causes on top of them;  p_value of the null as entered, p_value_left after corrections,
                   p_adequate of what was chosen
    weakest      : (causes,) nats that each keeps with the group left out that it needs most
    held, fudge  : held-out residuals of the choice and of a generic fit (common EA and load cell gain)
    null_gains   : (draws,) largest evidence of any cause or channel when nothing is wrong
    outside      : laws outside the library: their best evidence alone, and on top of the chosen causes
    """

    campaign: Campaign
    entered: NullModel
    entered_setting: Setting
    ground: Ground
    fine: NullModel
    corrections: list[tuple[Correction, float]]
    selection: Selection
    p_value: float
    p_value_left: float
    p_adequate: float
    weakest: np.ndarray
    held: Held | None
    fudge: Held | None
    transfer: dict[str, float]
    null_gains: np.ndarray
    outside: "Outside"
    not_testable: dict[str, str]


@dataclass(frozen=True, slots=True)
class Outside:
    """Evidence of laws outside the library.

    words, alone : the best channel by itself, and its log evidence against the null
    left_words, left : the best channel on top of the chosen causes, and what it adds
    limit : what channels add to noise in one case of forty
    """

    words: str
    alone: float
    left_words: str
    left: float
    limit: float


def diagnose(campaign: Campaign, budget: str = "small", progress: Callable[[str], None] = lambda _: None) -> Diagnosis:
    """Diagnose a campaign.

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    plan = BUDGETS[budget]
    progress("simulating what was measured")
    prepared = prepare(campaign, plan)
    entered, entered_setting = prepared.fine, prepared.ground.setting
    p_value = prepared.p_value
    found: list[tuple[Correction, float]] = []
    progress("checking units, signs and channels")
    if p_value < SIGNIFICANT:
        for _ in range(2):
            better = best_correction(campaign, prepared.fine.level)
            if better is None:
                break
            found.append(better)
            campaign = better[0].campaign
            prepared = prepare(campaign, plan)
            if prepared.p_value >= SIGNIFICANT:
                break
    progress("fitting causes")
    ground = prepared.ground
    quiet = prepared.p_value >= SIGNIFICANT
    selection = Selection(None, [], []) if quiet else select(ground, FURTHER, plan.causes)
    if found and selection.first and selection.first[0].gain < FURTHER:
        selection = Selection(None, selection.first, [])
    progress("predicting what was left out")
    fit = selection.fit
    held = fudge = None
    carried: dict[str, float] = {}
    lasting = np.zeros(0)
    if fit is not None:
        groups = groups_of(ground.setting)
        lasting = weakest(fit, groups)
        held, carried = left_out(fit, prepared.fine.r, groups), transfer(fit, prepared.fine.r)
        fudge = _fudge(prepared, groups)
    adequate = adequacy(fit.adequacy(), len(fit.white)) if fit else _chi2(ground.null)
    return Diagnosis(
        campaign, entered, entered_setting, ground, prepared.fine, found, selection, p_value, prepared.p_value,
        adequate, lasting, held, fudge, carried, prepared.gains, _outside(prepared, fit), prepared.not_testable,
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """Ground for hypotheses, null paired as if the entered world were right, channels, largest gains of null draws."""

    ground: Ground
    fine: NullModel
    channels: list[Candidate]
    gains: np.ndarray
    p_value: float
    not_testable: dict[str, str]


def prepare(campaign: Campaign, plan: Budget) -> Prepared:
    """Everything before the first hypothesis."""
    if not len(campaign.states.names):
        kinds = ", ".join(campaign.kinds())
        raise InputError(campaign.source, "measurement", kinds, "also static states, loaded poses or frequencies")
    setting, near = make_setting(campaign)
    world, readings = World.of(campaign.robot, len(campaign.states.names)), Readings.of(setting.campaign.states)
    first, extra = null_with_bending(setting, world, readings, plan.draws, SEED)
    fine = first if near is setting else null_model(near, world, readings, extra)
    u = likeliest_tolerances(near, fine)
    likeliest = tolerated(setting, world, u)
    setting = with_equilibria(setting, likeliest)
    null, offset = relinearised(setting, likeliest, readings, extra, u)
    level = null.level
    if campaign.robot_frequencies.hertz.size:
        level = relinearised(anchored(near, likeliest), likeliest, readings, extra, u)[0].level
    causes, not_testable = causes_for(setting)
    library = candidates(setting, likeliest, readings, null, causes)
    outside = channels(setting, likeliest, readings, null)
    for candidate in library:
        if strength(candidate) < 2.0:
            not_testable[candidate.name] = "at its typical size it hides in noise and tolerances"
    ground = Ground(setting, likeliest, readings, null, library, plan.refits, level, extra, u, offset, world)
    draws = np.random.default_rng(SEED).standard_normal((len(null.r), _NULL_DRAWS))
    gains = _most(library, outside, draws)
    return Prepared(ground, fine, outside, gains, _significance(ground, outside, gains), not_testable)


def _most(library: list[Candidate], outside: list[Candidate], draws: np.ndarray) -> np.ndarray:
    """(k,) largest evidence of any cause or channel for residuals (n, k)."""
    gains = largest_gains(library, draws)
    return np.maximum(gains, largest_gains(outside, draws) + _OUTSIDE) if outside else gains


def strength(candidate: Candidate) -> float:
    """Largest whitened size of a typical occurrence, in standard deviations."""
    best = 0.0
    for choice in choices(candidate):
        if choice.scale == 1.0:
            best = max(best, float(np.linalg.norm(choice.signature, axis=0).max()))
    return best


def adequacy(statistic: float, count: int) -> float:
    """Probability of a chi^2 at least as large."""
    return float(chi2.sf(statistic, count))


def _chi2(null: NullModel) -> float:
    z = null.white(null.r)
    return adequacy(float(z @ z), len(z))


def _significance(ground: Ground, outside: list[Candidate], gains: np.ndarray) -> float:
    """p-value of the null: the largest evidence of any law beside that of draws from the null, and its chi^2."""
    best = float(_most(ground.candidates, outside, ground.z[:, None])[0])
    tail = (1.0 + float((gains >= best).sum())) / (len(gains) + 1.0)
    if best > float(gains.max()):
        tail = min(tail, len(ground.candidates) * float(np.exp(-best)))
    return min(1.0, tail / _TAIL_SHARE, _chi2(ground.null) / (1.0 - _TAIL_SHARE))


def _outside(prepared: Prepared, fit: Fit | None) -> Outside:
    """Evidence of laws outside the library, alone and on top of the chosen causes."""
    ground = prepared.ground
    if not prepared.channels:
        return Outside("", -np.inf, "", -np.inf, np.inf)
    alone = screen(prepared.channels, ground.z)[0]
    draws = np.random.default_rng(SEED + 1).standard_normal((len(ground.z), _NULL_DRAWS))
    limit = float(np.quantile(largest_gains(prepared.channels, draws), 0.975))
    left = alone
    if fit is not None:
        there = channels(fit.ground.setting, fit.world, ground.readings, fit.ground.null)
        left = screen(there, fit.white + fit.signature @ fit.theta, fit.signature)[0]
    return Outside(alone.candidate.cause.title, alone.gain + _OUTSIDE, left.candidate.cause.title, left.gain, limit)


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

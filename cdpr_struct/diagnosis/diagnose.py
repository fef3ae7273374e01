"""The whole diagnosis of a campaign: significance, handling of the data, causes, held-out gain."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.causes.registry import causes_for
from cdpr_struct.diagnosis.evidence import Candidate, candidates, choices, largest_gains
from cdpr_struct.diagnosis.handling_screen import best_correction
from cdpr_struct.diagnosis.heldout import Held, left_out, transfer
from cdpr_struct.diagnosis.null_model import NullModel, null_model, null_with_draws
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.selection import Fit, Ground, Selection, select
from cdpr_struct.diagnosis.setting import anchored, make_setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign

FIRST_THRESHOLD = 5.0  # nats that the first cause must bring
NEXT_THRESHOLD = 5.0
SAME_CLASS = 3.0  # nats within which causes are not told apart
SIGNIFICANT = 0.01
ADEQUATE = 1e-3
AMBIGUOUS = 8.0  # [%] doubt of a frequency whose partner is not clear
SEED = 20240229


@dataclass(frozen=True, slots=True)
class Budget:
    """Random draws of the null, and how many causes are refitted at each step."""

    draws: int
    refits: int


BUDGETS = {"small": Budget(24, 3), "full": Budget(200, 6)}


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosis:
    """Everything found.

    ground, fine : what hypotheses were judged on, and the null as entered with all frequencies counted
    corrections  : handling errors and shortcuts found, in the order of their discovery, with their log evidence
    selection    : physical causes on top of them;  p_value of the null, p_adequate of what was chosen
    held, fudge  : held-out residuals of the choice and of a generic fit (common EA and load cell gain)
    null_gains   : (draws,) largest evidence of any cause when nothing is wrong
    """

    campaign: Campaign
    entered: NullModel
    entered_setting: Setting
    ground: Ground
    fine: NullModel
    corrections: list[tuple[Correction, float]]
    selection: Selection
    p_value: float
    p_adequate: float
    held: Held | None
    fudge: Held | None
    transfer: dict[str, float]
    null_gains: np.ndarray
    not_testable: dict[str, str]


def diagnose(campaign: Campaign, budget: str = "small", progress: Callable[[str], None] = lambda _: None) -> Diagnosis:
    """Diagnose a campaign.

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    plan = BUDGETS[budget]
    progress("simulating what was measured")
    ground, fine, gains, not_testable = prepare(campaign, plan)
    entered, entered_setting = fine, ground.setting
    p_value = _significance(ground, gains)
    found: list[tuple[Correction, float]] = []
    progress("checking units, signs and channels")
    if p_value < SIGNIFICANT:
        for _ in range(2):
            better = best_correction(campaign, fine.level)
            if better is None:
                break
            found.append(better)
            campaign = better[0].campaign
            ground, fine, gains, not_testable = prepare(campaign, plan)
            if _significance(ground, gains) >= SIGNIFICANT:
                break
    progress("fitting causes")
    threshold = max(FIRST_THRESHOLD, float(np.quantile(gains, 0.975)))
    quiet = (p_value if not found else _significance(ground, gains)) >= SIGNIFICANT
    selection = Selection(None, [], []) if quiet else select(ground, threshold, NEXT_THRESHOLD)
    progress("predicting what was left out")
    fit = selection.fit
    held = fudge = None
    carried: dict[str, float] = {}
    if fit is not None:
        held, fudge, carried = _held_out(ground, fine, fit)
    adequate = _remainder(ground, fit) if fit else _chi2(ground.null)
    return Diagnosis(
        campaign, entered, entered_setting, ground, fine, found, selection, p_value, adequate, held, fudge, carried,
        gains, not_testable,
    )  # fmt: skip


def prepare(campaign: Campaign, plan: Budget) -> tuple[Ground, NullModel, np.ndarray, dict[str, str]]:
    """Ground for hypotheses, null with all frequencies counted, largest gains of null draws, untestable causes."""
    if not len(campaign.states.names):
        kinds = ", ".join(campaign.kinds())
        raise InputError(campaign.source, "measurement", kinds, "also static states, loaded poses or frequencies")
    setting = make_setting(campaign)
    world, readings = World.of(campaign.robot, len(campaign.states.names)), Readings.of(setting.campaign.states)
    null, extra, drawn = null_with_draws(setting, world, readings, plan.draws, SEED)
    causes, not_testable = causes_for(setting)
    library = candidates(setting, world, readings, null, causes)
    gains = largest_gains(library, null.white(drawn.T))
    fine = null
    if setting.robot_rows.omega.size:
        fine = null_model(anchored(setting, world), world, readings, extra)
    for candidate in library:
        if strength(candidate) < 2.0:
            not_testable[candidate.name] = "at its typical size it hides in noise and tolerances"
    ground = Ground(setting, world, readings, null, library, plan.refits, fine.level, extra)
    return ground, fine, gains, not_testable


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


def _remainder(ground: Ground, fit: Fit) -> float:
    """p-value of what a fit leaves; frequencies whose partner was ambiguous as entered may be left out of it."""
    whole = adequacy(float(fit.white @ fit.white + fit.theta @ fit.theta), len(fit.white))
    clear = np.ones(len(fit.white), dtype=bool)
    clear[ground.setting.labels.block == "RF"] = ground.setting.robot_doubt < AMBIGUOUS
    null = fit.ground.null
    lower = np.linalg.cholesky(null.covariance[np.ix_(clear, clear)])
    z = np.linalg.solve(lower, (null.lower @ fit.white)[clear])
    return max(whole, adequacy(float(z @ z + fit.theta @ fit.theta), len(z)))


def _significance(ground: Ground, gains: np.ndarray) -> float:
    """p-value of the null: its chi^2, and the largest evidence of any cause beside that of draws from the null."""
    overall = _chi2(ground.null)
    best = float(largest_gains(ground.candidates, ground.z[:, None])[0])
    beaten = int((gains >= best).sum())
    count = len(gains)
    tail = (1.0 + beaten) / (count + 1.0)
    if beaten == 0 and best > FIRST_THRESHOLD:
        tail = min(tail, len(ground.candidates) * np.exp(-best))
    return float(min(1.0, 2.0 * min(overall, tail)))


def _held_out(ground: Ground, fine: NullModel, fit: Fit) -> tuple[Held, Held, dict[str, float]]:
    """Held-out residuals of the fit and of the generic fudge, and transfer between kinds."""
    null, labels = fit.ground.null, ground.setting.labels
    signature = null.lower @ fit.signature
    zero = null.lower @ fit.white + signature @ fit.theta
    groups = _groups(ground.setting)
    held = left_out(labels, fine.r, zero, signature, null.covariance, groups)
    columns = []
    for candidate in ground.candidates:
        if candidate.name in ("axial_stiffness", "load_cell_gain"):
            alike = next(c for c in choices(candidate) if c.pattern.label == "all alike" and c.scale == 1.0)
            columns.append(-ground.null.lower @ alike.signature)
    generic = np.hstack(columns) if columns else np.zeros((len(labels), 1))
    fudge = left_out(labels, fine.r, fine.r, generic, fine.covariance, groups)
    return held, fudge, transfer(labels, fine.r, zero, signature, null.covariance)


def _groups(setting: Setting) -> np.ndarray:
    """(n,) states, those of one lock together; with a single one, the kinds of data."""
    state, lock = setting.labels.state, setting.campaign.states.lock
    groups = np.where(lock[state] >= 0, 1_000_000 + lock[state], state)
    if len(np.unique(groups)) < 2:
        return np.unique(setting.labels.block.astype(str), return_inverse=True)[1]
    return groups

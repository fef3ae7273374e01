"""Everything before the first hypothesis: residuals, null, signatures of causes and channels, significance."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.causes.registry import causes_for, require_known
from cdpr_struct.diagnosis.evidence import Candidate, Screened, candidates, choices, screen
from cdpr_struct.diagnosis.mode_pairing import STRAY_NATS
from cdpr_struct.diagnosis.null_model import (
    NullModel,
    likeliest_tolerances,
    null_model,
    null_with_bending,
    relinearised,
    tolerated,
)
from cdpr_struct.diagnosis.ranking import Search
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.diagnosis.remainder import channels
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.setting import anchored, make_setting, paired_with, with_equilibria
from cdpr_struct.diagnosis.significance import OUTSIDE, SEED, p_of_noise, p_of_null
from cdpr_struct.diagnosis.stray_peaks import ONE, SEVERAL, p_of_strays
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign

SIGNIFICANT = 0.04
_NO_STRAY, _IMPROBABLE, _PROBABLE = 0.5, 1e-3, 0.05  # strays; p of robot frequencies paired freely, and as entered
_VISIBLE = 2.0  # sigmas: a cause whose typical size changes nothing by more is not testable


@dataclass(frozen=True, slots=True)
class Budget:
    """Random draws of the null, how many causes are refitted at each step, and at most taken."""

    draws: int
    refits: int
    causes: int = 2


BUDGETS = {"small": Budget(24, 3), "full": Budget(200, 6, 3)}


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """Ground for hypotheses, null paired as if the entered world were right, channels and the best law outside the
    library through them (None without), p-value of the null, and the search for causes on the ground."""

    ground: Ground
    fine: NullModel
    channels: list[Candidate]
    outside: Screened | None
    p_value: float
    search: Search
    not_testable: dict[str, str]

    @property
    def best(self) -> float:
        """Largest log evidence of any law."""
        cause = self.search.screened()[0].gain
        return cause if self.outside is None else max(cause, self.outside.gain + OUTSIDE)


def prepare(campaign: Campaign, plan: Budget) -> Prepared:
    """Everything before the first hypothesis."""
    return judged(*grounded(campaign, plan))


def grounded(campaign: Campaign, plan: Budget) -> tuple[Ground, NullModel]:
    """The ground about the likeliest tolerances, no candidates yet, and the null paired as entered."""
    require_known(campaign)
    if not len(campaign.states.names):
        kinds = ", ".join(campaign.kinds())
        raise InputError(campaign.source, "measurement", kinds, "also static states, loaded poses or frequencies")
    setting, near = make_setting(campaign)
    world, readings = World.of(campaign.robot, len(campaign.states.names)), Readings.of(setting.campaign.states)
    first, extra = null_with_bending(setting, world, readings, plan.draws, SEED)
    fine = first if near is setting else null_model(near, world, readings, extra)
    if _paired_as_entered(near, first, fine):
        setting = near
    return _ground(setting, near, world, fine, extra, plan.refits), fine


def judged(ground: Ground, fine: NullModel) -> Prepared:
    """What causes and channels do on a ground, and whether anything is significant there."""
    causes, not_testable = causes_for(ground.setting)
    library = candidates(ground.setting, ground.world, ground.readings, ground.null, causes)
    hidden = "at its typical size it hides in noise and tolerances"
    not_testable |= {candidate.name: hidden for candidate in library if _strength(candidate) < _VISIBLE}
    outside = channels(ground.setting, ground.world, ground.readings, ground.null)
    search, law = Search(replace(ground, candidates=library)), screen(outside, ground.z)[0] if outside else None
    return Prepared(search.ground, fine, outside, law, _p_value(search, outside), search, not_testable)


def _paired_as_entered(near: Setting, first: NullModel, fine: NullModel) -> bool:
    """Whether robot frequencies are those of the entered world, while a freer pairing finds them wrong.

    Where a peak is stray, all the rest must be noise too.
    """
    rows = near.labels.block == "RF"
    if not rows.any() or near.strays > SEVERAL or p_of_noise(first, rows) > _IMPROBABLE:
        return False
    return p_of_noise(fine, rows if near.strays < _NO_STRAY else None) > _PROBABLE


def _ground(setting: Setting, near: Setting, world: World, fine: NullModel, extra: np.ndarray, budget: int) -> Ground:
    readings = Readings.of(setting.campaign.states)
    u = likeliest_tolerances(near, fine, fine.white(fine.r))
    likeliest = tolerated(setting, world, u)
    setting = paired_with(with_equilibria(setting, likeliest), likeliest, wary=setting is not near)
    null, offset = relinearised(setting, likeliest, readings, extra, u)
    level, stray = null.level, np.zeros(0)
    if setting.campaign.robot_frequencies.hertz.size:
        own = anchored(near, likeliest)
        level, stray = relinearised(own, likeliest, readings, extra, u)[0].level, own.stray
        level += STRAY_NATS * own.strays
    return Ground(setting, likeliest, readings, null, [], budget, level, extra, u, offset, world, stray)


def _p_value(search: Search, outside: list[Candidate]) -> float:
    """Of the null; by large changes that explain a stray peak only where nothing else tells."""
    ground = search.ground
    strays = p_of_strays(ground.strays, len(ground.setting.robot_log))
    p_value = p_of_null(ground.candidates, outside, ground.null, strays)
    if p_value < SIGNIFICANT or ground.strays < ONE:
        return p_value
    best = max((fit.gain for fit in search.caught()), default=-np.inf)
    return p_of_null(ground.candidates, outside, ground.null, strays, best)


def _strength(candidate: Candidate) -> float:
    """Largest whitened size of a typical occurrence, in standard deviations."""
    best = 0.0
    for choice in choices(candidate):
        if choice.scale == 1.0:
            best = max(best, float(np.linalg.norm(choice.signature, axis=0).max()))
    return best

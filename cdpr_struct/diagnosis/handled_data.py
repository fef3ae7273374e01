"""What is found before any cause: handling, peaks of internal modes, single readings, noise that wanders."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.gross_reading import without_gross_tension
from cdpr_struct.diagnosis.handling_screen import best_correction, peaks_too_high
from cdpr_struct.diagnosis.internal_modes import internal_mode
from cdpr_struct.diagnosis.null_model import sensors
from cdpr_struct.diagnosis.prepared import SIGNIFICANT, Budget, Prepared, prepare
from cdpr_struct.diagnosis.suspect_reading import Suspect, set_aside, suspect
from cdpr_struct.diagnosis.wandering_noise import CLEAR, FEWEST_READINGS, likeliest_memory
from cdpr_struct.measurement.campaign import Campaign

_MOST_CORRECTIONS = 2
_MOST_ASIDE = 2


@dataclass(frozen=True, slots=True, eq=False)
class Handled:
    """A campaign as it should have been filed, ready for causes.

    entered     : the null before any correction, single readings set aside and noise as it is
    corrections : handling errors and shortcuts, in the order of their discovery, with their log evidence
    aside       : single readings that contradict all others, their sigmas widened
    """

    campaign: Campaign
    prepared: Prepared
    entered: Prepared
    corrections: list[tuple[Correction, float]] = field(default_factory=list)
    aside: list[Suspect] = field(default_factory=list)


def handled(campaign: Campaign, plan: Budget, progress: Callable[[str], None]) -> Handled:
    """The campaign after everything that data alone explain; where nothing is significant, a wrong reading is told."""
    progress("simulating what was measured")
    gross: list[Suspect] = []
    while len(gross) < _MOST_ASIDE and (found := without_gross_tension(campaign)):
        campaign = found[0]
        gross.append(found[1])
    first = prepare(campaign, plan)
    data, again = Handled(campaign, first, first, aside=gross), True
    progress("checking units, signs, channels and single readings")
    while again and data.prepared.p_value < SIGNIFICANT:
        data, again = _next(data, plan)
    wrong = suspect(data.prepared.ground) if data.prepared.p_value >= SIGNIFICANT and not data.aside else None
    return data if wrong is None else replace(data, aside=[wrong])


def _next(data: Handled, plan: Budget) -> tuple[Handled, bool]:
    """The data with one more explanation, and whether there was one."""
    ground, rival = data.prepared.ground, data.prepared.best
    better, wrong, inner = None, None, None
    if len(data.corrections) < _MOST_CORRECTIONS:
        made = [c for c, _ in data.corrections]
        better = best_correction(data.campaign, data.prepared.fine.level, made, peaks_too_high(ground))
        if better is None:  # what is misfiled leaves stray peaks, too
            inner = internal_mode(data.campaign, data.prepared, plan)
    if len(data.aside) < _MOST_ASIDE:
        wrong = suspect(ground)
    if inner is not None and inner.gain > (wrong.gain if wrong else -np.inf):
        found = [*data.corrections, (inner.correction, inner.gain)]
        return replace(data, campaign=inner.correction.campaign, prepared=inner.rest, corrections=found), True
    if wrong is not None and wrong.gain > max(rival, better[1] if better else -np.inf):
        return _repeated(replace(data, aside=[*data.aside, wrong]), set_aside(data.campaign, wrong), plan), True
    if better is not None:
        own = better[0].campaign
        found = [*data.corrections, better]
        return replace(data, campaign=own, prepared=prepare(own, plan), corrections=found), True
    if data.campaign.memory or len(data.campaign.states.names) < FEWEST_READINGS:
        return data, False
    memory, gain = likeliest_memory(ground.null.columns, ground.null.r, sensors(ground.setting))
    if gain > max(CLEAR, rival):
        return _repeated(data, replace(data.campaign, memory=memory), plan), True
    return data, False


def _repeated(data: Handled, campaign: Campaign, plan: Budget) -> Handled:
    """The data with other sigmas or noise: what was entered is judged by them too, unless it was corrected already."""
    prepared = prepare(campaign, plan)
    return replace(data, campaign=campaign, prepared=prepared, entered=data.entered if data.corrections else prepared)

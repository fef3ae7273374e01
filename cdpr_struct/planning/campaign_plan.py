"""Before measuring: what a campaign can find, what it would confuse, and what to measure next."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.detectable_sizes import plainest, smallest
from cdpr_struct.hypotheses.causes.library import testable
from cdpr_struct.hypotheses.judge import WORTH
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.planning.candidates import at_the_robot, checks
from cdpr_struct.planning.information import Numbers, expected_evidence, of_causes
from cdpr_struct.planning.planned_rows import PlannedRows
from cdpr_struct.planning.separations import WIDE, Gain, Separator, Sized
from cdpr_struct.residuals.recorded import Recorded, recorded

_VISIBLE = 2.0  # sigmas by which the typical size of some pattern of a cause changes the data, or it hides in noise
_FRICTION = "pulley_friction"


@dataclass(frozen=True, slots=True)
class Confusion:
    """A cause, another that it would be taken for, and the expected log evidence between them [nat]."""

    cause: str
    taken_for: str
    nats: float


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A campaign's promise.

    detectable   : per testable cause its smallest detectable size
    confusable   : pairs of causes that it does not tell apart
    gains        : measurements that would, best first, of each family the best
    not_testable : why not, per cause
    """

    detectable: dict[str, dict[str, float | str]]
    confusable: list[Confusion]
    gains: list[Gain]
    not_testable: dict[str, str]


_NO_PEAK = "shows as a peak of its own, whose place no plan knows"
STEPS = 3
"""Calls of `progress` in `planned`."""


def planned(campaign: Campaign, progress: Callable[[str], None] = lambda name: None) -> Plan:
    """What a campaign promises; its readings may be those of a simulation.

    progress : called with the name of each step as it begins

    Raises
    ------
    InputError : the campaign holds nothing that can be diagnosed.
    """
    progress("simulating the campaign")
    data = recorded(_one_sided(campaign))
    seen = seen_in(data)
    causes, hidden = testable(seen, campaign.checked)
    hidden |= {cause.name: _NO_PEAK for cause in causes if cause.tuned}
    causes = [cause for cause in causes if not cause.tuned]
    numbers = Numbers.of(data.cables, causes, seen)
    information = PlannedRows.of(data, numbers, {}).information()
    gram = of_causes(information, numbers.tolerances)
    hidden |= _invisible(numbers, gram)
    if data.campaign is not campaign and _FRICTION in numbers.causes:
        hidden[_FRICTION] = "needs a column approach (+1 or -1)"
    progress("comparing causes")
    pairs = confusions(numbers, gram, campaign.loss)
    progress("trying further measurements")
    gains = _gains(data, numbers, information, pairs)
    return Plan(_sizes(numbers, gram, hidden), pairs, gains, hidden)


def _invisible(numbers: Numbers, gram: np.ndarray) -> dict[str, str]:
    """Causes of whose patterns none changes the data by `_VISIBLE` at its typical size, and that they do not."""
    found = {}
    for name, patterns in numbers.patterns.items():
        every = np.hstack([numbers.pattern(name, pattern) for pattern in patterns])
        if (every * (gram @ every)).sum(axis=0).max() < _VISIBLE**2:
            found[name] = "at its typical size it is masked by noise and tolerances"
    return found


def _sizes(numbers: Numbers, gram: np.ndarray, hidden: Mapping[str, str]) -> dict[str, dict[str, float | str]]:
    plain = {name: plainest(patterns) for name, patterns in numbers.patterns.items() if name not in hidden}
    return {name: smallest(pattern, _of(gram, numbers.pattern(name, pattern))) for name, pattern in plain.items()}


def _of(gram: np.ndarray, columns: np.ndarray) -> np.ndarray:
    return np.asarray(columns.T @ gram @ columns)


def _one_sided(campaign: Campaign) -> Campaign:
    """The campaign with every state approached from the same side where nobody said from which."""
    approach = campaign.states.approach
    if np.isfinite(approach).any():
        return campaign
    return replace(campaign, states=replace(campaign.states, approach=np.ones_like(approach)))


def confusions(numbers: Numbers, gram: np.ndarray, loss: Loss) -> list[Confusion]:
    """Pairs that a diagnosis would report as one class, at twice the detectable size of the first, worst first."""
    sized = {name: Sized.detectable(numbers, name, gram) for name in numbers.causes}
    sized = {name: own for name, own in sized.items() if float((own.effect * (gram @ own.effect)).sum()) > 1.0}
    found = [
        Confusion(cause, rival, expected_evidence(gram, sized[cause].effect, sized[rival].rival))
        for cause in sized
        for rival in sized
        if cause != rival
    ]
    return sorted((c for c in found if c.nats < loss.nats_of_a_class), key=lambda c: (c.nats, c.cause, c.taken_for))


def _gains(data: Recorded, numbers: Numbers, information: np.ndarray, pairs: list[Confusion]) -> list[Gain]:
    """Measurements that would tell confused pairs of causes apart, best first; of each family the best one."""
    if not pairs:
        return []
    gram = of_causes(information, numbers.tolerances)
    names = sorted({name for pair in pairs for name in (pair.cause, pair.taken_for)})
    sized = {name: Sized.detectable(numbers, name, gram, WIDE) for name in names}
    none = np.zeros((numbers.count, 0))
    separator = Separator(numbers, information, sized, [(p.cause, p.taken_for) for p in pairs], none)
    before = separator.nats()
    found = [
        separator.gain(measurement, more, before)
        for measurement, more in [*checks(data, numbers), *at_the_robot(data, numbers)]
    ]
    best: dict[tuple[str, str], Gain] = {}
    for gain in sorted(found, key=lambda g: -g.nats):
        best.setdefault(gain.measurement.family, gain)
    return [gain for gain in best.values() if gain.nats > WORTH]

"""Before measuring: what a campaign can find, what it would confuse, and what to measure next."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.plan import confusable, minimum_detectable
from cdpr_struct.diagnosis.planned_gain import Gain, next_measurements
from cdpr_struct.diagnosis.planned_states import one_sided
from cdpr_struct.diagnosis.prepared import BUDGETS, prepare
from cdpr_struct.diagnosis.whole_readings import whole_readings
from cdpr_struct.measurement.campaign import Campaign

_FRICTION = "pulley_friction"


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A campaign's promise.

    detectable   : per testable cause its smallest detectable size
    confusable   : pairs of causes that it does not tell apart, with their expected evidence
    gains        : measurements that would, best first
    not_testable : why not, per cause
    """

    detectable: dict[str, dict[str, Any]]
    confusable: list[dict[str, Any]]
    gains: list[Gain]
    not_testable: dict[str, str]


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
    prepared = prepare(one_sided(whole_readings(campaign)), BUDGETS["small"])
    ground, not_testable = prepared.ground, prepared.not_testable
    if not np.isfinite(campaign.states.approach).any() and _FRICTION in {c.name for c in ground.candidates}:
        not_testable[_FRICTION] = "needs a column approach (+1 or -1)"
    progress("comparing causes")
    pairs = confusable(ground)
    found = minimum_detectable([c for c in ground.candidates if c.name not in not_testable])
    progress("trying further measurements")
    return Plan(found, pairs, next_measurements(ground, [(p["cause"], p["taken_for"]) for p in pairs]), not_testable)

"""Which handling error, if any, explains the residuals: hundreds of corrections at once on the static states."""

from dataclasses import replace
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.causes.handling import Correction, corrections, shortcuts
from cdpr_struct.diagnosis.null_model import null_model
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import anchored, make_setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, States

MARGIN = 8.0  # nats that a correction must bring beyond the logarithm of the number of alternatives
_WORTH = 20.0  # decrease of chi^2 on the static states that makes a correction worth the full computation
_KEEP = 3


def best_correction(campaign: Campaign, level: float) -> tuple[Correction, float] | None:
    """The handling error or shortcut with the highest evidence against the null at `level`, if it is enough."""
    tried = shortcuts(campaign) + _worthwhile(campaign)
    scored = []
    for correction in tried:
        own = level_of(correction.campaign)
        if own is not None:
            scored.append((correction, level - own - float(np.log(correction.alternatives))))
    best = max(scored, key=lambda row: row[1], default=None)
    return best if best is not None and best[1] > MARGIN else None


def level_of(campaign: Campaign) -> float | None:
    """Minus the log evidence of the null for a campaign, or None where it cannot be computed."""
    try:
        setting = make_setting(campaign)
        world = World.of(campaign.robot, len(campaign.states.names))
        if setting.robot_rows.omega.size:
            setting = anchored(setting, world)
        return null_model(setting, world, Readings.of(setting.campaign.states)).level
    except (CdprError, InputError, np.linalg.LinAlgError, ValueError):
        return None


def _worthwhile(campaign: Campaign) -> list[Correction]:
    """The few corrections that reduce the static residuals most; those of payload and frequencies always."""
    options = corrections(campaign)
    states = campaign.states
    held = np.flatnonzero(states.has_tension)
    always = [c for c in options if c.campaign.states.payload is not states.payload]
    always += [c for c in options if _rad_per_second(campaign) and c.campaign.states is states]
    shown = [c for c in options if c.campaign.states is not states and c.campaign.states.payload is states.payload]
    if not held.size or not shown:
        return always
    part = replace(campaign, states=_some(states, held), **_NO_FREQUENCIES)
    setting = make_setting(part)
    world = World.of(campaign.robot, held.size)
    null = null_model(setting, world, Readings.of(part.states))
    wrong = [Readings.of(_some(c.campaign.states, held)) for c in shown]
    stacked = Readings(*(np.stack([getattr(w, name) for w in wrong]) for name in Readings.__slots__))
    z = null.white(residuals(setting, world, stacked).T)
    drop = float(null.white(null.r) @ null.white(null.r)) - (z**2).sum(axis=0)
    order = np.argsort(-np.where(np.isfinite(drop), drop, -np.inf))[:_KEEP]
    return always + [shown[i] for i in order if drop[i] > _WORTH]


_NO_FREQUENCIES: dict[str, Any] = {
    "cable_frequencies": CableFrequencies(*(np.zeros(0, dtype=t) for t in (int, int, int, bool, float, float))),
    "robot_frequencies": RobotFrequencies(*(np.zeros(0, dtype=t) for t in (int, float, float))),
}


def _some(states: States, index: np.ndarray) -> States:
    picked = {name: getattr(states, name)[index] for name in States.__slots__ if name != "names"}
    return States(names=tuple(states.names[i] for i in index), **picked)


def _rad_per_second(campaign: Campaign) -> bool:
    """Whether frequencies are so high that they may be angular: above twice those of the taut cables."""
    rows = campaign.cable_frequencies
    if not rows.hertz.size:
        return bool(campaign.robot_frequencies.hertz.size)
    robot, states = campaign.robot, campaign.states
    span = np.linalg.norm(robot.frame_anchors[rows.cable] - states.position[rows.state], axis=1)
    tension = np.nan_to_num(states.tension[rows.state, rows.cable], nan=200.0)
    guess = rows.mode / (2.0 * span) * np.sqrt(tension / robot.linear_density[rows.cable])
    return bool(np.median(rows.hertz / guess) > 3.0)

"""Which handling error, if any, explains the residuals: hundreds of corrections at once on the static states."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.causes.handling import Correction, corrections, shortcuts
from cdpr_struct.diagnosis.null_model import NullModel, null_model
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.setting import make_setting, modes_in
from cdpr_struct.diagnosis.stray_peaks import ONE
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.measurement.campaign import Campaign, States
from cdpr_struct.side_by_side import side_by_side

MARGIN = 8.0  # nats that a correction must bring beyond the logarithm of the number of alternatives
_WORTH = 20.0  # decrease of chi^2 on the static states that makes a correction worth the full computation
_KEEP = 3
_ANGULAR = 3.0  # times what is expected, beyond which a frequency may be in rad/s


def best_correction(
    campaign: Campaign, level: float, made: Sequence[Correction], angular_peaks: bool = False
) -> tuple[Correction, float] | None:
    """The handling error or shortcut with the highest evidence against the null at `level`, if it is enough.

    made : corrections that the campaign has already; none is made twice
    angular_peaks : whether the robot frequencies may be angular
    """
    said = {correction.sentence for correction in made}
    tried = [c for c in shortcuts(campaign) + _worthwhile(campaign, angular_peaks) if c.sentence not in said]
    levels = side_by_side(level_of, [correction.campaign for correction in tried], ())
    scored = [
        (correction, level - own - float(np.log(correction.alternatives)))
        for correction, own in zip(tried, levels, strict=True)
        if own is not None
    ]
    best = max(scored, key=lambda row: row[1], default=None)
    return best if best is not None and best[1] > MARGIN else None


def level_of(campaign: Campaign) -> float | None:
    """Minus the log evidence of the null for a campaign, or None where it cannot be computed."""
    try:
        _, setting = make_setting(campaign)
        world = World.of(campaign.robot, len(campaign.states.names))
        return null_model(setting, world, Readings.of(setting.campaign.states)).level
    except (CdprError, InputError, np.linalg.LinAlgError, ValueError):
        return None


def _worthwhile(campaign: Campaign, angular_peaks: bool) -> list[Correction]:
    """The few corrections that reduce the static residuals most, and those of frequencies that look angular."""
    options = corrections(campaign)
    states = campaign.states
    angular = _rad_per_second(campaign)

    def suspect(option: Campaign) -> bool:
        return angular or (angular_peaks and option.robot_frequencies is not campaign.robot_frequencies)

    always = [c for c in options if c.campaign.states is states and suspect(c.campaign)]
    shown = [c for c in options if c.campaign.states is not states]
    held = np.flatnonzero(states.has_tension)
    if not np.any(states.payload[held]):  # the static states say nothing of payloads
        always += [c for c in shown if c.campaign.states.payload is not states.payload]
    if not held.size or not shown:
        return always
    part = campaign.with_states_only(_some(states, held))
    setting, _ = make_setting(part)
    world, readings = World.of(campaign.robot, held.size), Readings.of(part.states)
    null = null_model(setting, world, readings)
    drop = float(null.white(null.r) @ null.white(null.r)) - _chi2_of(setting, world, null, shown, held)
    order = np.argsort(-np.where(np.isfinite(drop), drop, -np.inf))[:_KEEP]
    return always + [shown[i] for i in order if drop[i] > _WORTH]


def _chi2_of(
    setting: Setting, world: World, null: NullModel, options: list[Correction], held: np.ndarray
) -> np.ndarray:
    """(c,) chi^2 of the static states in each corrected campaign, by the covariance of the one as recorded."""
    chi2 = np.zeros(len(options))
    loads = np.array([c.campaign.states.payload[held] for c in options])
    wrong = [Readings.of(_some(c.campaign.states, held)) for c in options]
    for load in np.unique(loads, axis=0):
        own = np.flatnonzero((loads == load).all(axis=1))
        stacked = Readings(*(np.stack([getattr(wrong[i], name) for i in own]) for name in Readings.__slots__))
        loaded = replace(setting, known=replace(setting.known, payload=load))
        chi2[own] = (null.white(residuals(loaded, world, stacked).T) ** 2).sum(axis=0)
    return chi2


def _some(states: States, index: np.ndarray) -> States:
    picked = {name: getattr(states, name)[index] for name in States.__slots__ if name != "names"}
    return States(names=tuple(states.names[i] for i in index), **picked)


def peaks_too_high(ground: Ground) -> bool:
    """Whether the robot frequencies may be angular: strays, and the lowest of each state far above the model's."""
    peaks = ground.setting.campaign.robot_frequencies
    if ground.strays < ONE:
        return False
    moving = modes_in(ground.setting, ground.world).modes.of_platform()
    own = np.unique(peaks.state)
    lowest = [moving.hertz[moving.state == i].min(initial=np.inf) for i in own]
    measured = [peaks.hertz[peaks.state == i].min() for i in own]
    return bool(np.median(np.divide(measured, lowest)) > _ANGULAR)


def _rad_per_second(campaign: Campaign) -> bool:
    """Whether frequencies are so high that they may be angular: far above those of the taut cables."""
    rows = campaign.cable_frequencies
    if not rows.hertz.size:
        return bool(campaign.robot_frequencies.hertz.size)
    robot, states = campaign.robot, campaign.states
    span = np.linalg.norm(robot.frame_anchors[rows.cable] - states.position[rows.state], axis=1)
    tension = np.nan_to_num(states.tension[rows.state, rows.cable], nan=200.0)
    guess = rows.mode / (2.0 * span) * np.sqrt(tension / robot.linear_density[rows.cable])
    return bool(np.median(rows.hertz / guess) > _ANGULAR)

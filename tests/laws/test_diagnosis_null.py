"""The null model: its covariance is that of draws, and it stays silent about them."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.diagnose import NAMED
from cdpr_struct.diagnosis.evidence import largest_gains
from cdpr_struct.diagnosis.null_model import drawn_campaigns, null_model, null_with_bending
from cdpr_struct.diagnosis.prepared import SIGNIFICANT, Budget, prepare
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.significance import log_ratio
from cdpr_struct.diagnosis.world import World
from tests.laws.crime_campaign import clean_campaign


def ground():
    campaign = clean_campaign()
    setting, _ = make_setting(campaign)
    return setting, World.of(campaign.robot, len(campaign.states.names)), Readings.of(campaign.states)


def test_clean_readings_leave_no_residual():
    setting, world, readings = ground()
    assert np.abs(residuals(setting, world, readings)).max() < 1e-4


def test_chi_squared_of_draws_is_that_of_a_chi_squared():
    """Mean 1 and no heavy tail: 200 draws through the nonlinear residuals."""
    setting, world, readings = ground()
    null = null_model(setting, world, readings)
    drawn = drawn_campaigns(setting, world, readings, 200, 5)
    per_n = (null.white(drawn.T) ** 2).mean(axis=0)
    n = drawn.shape[1]
    assert abs(per_n.mean() - 1.0) < 5.0 * np.sqrt(2.0 / n / 200)
    assert per_n.max() < 1.0 + 5.0 * np.sqrt(2.0 / n)


def test_false_alarms_on_draws_of_the_null_are_rare():
    """100 draws through the nonlinear residuals: as few are significant as stated, and none would be named."""
    found = prepare(clean_campaign(), Budget(24, 3))
    setting, world, readings = ground()
    drawn = found.ground.null.white(drawn_campaigns(setting, world, readings, 100, 9).T)
    chance = np.random.default_rng(10).standard_normal((len(drawn), 1000))
    ratios, limits = (log_ratio(found.ground.candidates, found.channels, z) for z in (drawn, chance))
    assert (ratios > np.quantile(limits, 1.0 - SIGNIFICANT)).sum() <= 10  # binomial at 4 %: more than 10 of 100 at .002
    gains = largest_gains(found.ground.candidates, drawn)
    assert (gains > NAMED).sum() <= 2


def test_batch_equals_one_by_one():
    setting, world, readings = ground()
    factors = np.array([0.9, 1.0, 1.1, 1.2, 1.3, 1.4])[:, None]  # as many as there are states
    together = residuals(setting, world.times(axial_stiffness=factors), readings)
    for factor, row in zip(factors, together, strict=True):
        alone = residuals(setting, world.times(axial_stiffness=factor), readings)
        np.testing.assert_allclose(row, alone, atol=1e-9)


def test_more_noise_means_less_certain():
    campaign = clean_campaign()
    wider = replace(campaign, states=replace(campaign.states, tension_sigma=4.0 * campaign.states.tension_sigma))
    world, readings = World.of(campaign.robot, len(campaign.states.names)), Readings.of(campaign.states)
    small, large = (null_model(make_setting(c)[0], world, readings).log_volume for c in (campaign, wider))
    assert large > small


def test_modes_that_noise_lets_cross_are_in_doubt_and_no_others():
    """A cable at the sag where its first two in-plane modes meet: draws take each of them past the other."""
    setting, world, readings = ground()
    rows, of_cables = setting.campaign.cable_frequencies, setting.labels.block == "CF"

    def logarithms(factor: float) -> np.ndarray:
        left = residuals(setting, world.times(linear_density=factor), readings)[of_cables]
        return np.log(rows.hertz) - left / 100.0

    factors = np.geomspace(1.0, 8.0, 200)
    first, second = (np.array([logarithms(f) for f in factors])[:, rows.mode == k] for k in (1, 2))
    nearest, which = np.unravel_index((second - first).argmin(), first.shape)
    met = world.times(linear_density=float(factors[nearest]))
    _, extra = null_with_bending(setting, met, readings, 64, 3)
    pair = (rows.cable == rows.cable[rows.mode == 1][which]) & (rows.state == rows.state[rows.mode == 1][which])
    assert extra[of_cables][pair].min() > 0.5  # per cent
    assert np.median(extra[of_cables][~pair]) < 0.05

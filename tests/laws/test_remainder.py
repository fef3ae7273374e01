"""Laws outside the library are told by the channel through which they act; noise is not told anything."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.evidence import largest_gains, screen
from cdpr_struct.diagnosis.null_model import null_model
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.remainder import channels
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.world import World
from tests.laws.crime_campaign import clean_campaign


@pytest.fixture(scope="module")
def ground():
    campaign = clean_campaign(10)
    setting, _ = make_setting(campaign)
    world, readings = World.of(campaign.robot, len(campaign.states.names)), Readings.of(campaign.states)
    null = null_model(setting, world, readings)
    return setting, world, readings, null, channels(setting, world, readings, null)


def best(ground, readings):
    setting, world, _, null, found = ground
    rows = screen(found, null.white(residuals(setting, world, readings)))
    return rows[0].candidate.name, rows[0].gain


def test_load_cells_that_hear_their_neighbours(ground):
    readings = ground[2]
    heard = replace(readings, tension=readings.tension + 0.05 * np.roll(readings.tension, -1, axis=1))
    name, gain = best(ground, heard)
    assert name == "tension_law"
    assert gain > 10.0


def test_a_drum_that_is_not_round(ground):
    readings = ground[2]
    name, gain = best(ground, replace(readings, length=readings.length + 0.01 * np.sin(readings.length / 0.06)))
    assert name in ("length_periodic", "length_scatter")
    assert gain > 10.0


def test_noise_has_no_law(ground):
    """Two in a hundred draws of whitened noise bring a nat or more: no channel is wide for nothing."""
    draws = np.random.default_rng(1).standard_normal((len(ground[3].r), 500))
    assert np.quantile(largest_gains(ground[4], draws), 0.975) < 3.0

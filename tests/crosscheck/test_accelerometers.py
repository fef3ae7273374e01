"""Sizes of FRFs, with the FEM as truth: a wrong gain is found with its value, the right one gives nothing."""

import numpy as np
import pytest

from cdpr_struct.diagnosis.candidate_rows import candidate_rows
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.diagnosis.world import World
from tests.crosscheck.frf_campaign import POSES, Shaken, fem_campaign

GAIN = 1.15


@pytest.mark.slow
def test_a_wrong_gain_is_named_with_its_value(tmp_path):
    found = diagnose(fem_campaign(tmp_path, Shaken(gain=(GAIN,) * 3)))
    assert verdict(found).causes == ("accelerometer_gain",)
    gain = candidate_rows(found)[0]["parameters"]["gain"]
    assert abs(gain["value"] - GAIN) < 1.96 * gain["sigma"]
    assert gain["sigma"] < 0.05


@pytest.mark.slow
def test_the_right_gain_is_adequate(tmp_path):
    found = diagnose(fem_campaign(tmp_path, Shaken()))
    assert verdict(found).status == "adequate"


@pytest.fixture(scope="module")
def entered(tmp_path_factory):
    """Setting, world and readings of a campaign in which nothing is wrong, and its residuals."""
    campaign = fem_campaign(tmp_path_factory.mktemp("frf"), Shaken())
    _, setting = make_setting(campaign)
    world, readings = World.of(campaign.robot, len(POSES)), Readings.of(setting.campaign.states)
    return setting, world, readings, residuals(setting, world, readings)


def test_modal_constants_are_those_of_the_fem(entered):
    """Where the model is sure of them they differ by noise; the gain shows in all by its logarithm, in nothing else."""
    setting, world, readings, plain = entered
    sizes = setting.labels.block == "FA"
    clear = setting.constant_doubt < 10.0
    assert clear.sum() >= 10
    assert np.median(np.abs(plain[sizes][clear])) < 10.0  # 5 % of noise, more near nodes
    moved = residuals(setting, world.times(accelerometer_gain=np.full(6, GAIN)), readings)
    np.testing.assert_allclose((plain - moved)[sizes], 100.0 * np.log(GAIN), atol=1e-9)
    np.testing.assert_array_equal(plain[~sizes], moved[~sizes])

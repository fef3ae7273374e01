"""Peaks of the FEM where the model has no mode: a body turned lighter is found by them, the right one has none."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.significant import SIGNIFICANT
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.conftest import at_rest

POSES = np.array([[0.4, 0.3, 0.6], [-0.8, 0.5, 1.0], [0.9, -0.7, 0.8]])
SIZES = pytest.mark.parametrize("count", [2, pytest.param(len(POSES), marks=pytest.mark.slow)])  # poses
CAMPAIGN = """robot = "thesis-3-1"
model = "dsm"
[[measurement]]
kind = "static_state"
file = "states.csv"
sigma = { tension_N = 2.0, position_m = 0.0003, rotation_deg = 0.01, length_m = 0.0001 }
[[measurement]]
kind = "robot_frequency"
file = "peaks.csv"
sigma = { frequency_hz = 0.02 }
"""


def written(folder, inertia, poses=POSES):
    """Campaign of states that balance exactly, and of the frequencies of a body with so much of its inertia."""
    states, peaks = [], []
    for number, pose in enumerate(poses):
        point = at_rest("thesis-3-1", pose)
        body = replace(point.robot.platform, inertia=inertia * point.robot.platform.inertia)
        lighter = replace(point, robot=replace(point.robot, platform=body))
        modes = fem.robot_modes(solve_in_fem(lighter, 20), 80)
        place = {"case": f"s{number}", **dict(zip(("x_m", "y_m", "z_m"), pose, strict=True))}
        cables = zip(point.cables.tension_at_platform, point.cables.total_length, strict=True)
        states += [place | {"cable": i + 1, "tension_N": t, "length_m": n} for i, (t, n) in enumerate(cables)]
        seen = modes.frequencies_hz[modes.platform_energy > 0.3]
        peaks += [place | {"frequency_hz": f} for f in seen]
    pd.DataFrame(states).to_csv(folder / "states.csv", index=False)
    pd.DataFrame(peaks).to_csv(folder / "peaks.csv", index=False)
    (folder / "campaign.toml").write_text(CAMPAIGN)
    return load_campaign(folder / "campaign.toml")


@pytest.mark.slow
def test_the_right_body_is_adequate_and_all_its_peaks_are_modes(tmp_path):
    said = diagnosed(written(tmp_path, 1.0))
    assert said.decision.status == "adequate"
    assert said.p_value > SIGNIFICANT
    assert not said.peaks.uncertain


@SIZES
def test_the_inertia_is_found_by_peaks_that_no_mode_explains(tmp_path, count):
    said = diagnosed(written(tmp_path, 0.5, POSES[:count]))
    assert said.decision.classes == (("platform_inertia",),)
    (size,) = said.sizes
    assert np.abs(size.mean - np.log(0.5)).min() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("count", [2, len(POSES)])
def test_a_large_change_about_one_axis_is_found(tmp_path, count):
    """All peaks but one find modes, so small changes show nothing."""
    about_y = np.sqrt([1.0, 1.4, 1.0])
    said = diagnosed(written(tmp_path, np.outer(about_y, about_y), POSES[:count]))
    assert said.p_value < SIGNIFICANT
    assert said.decision.classes == (("platform_inertia",),)


@pytest.mark.slow
def test_a_cell_beside_the_inertia_is_found_with_it(tmp_path):
    """15 N too high: gain or zero in three states, and nothing does what half the inertia does."""
    campaign = written(tmp_path, 0.5)
    high = campaign.states.tension + 15.0 * np.eye(campaign.states.tension.shape[1])[1]
    said = diagnosed(replace(campaign, states=replace(campaign.states, tension=high)))
    assert ("platform_inertia",) in said.decision.classes
    (cell,) = [names for names in said.decision.classes if names != ("platform_inertia",)]
    assert set(cell) <= {"load_cell_gain", "load_cell_bias"}

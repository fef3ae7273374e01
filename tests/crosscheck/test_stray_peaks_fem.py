"""Peaks of the FEM where the model has no mode: a body turned lighter is found by them, the right one has none."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.prepared import BUDGETS, SIGNIFICANT, prepare
from cdpr_struct.diagnosis.selection import FURTHER, select
from cdpr_struct.diagnosis.stray_peaks import clears
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.conftest import at_rest

POSES = np.array([[0.4, 0.3, 0.6], [-0.8, 0.5, 1.0], [0.9, -0.7, 0.8]])
FOUR_POSES = np.concatenate([POSES, [[1.5, 0.8, 0.5]]])  # in the last one a mode is near a cable's own frequency
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


def test_no_peak_of_the_right_body_is_stray(tmp_path):
    prepared = prepare(written(tmp_path, 1.0), BUDGETS["small"])
    assert prepared.ground.strays < 0.2
    assert prepared.p_value > 0.04


@SIZES
def test_the_inertia_is_found_by_peaks_that_no_mode_explains(tmp_path, count):
    found = diagnose(written(tmp_path, 0.5, POSES[:count]))
    said = verdict(found)
    assert found.ground.strays > 1.5
    assert said.causes == ("platform_inertia",)
    sizes = np.exp(found.selection.fit.theta * found.selection.fit.choices[0].prior)
    assert np.abs(np.log(sizes / 0.5)).min() < 0.1
    assert found.selection.fit.ground.strays == pytest.approx(0.0, abs=0.2)


@SIZES
def test_one_stray_peak_is_enough_to_find_a_large_change_about_one_axis(tmp_path, count):
    """All other peaks find modes, so small changes show nothing; the law that catches the stray is significant."""
    about_y = np.sqrt([1.0, 1.4, 1.0])
    found = diagnose(written(tmp_path, np.outer(about_y, about_y), POSES[:count]))
    assert found.ground.strays == pytest.approx(1.0, abs=0.1)
    assert found.p_value < SIGNIFICANT
    assert found.selection.fit.names == ("platform_inertia",)
    assert found.selection.fit.ground.strays == pytest.approx(0.0, abs=0.1)


@pytest.mark.slow
def test_rivals_are_looked_for_in_the_world_that_explains_everything(tmp_path):
    """A cell 15 N too high beside half the inertia: gain or zero in three states, and nothing does what inertia does.

    The modes are those of half the inertia then, so no rival is held against peaks of another body.
    """
    campaign = written(tmp_path, 0.5)
    high = campaign.states.tension + 15.0 * np.eye(campaign.states.tension.shape[1])[1]
    campaign = replace(campaign, states=replace(campaign.states, tension=high))
    search = prepare(campaign, BUDGETS["small"]).search
    found = select(search, FURTHER, 2)
    cell, other = "load_cell_gain", "load_cell_bias"
    cell, other = (cell, other) if cell in found.fit.names else (other, cell)
    assert set(found.fit.names) == {"platform_inertia", cell}
    assert clears(found.fit)
    for i, name in enumerate(found.fit.names):
        behind = {fit.names[-1]: found.fit.gain - fit.gain for fit in search.replacing(found.fit, i)}
        nearest = min(behind, key=lambda rival: behind[rival])
        assert (behind[nearest] < 6.0, nearest == other) == (name == cell, name == cell), behind


def test_frequencies_near_those_of_a_cable_are_followed_from_the_likeliest_tolerances(tmp_path):
    """6 % of inertia are two of its sigmas. A frequency answers them by 2 %, not by the 70 % of a pole in between."""
    ground = prepare(written(tmp_path, 1.06, FOUR_POSES), BUDGETS["small"]).ground
    rows = ground.setting.labels.block == "RF"
    assert np.sqrt(np.diagonal(ground.null.covariance))[rows].max() < 5.0
    assert np.abs(ground.null.r[rows]).max() < 5.0

"""Force limits in robot and campaign files: what they mean, and one sentence where they cannot be used."""

import numpy as np
import pytest

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.robot.robot_file import load_robot
from tests.robustness.test_bad_input import ANCHORS, ROBOT

TWO = ROBOT.replace("linear_density = 0.05\n", "linear_density = 0.05\n{default}") + ANCHORS + "{own}" + ANCHORS
CAMPAIGN = """
robot = "{robot}"
{bound}
[[measurement]]
kind = "static_state"
file = "states.csv"
"""
ROWS = "".join(f"a,0,0,2.5,{i},{300 if i < 5 else 80}\n" for i in range(1, 9))
STATES = "case,x_m,y_m,z_m,cable,tension_N\n" + ROWS


def written(tmp_path, default="", own=""):
    path = tmp_path / "robot.toml"
    path.write_text(TWO.format(default=default, own=own))
    return path


@pytest.mark.parametrize(
    ("default", "own", "low", "high"),
    [
        ("", "", [0.0, 0.0], [np.inf, np.inf]),
        ("force_min = 5\nforce_max = 700.0\n", "", [5.0, 5.0], [700.0, 700.0]),
        ("force_min = 5.0\n", "force_min = 0.0\nforce_max = 9.0\n", [0.0, 5.0], [9.0, np.inf]),
        ("force_max = 700.0\n", "force_max = inf\n", [0.0, 0.0], [np.inf, 700.0]),
    ],
    ids=range(4),
)
def test_an_entry_overrides_the_default(default, own, low, high, tmp_path):
    robot = load_robot(written(tmp_path, default, own))
    np.testing.assert_array_equal(robot.force_min, low)
    np.testing.assert_array_equal(robot.force_max, high)


@pytest.mark.parametrize(
    ("default", "own", "words"),
    [
        ("force_min = -1.0\n", "", ["cable.force_min", "-1.0", "not below 0"]),
        ("force_min = nan\n", "", ["cable.force_min", "nan"]),
        ("force_min = inf\n", "", ["cable.force_min", "inf"]),
        ("force_max = 0.0\n", "", ["cable.force_max", "0.0", "above"]),
        ("force_max = nan\n", "", ["cable.force_max", "nan"]),
        ("force_max = 1e300\n", "", ["cable.force_max", "1e+300", "leave it out"]),
        ("force_max = 'much'\n", "", ["cable.force_max", "much", "number"]),
        ("", "force_min = true\n", ["cables[1].force_min", "True"]),
        ("force_min = 50.0\nforce_max = 40.0\n", "", ["cable.force_max", "40.0", "above force_min = 50 N"]),
        ("force_min = 50.0\n", "force_max = 40.0\n", ["cables[1].force_max", "40.0", "above force_min = 50 N"]),
        ("force_max = 40.0\n", "force_min = 50.0\n", ["cable.force_max", "40.0", "above force_min = 50 N"]),
    ],
    ids=range(11),
)
def test_limits_that_cannot_be_used(default, own, words, tmp_path):
    path = written(tmp_path, default, own)
    with pytest.raises(InputError) as error:
        load_robot(path)
    line = str(error.value)
    assert line.startswith(str(path))
    assert all(word in line for word in words), line


def campaign(tmp_path, bound="", robot="thesis-5"):
    (tmp_path / "states.csv").write_text(STATES)
    path = tmp_path / "campaign.toml"
    path.write_text(CAMPAIGN.format(robot=robot, bound=bound))
    return path


def test_a_campaign_without_a_bound_means_the_robots(tmp_path):
    assert load_campaign(campaign(tmp_path)).lower_bound is None
    assert load_campaign(campaign(tmp_path, "lower_bound_N = 0.0")).lower_bound == 0.0
    assert load_campaign(campaign(tmp_path, "lower_bound_N = 150.0")).lower_bound == 150.0


def test_a_campaigns_bound_above_the_robots_limit_is_refused(tmp_path):
    limited = "".join(f"{ANCHORS.replace('0.1', f'0.{i}')}" for i in range(1, 9))
    (tmp_path / "robot.toml").write_text(ROBOT + "force_max = 100.0\n" + limited)
    with pytest.raises(InputError, match=r"lower_bound_N: got 150.0; a force in N below the robot's least force_max"):
        load_campaign(campaign(tmp_path, "lower_bound_N = 150.0", "robot.toml"))

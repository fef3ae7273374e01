"""What a new user is told: how to let a robot hang, which model is at fault, and what is wrong with a file."""

import re

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.crosscheck.limits_poses import PARAMETERS
from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import require_file
from cdpr_struct.reports.audit_result import audit_checks
from cdpr_struct.reports.statics_map import map_sentence
from cdpr_struct.reports.trust import Trust

HANG = "--free rx,ry,rz"
CAMPAIGN = """robot = "cogiro"
model = "exact"
[[measurement]]
kind = "static_state"
file = "static.csv"
"""
LEVEL = "case,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg"
STATIC = f"{LEVEL},cable,tension_N\n" + "".join(f"a,0,0.5,1.2,0,0,0,{i},300\n" for i in range(1, 9))


@pytest.mark.parametrize(("cables", "hangs"), [(6, True), (7, True), (8, False)])
def test_a_new_robot_names_a_map_that_its_cables_hold(cables, hangs, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["new-robot", "mine", "--cables", str(cables), "--size", "5,4,3"]) == 0
    told = capsys.readouterr().out
    assert (HANG in told) == hangs
    line = next(line.strip() for line in told.splitlines() if line.strip().startswith("cdpr-struct map"))
    assert run(line.split()[1:]) == 0
    assert "cannot be held" not in capsys.readouterr().out


def test_a_map_of_a_hanging_robot_names_the_option_only_where_it_helps():
    robot = cs.new_robot("mine", cables=6, size=(5, 4, 3)).robot
    grid = "-0.75:0.75:3,-0.6:0.6:3,1.2"
    level = cs.map(robot, grid, "tension-max").answer
    assert level["held"] < level["poses"]
    assert HANG in map_sentence(level)
    assert HANG not in map_sentence(level | {"free": {}})
    assert HANG not in map_sentence(level | {"held": level["poses"]})
    assert HANG not in map_sentence(level | {"cables": 8})


def test_an_audit_names_the_remedy_for_slack_cables():
    audit = cs.audit("cogiro").audit
    assert not Trust(tuple(audit_checks(audit))).warnings
    audit.tension[:] *= 1e-3
    (said,) = Trust(tuple(audit_checks(audit))).warnings
    assert "At the pose cables hang slack" in said
    assert set(audit.value) == set(PARAMETERS)


def refused(folder, static=STATIC, more=""):
    (folder / "static.csv").write_text(static)
    (folder / "campaign.toml").write_text(CAMPAIGN + more)
    with pytest.raises(InputError) as found:
        cs.diagnose(folder / "campaign.toml")
    return str(found.value)


def test_a_decimal_comma_is_named(tmp_path):
    assert "a number with a decimal point: 300.5" in refused(tmp_path, STATIC.replace("1,300", '1,"300,5"', 1))


def test_a_data_file_that_is_not_there_is_said_to_be_absent(tmp_path):
    more = '[[measurement]]\nkind = "robot_frequency"\nfile = "robot.csv"\n'
    assert "got 'robot.csv'; no such data file" in refused(tmp_path, more=more)


def test_a_folder_in_place_of_a_campaign_names_the_file_in_it(tmp_path):
    (tmp_path / "my_campaign.toml").touch()
    with pytest.raises(InputError, match=re.escape(f"a file, not a folder; give {tmp_path / 'my_campaign.toml'}")):
        require_file(tmp_path)


@pytest.mark.parametrize(("factor", "named"), [(1000.0, True), (1.5, False)])
def test_millimetres_in_one_of_two_files_are_asked_about(factor, named, tmp_path):
    x, y, z = factor * np.array([0.0, 0.5, 1.2])
    (tmp_path / "robot.csv").write_text(f"{LEVEL},frequency_hz\na,{x},{y},{z},0,0,0,2.5\n")
    more = '[[measurement]]\nkind = "robot_frequency"\nfile = "robot.csv"\n'
    assert ("is one of the two positions in mm?" in refused(tmp_path, more=more)) == named


def test_a_recording_of_a_case_without_a_pose_is_refused(tmp_path):
    rows = "".join(f"{case},{0.01 * i},0,0,{i % 3}\n" for case in "ab" for i in range(80))
    (tmp_path / "stop.csv").write_text("case,time_s,ax,ay,az\n" + rows)
    told = refused(tmp_path, more='[[measurement]]\nkind = "free_decay"\nfile = "stop.csv"\n')
    assert "case b: got 'no pose'" in told
    assert told.endswith("Cases with a pose: a")

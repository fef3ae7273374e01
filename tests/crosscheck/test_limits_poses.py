"""The cables of a robot against the printed limits, over poses; and the command."""

import csv
import json

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.crosscheck.limits_poses import PARAMETERS, audit_poses, audit_rest
from cdpr_struct.crosscheck.validity_limits import check_limits, epsilon_limit, epsilon_limits
from cdpr_struct.robot.robot_file import load_robot
from tests.conftest import at_rest

OUTSIDE = np.array([6.0, 3.0, 0.5])


def test_batch_equals_pose_by_pose():
    robot = load_robot("thesis-3-1")
    places = np.array([[0.0, 0.0, 0.5], OUTSIDE, [-6.5, -4.0, 1.0]])
    audit = audit_poses(robot, places, np.eye(3))
    assert audit.held.all()
    for i, place in enumerate(places):
        one = check_limits(at_rest("thesis-3-1", place))
        found = {
            (cable + 1, name, round(float(audit.value[name][i, cable]), 6))
            for name in PARAMETERS
            for cable in np.flatnonzero(audit.broken[name][i])
        }
        assert found == {(v.cable, v.parameter, round(v.value, 6)) for v in one.violations}
    assert audit.count[0] == 0
    assert audit.count[1] > 0


def test_rest_equals_pose(thesis_point):
    rest = audit_rest(thesis_point)
    pose = audit_poses(thesis_point.robot, thesis_point.position[None], np.eye(3))
    for name in PARAMETERS:
        assert rest.value[name] == pytest.approx(pose.value[name], rel=1e-6)
    assert rest.count.tolist() == [0]


def test_a_light_platform_breaks_the_limit_on_lambda():
    robot = load_robot("thesis-3-1")
    audit = audit_poses(robot.with_load(mass=8.0), np.array([[0.0, 0.0, 0.5]]), np.eye(3))
    assert audit.broken["lambda2"].any()


def test_unheld_poses_say_why_and_count_nothing():
    audit = audit_poses(load_robot("thesis-3-1"), np.array([[0.0, 0.0, 0.5], [7.95, -4.0, 0.5]]), np.eye(3))
    assert audit.held.tolist() == [True, False]
    assert audit.reason[0] == ""
    assert "unbalanced" in audit.reason[1]
    assert audit.count[1] == 0
    assert audit.worst_cable[1] == 0
    assert np.isnan(audit.value["lambda2"][1]).all()


def test_epsilon_limit_of_arrays():
    angles = np.array([0.0, 29.9, 30.1, 59.9, 60.1, np.nan])
    assert epsilon_limits(angles)[:5].tolist() == [epsilon_limit(a) for a in angles[:5]]
    assert np.isnan(epsilon_limits(angles)[5])


def result(arguments, capsys, code):
    assert run([*arguments, "--json"]) == code
    return json.loads(capsys.readouterr().out)


def test_command_passes_a_good_pose(capsys):
    r = result(["audit", "thesis-3-1", "--pose", "0,0,0.5"], capsys, 0)
    assert r["violations"] == []
    assert r["valid"]


def test_command_names_cable_parameter_value_and_limit(capsys):
    r = result(["audit", "thesis-3-1", "--pose", "6,3,0.5"], capsys, 1)
    worst = max((v for v in r["violations"] if v["parameter"] == "lambda2"), key=lambda v: v["value"])
    assert worst.keys() == {"pose", "cable", "parameter", "value", "limit"}
    assert worst["value"] > worst["limit"] == 24.0
    assert worst["pose"] == pytest.approx([6.0, 3.0, 0.5, 0.0, 0.0, 0.0])


def test_command_writes_map_table_and_report(tmp_path, capsys):
    grid = "--grid=-7.9:7.9:9,-5:5:5,0.5"
    assert run(["audit", "thesis-3-1", grid, "--out", str(tmp_path)]) == 1
    assert {"result.json", "audit.csv", "map.svg", "report.html"} <= {p.name for p in tmp_path.iterdir()}
    r = json.loads((tmp_path / "result.json").read_text())
    rows = list(csv.DictReader((tmp_path / "audit.csv").read_text().splitlines()))
    assert len(rows) == r["poses"] * 8 == 9 * 5 * 8
    assert sum(len(row["violates"].split(";")) for row in rows if row["violates"]) == len(r["violations"])
    assert r["poses_held"] + len(r["unheld"]) == r["poses"]
    assert "OUTSIDE" in capsys.readouterr().out


def test_command_follows_the_helix_and_a_file(tmp_path, capsys):
    r = result(["audit", "thesis-5", "--trajectory", "helix", "--lower-bound", "500"], capsys, 0)
    assert r["poses"] == r["poses_held"] == 301
    path = tmp_path / "way.csv"
    path.write_text("time_s,x_m,y_m,z_m\n0,0,0,0.5\n1,6,3,0.5\n")
    r = result(["audit", "thesis-3-1", "--trajectory", str(path), "--out", str(tmp_path / "out")], capsys, 1)
    assert {v["time_s"] for v in r["violations"]} == {1.0}
    assert (tmp_path / "out" / "course.svg").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["audit"], ["ROBOT", "--limits"]),
        (["audit", "thesis-3-1", "--limits"], ["ROBOT", "thesis-3-1"]),
        (["audit", "--limits", "--pose", "0,0,1"], ["--pose", "0,0,1"]),
        (["audit", "--limits", "--tolerance", "2"], ["--tolerance", "2"]),
        (["audit", "thesis-3-1", "--pose", "0,0,1", "--grid", "0:1:2,0,0"], ["--grid", "only one"]),
        (["audit", "thesis-3-1", "--trajectory", "nowhere.csv"], ["--trajectory", "nowhere.csv"]),
        (["audit", "thesis-3-1", "--lower-bound", "-1"], ["--lower-bound", "-1"]),
    ],
    ids=lambda value: " ".join(value)[:50] if isinstance(value, list) else None,
)
def test_bad_input_is_one_line_and_exit_2(arguments, words, capsys):
    assert run(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert len(captured.err.strip().splitlines()) == 1
    assert all(word in captured.err for word in words), captured.err


def test_command_tries_the_limits(tmp_path, capsys):
    assert run(["audit", "--limits", "--small", "--out", str(tmp_path)]) == 1
    names = {p.name for p in tmp_path.iterdir()}
    assert {"result.json", "report.html", "veering.svg", "error_in_plane_frequency.svg", "evidence.svg"} <= names
    r = json.loads((tmp_path / "result.json").read_text())
    assert {"inside_limits", "missing_limits", "needlessly_strict", "referee"} <= r.keys()
    assert {"parameter", "threshold", "evidence"} <= r["missing_limits"][0].keys()
    assert "DO NOT SUFFICE" in capsys.readouterr().out

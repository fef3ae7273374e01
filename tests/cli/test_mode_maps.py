"""map --quantity mode-K and frequencies: what they write, say and refuse."""

import json

import numpy as np
import pandas as pd
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

VEERING = ["map", "cogiro", "--grid=-1:1:9,-1:1:9,1", "--quantity", "mode-3"]


def written(arguments, folder):
    assert run([*arguments, "--out", str(folder)]) == 0
    return json.loads((folder / "result.json").read_text()), pd.read_csv(folder / "map.csv")


def test_a_followed_mode_says_where_it_comes_from_and_where_that_is_in_doubt(tmp_path):
    result, table = written(VEERING, tmp_path)
    assert list(table.columns) == [
        "x_m", "y_m", "z_m", "mode_Hz", "mode_number", "mac", "followed_from", "veering", "behind_veering",
        "slack_cables", "sag_over_chord_max", "strain_max", "cut_short", "held",
    ]  # fmt: skip
    start = table[table.followed_from == 0]
    assert len(start) == 1
    assert start.mode_number.item() == 3
    assert result["reference"]["position_m"] == [start.x_m.item(), start.y_m.item(), start.z_m.item()] == [0, 0, 1]
    assert result["reference"]["mode_Hz"] == start.mode_Hz.item()
    assert 0 < result["veering_poses"] == table.veering.sum() < 81
    assert result["behind_veering_poses"] == table.behind_veering.sum()
    before = table.followed_from.drop(start.index)
    assert before.between(1, 81).all()
    page = (tmp_path / "report.html").read_text()
    assert "Triangles: modes veer" in page
    assert f"At {result['veering_poses']} of 81 poses modes veer" in page
    assert "Followed from (0, 0, 1) m" in page


def test_every_frequency_of_a_followed_mode_is_one_of_the_pose(tmp_path):
    _, table = written(VEERING, tmp_path)
    robot = load_robot("cogiro")
    some = table.iloc[::13]
    positions = some[["x_m", "y_m", "z_m"]].to_numpy()
    turns = np.broadcast_to(np.eye(3), (len(some), 3, 3))
    cables = inverse(robot, positions, turns).cables
    for i, row in enumerate(some.itertuples()):
        point = OperatingPoint(robot, positions[i], turns[i], cables.at(i))
        exact = certified_modes(point, "exact", row.mode_number).frequencies.hertz
        assert row.mode_Hz == pytest.approx(exact[-1], rel=2e-7)


def test_chunks_and_processes_do_not_change_which_mode_is_followed(tmp_path):
    _, one = written(VEERING, tmp_path / "one")
    _, two = written([*VEERING, "--chunk", "20", "--workers", "2"], tmp_path / "two")
    for name in ("mode_number", "followed_from", "veering", "behind_veering"):
        assert (one[name] == two[name]).all()
    np.testing.assert_allclose(one.mode_Hz, two.mode_Hz, rtol=1e-12)


def test_an_interrupted_map_of_a_mode_continues_from_its_shapes(tmp_path, capsys, monkeypatch):
    """Chunks on disk hold the shapes; what is read back gives the same map."""
    from cdpr_struct.cli import map as command

    monkeypatch.setattr(command, "clear_checkpoint", lambda sweep, directory: None)
    arguments = [*VEERING, "--chunk", "20", "--overwrite"]
    _, first = written(arguments, tmp_path)
    result, second = written(arguments, tmp_path)
    assert result["resumed_chunks"] == 5
    pd.testing.assert_frame_equal(first, second)


def test_frequencies_are_those_of_modes_with_their_widest_bracket(tmp_path, capsys):
    result, table = written(["map", "cogiro", "--grid=0.4,-0.3:0.3:2,1", "--quantity", "frequencies"], tmp_path)
    assert result["smallest"]["value"] == table.f1_Hz.min()
    assert table.quick.all()
    capsys.readouterr()
    for row in table.to_dict("records"):
        pose = f"--pose={row['x_m']},{row['y_m']},{row['z_m']}"
        assert run(["modes", "cogiro", pose, "--model", "exact", "--count", "12", "--json"]) == 0
        exact = json.loads(capsys.readouterr().out)["frequencies_hz"]
        ours = [row[f"f{i}_Hz"] for i in range(1, 13)]
        np.testing.assert_allclose(ours, exact, rtol=2e-7)
        assert 0.0 < row["bracket_max_Hz"] < 1e-6 * exact[-1]


@pytest.mark.parametrize("name", ["mode-0", "mode-61", "mode-99", "mode-x", "mode-", "mode-03", "mode--1", "mode-1.5"])
def test_a_mode_that_is_none_is_refused_in_one_sentence(name, capsys):
    assert run(["map", "cogiro", "--grid=0,0,1", "--quantity", name]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert name in said
    assert "mode-K with K from 1 to 60" in said


def test_a_grid_whose_shapes_do_not_fit_into_memory_is_refused_before_anything_is_computed(capsys):
    assert run(["map", "cogiro", "--grid=-1:1:101,-1:1:101,0:1:101", "--quantity", "mode-3"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "1030301 poses" in said
    assert "mode-3" in said


def test_where_no_pose_is_held_there_is_no_mode(tmp_path, capsys):
    assert run(["map", "cogiro", "--grid=20:21:2,0,1", "--quantity", "mode-2", "--out", str(tmp_path)]) == 1
    assert json.loads((tmp_path / "result.json").read_text())["reference"] is None
    assert pd.read_csv(tmp_path / "map.csv").mode_Hz.isna().all()

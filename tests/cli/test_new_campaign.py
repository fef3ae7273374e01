"""A new campaign has files that the reader knows, and is refused with one sentence until it is filled."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.campaigns import read_campaign
from cdpr_struct.measurement.campaign_template import READINGS
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.laws.written_campaigns import clamped_hertz

POSES = "0,0,1;1,0.5,1.2,0,0,3"


@pytest.fixture
def made(tmp_path) -> Path:
    """A campaign of all kinds of readings but those of pulleys."""
    kinds = ",".join(kind for kind in READINGS if kind != "swivels")  # it has no pulleys
    words = ["new-campaign", "cogiro", "--kinds", kinds, "--poses", POSES, "--payload", "20"]
    assert run([*words, "--out", str(tmp_path / "c"), "--quiet"]) == 0
    return tmp_path / "c"


def filled(directory: Path, name: str = "*.csv") -> None:
    """Fill each open cell with what the simulation predicts."""
    for path in directory.glob(name):
        table = pd.read_csv(path, comment="#", dtype=str)
        for name in table:
            if (told := f"predicted_{name}") in table:
                table[name] = table[name].where(table[name] != "?", table[told])
        table.to_csv(path, index=False)


def test_the_template_is_refused_by_one_sentence(made, capsys):
    assert run(["diagnose", str(made / "campaign.toml")]) == 2
    line = capsys.readouterr().err.strip()
    assert len(line.splitlines()) == 1
    assert "states.csv" in line
    assert "not filled yet" in line
    assert "32 cells with ?, the first in row 1, column tension_1_N" in line


def test_every_file_is_asked_for(made, capsys):
    for name in ("states.csv", "cable_frequencies.csv", "robot_frequencies.csv", "loaded.csv"):
        assert run(["diagnose", str(made / "campaign.toml")]) == 2
        assert f"{name}: not filled yet" in capsys.readouterr().err
        filled(made, name)


def test_filled_with_the_predictions_it_is_a_campaign(made):
    filled(made)
    campaign = cs.load_campaign(made / "campaign.toml")
    assert campaign.kinds() == ["static_state", "loaded_pose", "cable_frequency", "robot_frequency"]
    assert sorted(campaign.states.names) == sorted(["pose 1", "pose 2", "pose 1 with 20 kg", "pose 2 with 20 kg"])
    held = cs.inverse("cogiro", "1,0.5,1.2,0,0,3")
    state = list(campaign.states.names).index("pose 2")
    np.testing.assert_allclose(campaign.states.tension[state], held.solution.tensions, rtol=1e-5)
    np.testing.assert_allclose(campaign.states.length[state], held.solution.lengths, rtol=1e-5)
    modes = cs.modes("cogiro", "1,0.5,1.2,0,0,3", count=6).modes.hertz
    np.testing.assert_allclose(campaign.robot_frequencies.hertz[6:], modes, rtol=1e-5)
    heavy = list(campaign.states.names).index("pose 1 with 20 kg")
    moved = cs.forward("cogiro", lengths=cs.inverse("cogiro", "0,0,1").solution.lengths, start="0,0,1", payload=20.0)
    np.testing.assert_allclose(campaign.states.position[heavy], moved.answer["pose"][:3], atol=1e-5)


ON_PULLEYS = ["--pulleys", "0.05", "--cables", "8", "--size", "3,3,2"]


def test_over_pulleys_the_frequency_to_pluck_is_that_in_the_plane(tmp_path):
    """Of each cable between held ends the lowest mode is the swivel's, out of the plane, and the next is in it."""
    assert run(["new-robot", "mine", *ON_PULLEYS, "--out", str(tmp_path / "mine.toml"), "--quiet"]) == 0
    words = ["new-campaign", str(tmp_path / "mine.toml"), "--kinds", "cable_frequency", "--out", str(tmp_path / "c")]
    assert run([*words, "--quiet"]) == 0
    table = pd.read_csv(tmp_path / "c" / "cable_frequencies.csv", comment="#")
    told = table[[f"predicted_frequency_{i}_hz" for i in range(1, 9)]].to_numpy()[0]
    robot = cs.load_robot(tmp_path / "mine.toml")
    held = inverse(robot, robot.home.position, robot.home.rotation)
    point = OperatingPoint(robot, robot.home.position, robot.home.rotation, held.cables)
    lowest = clamped_hertz(point, 2)  # by bisection of the number of modes below a frequency
    assert (lowest[:, 0] < 0.999 * lowest[:, 1]).all()
    np.testing.assert_allclose(told, lowest[:, 1], rtol=1e-5)  # six digits are written
    assert list(table["plane"]) == ["in"]


def test_a_case_with_its_lengths_in_states_is_asked_for_them_once(made):
    """Two readings of one state would contradict each other; those under load are others."""
    table = pd.read_csv(made / "loaded.csv", comment="#", dtype=str, keep_default_na=False)
    lengths = table[[f"length_{i}_m" for i in range(1, 9)]].to_numpy()
    assert not re.search(r"e-[1-9]\d", table.to_csv())  # rounding is zero
    assert (lengths[::2] == "").all()
    assert (lengths[1::2] == "?").all()
    filled(made)
    campaign = cs.load_campaign(made / "campaign.toml")
    assert np.isfinite(campaign.states.length).all()


def test_kinds_of_files_are_understood(tmp_path):
    chosen = cs.new_campaign("cogiro", kinds="static_state,loaded_pose", directory=tmp_path)
    assert chosen.files.keys() == {"campaign.toml", "states.csv", "loaded.csv"}
    assert {"tension_1_N", "length_1_m"} <= set(chosen.files["states.csv"].splitlines()[-2].split(","))


def test_a_plan_needs_no_readings(made):
    """A template that is not filled stands for what it predicts, in all kinds of files."""
    planned = read_campaign(made / "campaign.toml", None, None, planned=True)
    filled(made)
    entered = cs.load_campaign(made / "campaign.toml")
    np.testing.assert_array_equal(planned.states.tension, entered.states.tension)
    np.testing.assert_array_equal(planned.states.position, entered.states.position)
    np.testing.assert_array_equal(planned.robot_frequencies.hertz, entered.robot_frequencies.hertz)
    np.testing.assert_array_equal(planned.cable_frequencies.hertz, entered.cable_frequencies.hertz)


@pytest.mark.slow
def test_plan_takes_a_template(tmp_path):
    assert run(["new-campaign", "cogiro", "--poses", POSES, "--out", str(tmp_path / "c"), "--quiet"]) == 0
    assert run(["plan", str(tmp_path / "c" / "campaign.toml"), "--quiet"]) == 0


def test_poses_come_from_a_file_and_robots_from_theirs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "poses.csv").write_text("case,x_m,y_m,z_m,rz_deg\nleft,-0.5,0,1.2,5\nright,0.5,0,1.2,0\n")
    assert run(["new-robot", "mine", "--quiet"]) == 0
    assert run(["new-campaign", "mine.toml", "--poses", "poses.csv", "--out", "c/d", "--quiet"]) == 0
    assert 'robot = "../../mine.toml"' in (tmp_path / "c" / "d" / "campaign.toml").read_text()
    table = pd.read_csv(tmp_path / "c" / "d" / "states.csv", comment="#")
    assert list(table["case"]) == ["left", "right"]
    assert list(table["rz_deg"]) == [5.0, 0.0]
    filled(tmp_path / "c" / "d")
    assert len(cs.load_campaign(tmp_path / "c" / "d" / "campaign.toml").states.names) == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--kinds", "smell"], ["--kinds", "smell", "tensions"]),
        (["--poses", "1,2"], ["--poses", "1,2"]),
        (["--poses", ";"], ["--poses", "0 poses"]),
        (["--poses", "none.csv"], ["none.csv"]),
        (["--payload", "0"], ["--payload", "0"]),
        (["--poses", "0,0,1;0,0,9"], ["pose 2", "0.0,0.0,9.0"]),
    ],
)
def test_unusable_options_are_named(words, said, tmp_path, capsys):
    assert run(["new-campaign", "cogiro", *words, "--out", str(tmp_path / "c")]) in (1, 2)
    line = capsys.readouterr().err.strip()
    assert len(line.splitlines()) == 1
    assert all(word in line for word in said), line
    assert not (tmp_path / "c").exists()


def test_nothing_is_overwritten_unasked(made, capsys):
    mine = made / "loaded.csv"
    mine.write_text("my own")
    words = ["new-campaign", "cogiro", "--kinds", "loaded", "--out", str(made), "--quiet"]
    assert run(words) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert mine.read_text() == "my own"
    assert run([*words, "--overwrite"]) == 0
    assert "pose" in mine.read_text()
    with pytest.raises(cs.InputError, match=re.escape("overwrite=True")):
        cs.new_campaign("cogiro").write(made)

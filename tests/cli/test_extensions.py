"""[extensions] of a robot file on the command line: what acts, what is said, what is refused."""

import json
from dataclasses import replace

import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml

GIVEN = {"series_compliance": 2e-6, "bending_stiffness": 0.1, "cell_gain": 1.05, "length_offset": 0.002}
COMMANDS = {
    "inverse": [],
    "forward": ["--lengths", "10.78,10.38,10.78,10.38,10.24,10.64,10.24,10.64"],
    "modes": ["--count", "4"],
    "frf": ["--excite", "fz", "--respond", "z", "--band", "1:2:0.2"],
    "transient": ["--initial-velocity", "0.1,0,0", "--duration", "1", "--highest", "4"],
    "map": ["--grid=-1:1:2,0,0.5", "--quantity", "first-frequency"],
    "pose-error": ["--grid=-1:1:2,0,0.5"],
    "audit": [],
    "verify": ["--modes", "6", "--elements", "8,16,24"],
}


def robot_file(directory, given) -> str:
    robot = load_robot("thesis-3-1")
    path = directory / "robot.toml"
    path.write_text(robot_toml(replace(robot, extensions=Extensions.of(8, given)), "soft"))
    return str(path)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_says_what_becomes_of_each_extension(command, tmp_path, capsys):
    words = [command, robot_file(tmp_path, GIVEN), *COMMANDS[command]]
    assert run([*words, "--json", "--out", str(tmp_path / "out")]) in (0, 1)
    said = json.loads(capsys.readouterr().out)["extensions"]
    assert set(said["acting"]) | set(said["idle"]) == set(GIVEN)
    assert "series_compliance" in said["acting"]
    assert "cell_gain" in said["idle"]
    assert json.loads((tmp_path / "out" / "result.json").read_text())["extensions"] == said
    page = tmp_path / "out" / "report.html"
    assert not page.exists() or "only diagnose and plan compare" in page.read_text()


def test_sentences_stand_on_the_screen(tmp_path, capsys):
    assert run(["modes", robot_file(tmp_path, GIVEN), "--count", "3", "--model", "dsm", "--force"]) == 0
    text = capsys.readouterr().out
    assert "that act: series_compliance, length_offset." in text
    assert "No effect here: bending_stiffness; this cable model has none; --model exact does." in text


def test_a_robot_without_extensions_says_nothing_of_them(capsys):
    assert run(["inverse", "thesis-3-1", "--json"]) == 0
    assert "extensions" not in json.loads(capsys.readouterr().out)


def test_forward_and_inverse_speak_of_the_same_lengths(tmp_path, capsys):
    file = robot_file(tmp_path, GIVEN)
    assert run(["inverse", file, "--pose", "0.5,-1,0.8", "--json"]) == 0
    lengths = ",".join(f"{v:.12f}" for v in json.loads(capsys.readouterr().out)["lengths_m"])
    assert run(["forward", file, "--lengths", lengths, "--json"]) == 0
    pose = json.loads(capsys.readouterr().out)["pose"]
    assert pose[:3] == pytest.approx([0.5, -1.0, 0.8], abs=1e-8)
    assert run(["modes", file, "--lengths", lengths, "--count", "2", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["pose"][:3] == pytest.approx([0.5, -1.0, 0.8], abs=1e-8)
    assert ",".join(f"{v:.6f}" for v in result["lengths_m"]) == ",".join(f"{float(v):.6f}" for v in lengths.split(","))


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("mast_compliance = 1e-5", "known are causes, joint_mass, series_compliance"),
        ("series_compliance = [1e-5, 1e-5]", "give 8 numbers in square brackets, or one for all in m/N"),
        ("series_compliance = -1e-5", "in m/N, not below 0"),
        ("frame_compliance = [1e-5]", "give 8 numbers in square brackets, or one for all in m/N"),
        ("frame_compliance = [1e-5, 0, 0, 0, 2e-5, 0, 0, 0]", "cables 1, 5 hang on one mast: give equal numbers"),
        ("frame_compliance = [0, 0, 0, 0, 0, 0, 0, -1e-5]", "in m/N, not below 0"),
        ('hose = "stiff"', "give one number in N/m"),
        ("tilt = [0.1, nan]", "give 2 numbers in square brackets"),
        ("moment = [4.0]", "give 3 numbers in square brackets, or one for all in N m"),
        ("temperature_change = 1000.0", "give one number in K, not below -300, not above 300"),
        ("length_scale = 0.0", "above 0"),
        ("joint_mass = -1.0", "give one mass in kg, zero or more"),
        ("internal_mass = 3.0", "internal_mass = 3 kg needs internal_frequency, in Hz, above 0"),
        ("internal_mass = 300.0\ninternal_frequency = 5.0", "must be a part of the platform's mass: below 60 kg"),
        ("internal_direction = [0.0, 0.0, 0.0]", "give 3 numbers in square brackets"),
        ("causes = 3", "give a list of names"),
    ],
)
def test_unusable_extensions_are_refused_in_one_sentence(line, complaint, tmp_path, capsys):
    path = tmp_path / "robot.toml"
    text = robot_toml(load_robot("thesis-3-1"), "soft")
    path.write_text(text.replace("causes = []", line))
    assert run(["inverse", str(path)]) == 2
    said = capsys.readouterr().err
    assert "extensions." in said
    assert complaint in said
    assert len(said.strip().splitlines()) == 1


INNER = {"internal_mass": 3.0, "internal_frequency": 6.0, "internal_direction": [0.0, 0.6, 0.8]}
RIGID = {
    "inverse": "this concerns vibration only",
    "audit": "the printed limits know nothing of it",
    "verify": "the platform of the FEM is rigid, so this is left out on both sides",
}


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_knows_a_part_on_a_mount_or_says_why_not(command, tmp_path, capsys):
    assert run([command, robot_file(tmp_path, INNER), *COMMANDS[command], "--json"]) in (0, 1)
    said = json.loads(capsys.readouterr().out)["extensions"]
    if command in ("modes", "frf", "transient", "map"):
        assert said["acting"] == ["internal_mass"]
    else:
        assert said["idle"] == {"internal_mass": RIGID.get(command, RIGID["inverse"])}


def test_a_mass_below_that_of_the_part_on_the_mount_is_refused(tmp_path, capsys):
    assert run(["modes", robot_file(tmp_path, INNER), "--mass", "2"]) == 2
    assert "--mass: got 2.0; internal_mass = 3 kg must be a part" in capsys.readouterr().err


def test_joints_become_part_of_the_platform(tmp_path):
    path = tmp_path / "robot.toml"
    robot = load_robot("thesis-3-1")
    path.write_text(robot_toml(robot, "soft").replace("causes = []", "joint_mass = 0.25"))
    heavier = load_robot(path).platform
    assert heavier.mass == pytest.approx(robot.platform.mass + 2.0)
    assert (heavier.inertia.diagonal() > robot.platform.inertia.diagonal()).all()

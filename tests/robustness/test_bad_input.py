"""Unusable input: one line that names the field, the value and what would be right; exit code 2; no file written."""

import pytest

from cdpr_struct.cli.main import run

CABLE = ["cable", "--force", "100,-100", "--length", "20", "--EA", "2.5e5", "--rho", "0.067"]
ROBOT = """
name = "r"
[platform]
mass = 10.0
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
[cable]
axial_stiffness = 1e5
linear_density = 0.05
"""
ANCHORS = "[[cables]]\nplatform_anchor = [0.1, 0, 0]\nframe_anchor = [3, 0, 4]\n"


def complaint(arguments, capsys, code=2) -> str:
    assert run(arguments) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    lines = captured.err.strip().splitlines()
    assert len(lines) == 1, captured.err
    assert "Traceback" not in captured.err
    return lines[0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["cable", "--force", "100", "--length", "20", "--EA", "1", "--rho", "1"], ["--force", "100"]),
        (["cable", "--force", "a,b", "--length", "20", "--EA", "1", "--rho", "1"], ["--force", "a,b"]),
        ([*CABLE[:3], "--length", "-20", *CABLE[5:]], ["--length", "-20", "above zero"]),
        ([*CABLE[:3], "--length", "nan", *CABLE[5:]], ["--length", "nan"]),
        ([*CABLE[:3], "--length", "twenty", *CABLE[5:]], ["--length", "twenty"]),
        (["cable", "--force", "0,-100", *CABLE[3:]], ["--force", "horizontal"]),
        (["inverse", "no-such-robot"], ["no-such-robot", "thesis-3-1"]),
        (["inverse", "thesis-3-1", "--pose", "1,2"], ["--pose", "1,2"]),
        (["inverse", "thesis-3-1", "--pose", "1,2,inf"], ["--pose", "1,2,inf"]),
        (["inverse", "thesis-3-1", "--model", "rubber"], ["--model", "rubber", "sagging"]),
        (["inverse", "thesis-3-1", "--payload", "-3"], ["--payload", "-3"]),
        (["inverse", "thesis-3-1", "--mass", "0"], ["--mass", "0"]),
        (["inverse", "thesis-3-1", "--wrench", "1,2,3"], ["--wrench", "1,2,3"]),
        (["verify", "thesis-3-1", "--elements", "10,20"], ["--elements", "10,20", "three"]),
        (["verify", "thesis-3-1", "--elements", "10,25,40"], ["--elements", "multiples"]),
        (["verify", "thesis-3-1", "--modes", "0"], ["--modes", "0"]),
        (["verify", "thesis-3-1", "--assembly", "mine"], ["--assembly", "mine"]),
        (["reproduce", "table-9"], ["table-9", "table-2.2"]),
        (["frobnicate"], ["frobnicate"]),
        (["cable"], ["--force"]),
    ],
    ids=lambda value: " ".join(value)[:50] if isinstance(value, list) else None,
)
def test_bad_options(arguments, words, capsys):
    line = complaint(arguments, capsys)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name = ", ["TOML"]),
        (ROBOT, ["cables"]),
        (ROBOT + ANCHORS.replace("[3, 0, 4]", "[3, 0]"), ["cables[1].frame_anchor"]),
        (ROBOT + ANCHORS + "colour = 'red'\n", ["cables[1].colour", "red"]),
        (ROBOT.replace("mass = 10.0", "mass = -1.0") + ANCHORS, ["platform.mass", "-1.0"]),
        (ROBOT.replace("mass = 10.0", "mass = nan") + ANCHORS, ["platform.mass", "nan"]),
        (ROBOT.replace("mass = 10.0\n", "") + ANCHORS, ["platform.mass", "required"]),
        (ROBOT.replace("[[1, 0, 0]", "[[9, 0, 0]") + ANCHORS, ["inertia", "triangle"]),
        (ROBOT.replace("linear_density = 0.05\n", "") + ANCHORS, ["cables[1].linear_density"]),
        (ROBOT + ANCHORS, ["--pose", "home_pose"]),
    ],
    ids=range(10),
)
def test_bad_robot_files(text, words, tmp_path, capsys):
    path = tmp_path / "robot.toml"
    path.write_text(text)
    line = complaint(["inverse", str(path)], capsys)
    assert all(word in line for word in words), line


def test_a_binary_file_is_no_robot(tmp_path, capsys):
    path = tmp_path / "robot.toml"
    path.write_bytes(bytes(range(256)))
    assert "robot file" in complaint(["inverse", str(path)], capsys)


def test_a_pose_beyond_the_cables_is_refused_with_the_reason(capsys):
    """Below the frame's lower anchors and far outside it, the weight cannot be held by pulling cables."""
    line = complaint(["inverse", "thesis-3-1", "--pose", "30,0,0.5"], capsys, code=1)
    assert "cable" in line


def test_output_directory_that_is_a_file(tmp_path, capsys):
    path = tmp_path / "taken"
    path.write_text("x")
    assert run([*CABLE, "--out", str(path)]) == 2
    assert "--out" in capsys.readouterr().err
    assert path.read_text() == "x"

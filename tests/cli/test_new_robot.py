"""A new robot file is commented, valid, and taken by other commands at once; nothing is overwritten."""

import json

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.robot.robot_layout import COUNTS, anchors


@pytest.mark.parametrize("cables", COUNTS)
def test_every_number_of_cables_is_at_rest_and_vibrates(cables):
    made = cs.new_robot("mine", cables=cables, size=(8.0, 5.0, 4.0), mass=40.0)
    assert len(made.robot.cables) == cables
    hertz = cs.modes(made.robot, count=1).modes.hertz
    assert 1.0 < hertz[0] < 15.0
    if cables >= 8:
        assert made.robot.force_min.min() == 200.0  # half of the weight, two digits


def test_options_arrive_in_the_file(tmp_path, capsys):
    out = tmp_path / "mine.toml"
    words = ["--cables", "10", "--size", "9,7,5", "--mass", "30", "--rope", "dyneema", "--diameter", "6"]
    assert run(["new-robot", "my robot", *words, "--pulleys", "0.05", "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["file"], told["cables"], told["rope"]) == (str(out), 10, "dyneema")
    robot = cs.load_robot(out)
    assert robot.name == "my robot"
    assert robot.platform.mass == 30.0
    box = 30.0 / 12.0 * np.array([0.7**2 + 0.5**2, 0.9**2 + 0.5**2, 0.9**2 + 0.7**2])
    np.testing.assert_allclose(robot.platform.inertia, np.diag(box), rtol=5e-3)  # printed with three digits
    np.testing.assert_allclose(np.ptp(robot.frame_anchors, axis=0)[2], 5.0)
    assert robot.axial_stiffness[0] == 919000.0  # docs/ropes.md
    assert {pulley.radius for pulley in robot.pulleys} == {0.05}
    assert run(["modes", str(out), "--count", "3", "--quiet"]) == 0
    assert all("#" in line for line in out.read_text().splitlines() if line.startswith(("mass", "axial_", "linear_")))


def test_seen_from_above_cables_pass_the_middle_on_both_sides():
    """Otherwise nothing but gravity would resist turning about the vertical axis."""
    for cables in COUNTS[1:]:
        frame, platform = anchors(cables, np.array([6.0, 4.0, 3.0]), np.array([0.6, 0.4, 0.3]))
        along = frame - platform
        moment = platform[:, 0] * along[:, 1] - platform[:, 1] * along[:, 0]
        assert moment.min() < -0.01
        assert moment.max() > 0.01


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--cables", "5"], ["--cables", "5", "6 to 16"]),
        (["--cables", "17"], ["--cables", "17"]),
        (["--size", "6,4"], ["--size", "6,4"]),
        (["--size", "6,4,0"], ["--size", "above zero"]),
        (["--mass", "0"], ["--mass", "0"]),
        (["--rope", "hemp"], ["--rope", "hemp", "dyneema"]),
        (["--diameter", "-1"], ["--diameter", "-1"]),
        (["--pulleys", "2"], ["--pulleys", "2", "0.3"]),
        (["--ask"], ["--ask", "no terminal"]),
    ],
)
def test_unusable_options_are_named(words, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["new-robot", "mine", *words]) == 2
    line = capsys.readouterr().err.strip()
    assert len(line.splitlines()) == 1
    assert all(word in line for word in said), line
    assert list(tmp_path.iterdir()) == []


def test_a_platform_too_heavy_for_the_law_is_one_sentence(tmp_path, capsys):
    code = run(["new-robot", "mine", "--mass", "1e9", "--out", str(tmp_path / "r.toml")])
    assert code in (0, 1)
    assert "Traceback" not in capsys.readouterr().err


def test_nothing_is_overwritten_unasked(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["new-robot", "mine", "--quiet"]) == 0
    (tmp_path / "mine.toml").write_text("my own")
    assert run(["new-robot", "mine", "--quiet"]) == 2
    assert (tmp_path / "mine.toml").read_text() == "my own"
    assert run(["new-robot", "mine", "--quiet", "--overwrite"]) == 0
    made = cs.new_robot("mine")
    assert (tmp_path / "mine.toml").read_text() == made.text
    with pytest.raises(cs.InputError, match="overwrite=True"):
        made.write(tmp_path / "mine.toml")
    assert made.write(tmp_path / "other.toml").read_text() == made.text

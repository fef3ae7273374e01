"""What a newcomer types: wrong words, wrong sizes and unwritable directories get one line, and nothing comes out."""

import json
import re
from importlib import resources
from pathlib import Path

import pytest

from cdpr_struct.cli.main import run
from tests.robustness.test_bad_input import ANCHORS, CABLE, ROBOT, complaint

EXAMPLES = Path(__file__).parents[2] / "examples" / "robots"
STOP = ["transient", "six-cable-4mm", "--initial-velocity=0.1,0,0"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], ["command", "--help"]),
        ([*CABLE[:3], "--length=", *CABLE[5:]], ["--length: got ''; give a number"]),
        ([*CABLE[:3], "--length=1e300", *CABLE[5:]], ["--length", "1e300", "1e+12"]),
        (["cable", "--force=1e-300,1", *CABLE[3:]], ["--force", "1e-300", "horizontal"]),
        ([*CABLE[:5], "--EA=1e-300", *CABLE[7:]], ["--EA", "1e-300", "1e-12"]),
        (["cable", "--force=100,1e300", *CABLE[3:]], ["--force", "1e300", "1e+12"]),
        (["inverse", "thesis-3-1", "--payload=1e300"], ["--payload", "1e300"]),
        (["forward", "thesis-3-1", "--lengths=1e300,1,1,1,1,1,1,1"], ["--lengths", "1e+12"]),
        (["forward", "thesis-3-1", "--lengths=1,1,1,1,1,1,1,1", "--start=1,2"], ["--start", "1,2"]),
        (["map", "thesis-3-1", "--grid=0,0,1e300", "--quantity=sag-max"], ["--grid", "1e300"]),
        (["audit", "thesis-3-1", "--trajectory=line:0,0,0.5:1,0,0.5:1e-300"], ["--trajectory", "1e-06 s"]),
        (["audit", "thesis-3-1", "--small"], ["--small", "--limits"]),
        (STOP, ["--duration is missing"]),
        ([*STOP, "--duration=1e-9"], ["--duration", "1e-09", "0.04 s"]),
        (["transient", "six-cable-4mm"], ["--initial-velocity is missing"]),
    ],
    ids=range(15),
)
def test_bad_words(arguments, words, capsys):
    line = complaint(arguments, capsys)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (ROBOT.replace("mass = 10.0", "mass = true") + ANCHORS, ["platform.mass", "True", "number"]),
        (ROBOT.replace("mass = 10.0", 'mass = "10"') + ANCHORS, ["platform.mass", "'10'", "quotes"]),
        (ROBOT.replace("mass = 10.0", "mass = 1e300") + ANCHORS, ["platform.mass", "1e+300", "1e+12"]),
        (ROBOT.replace("1e5", "1e-300") + ANCHORS, ["cable.axial_stiffness", "1e-300"]),
        (ROBOT + ANCHORS.replace("[3, 0, 4]", "[3, 0]"), ["cables[1].frame_anchor", "at least 3 entries, not 2"]),
        (ROBOT + ANCHORS + "pulley = { radius = 0.1, axis = [0, 0, 0] }\n", ["cables[1].pulley.axis", "zero vector"]),
        (ROBOT + ANCHORS + "pulley = 0.1\n", ["cables[1].pulley", "table"]),
        (ROBOT.replace("[0, 1, 0]", "[0, 0, 0]") + ANCHORS, ["platform.inertia", "positive definite"]),
        ("home_pose = [0, 0, 1, 2]\n" + ROBOT + ANCHORS, ["home_pose", "3 or 6 numbers"]),
        (
            ROBOT.replace("mass = 10.0", "mass = 10.0\nmass = 11.0") + ANCHORS,
            ["line 5", "mass = 11.0", "TOML", "given once"],
        ),
        (ROBOT.replace("mass = 10.0", "mass = 60,5") + ANCHORS, ["line 4", "mass = 60,5", "decimals with a point"]),
        (
            re.sub("inertia = .*", "inertia = [2.4, 2.9, 4.6]", ROBOT) + ANCHORS,
            ["got 2.4", "[[Ixx, 0, 0], [0, Iyy, 0]"],
        ),
    ],
    ids=range(12),
)
def test_robot_files(text, words, tmp_path, capsys):
    path = tmp_path / "robot.toml"
    path.write_text(text)
    line = complaint(["inverse", str(path), "--pose=0,0,1"], capsys)
    assert all(word in line for word in words), line


@pytest.mark.parametrize("command", [["modes", "six-cable-4mm", "--count=3"], CABLE, ["robots"]], ids=range(3))
@pytest.mark.parametrize("place", ["file", "file/below", ""])
def test_nothing_is_printed_when_out_cannot_be_written(command, place, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("mine")
    assert "--out" in complaint([*command, f"--out={place}"], capsys)
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time_s;x_m;y_m;z_m\n0;0;0;1\n", ["header", "commas"]),
        ("time_s,x_m,y_m,z_m\n0,0,0,1\n1,1e300,0,1\n", ["line 3, x_m", "1e300"]),
        ("time_s,x_m,y_m,z_m\n0,0,0,1\n1e-300,0,0,1\n", ["line 3, time_s", "ascend"]),
    ],
    ids=range(3),
)
def test_trajectory_files(text, words, tmp_path, capsys):
    path = tmp_path / "path.csv"
    path.write_text(text)
    line = complaint(["audit", "thesis-3-1", f"--trajectory={path}"], capsys)
    assert all(word in line for word in words), line


def test_a_response_that_symmetry_forbids_has_no_peaks(tmp_path, capsys):
    arguments = ["frf", "thesis-3-1", "--excite=fz", "--respond=x,z", "--band=3:4:0.05", f"--out={tmp_path}"]
    assert run(arguments) == 0
    assert "x [(m/s^2)/N]: does not answer beyond rounding errors." in capsys.readouterr().out
    x, z = json.loads((tmp_path / "result.json").read_text())["responses"]
    assert (x["silent"], x["peaks_hz"], z["silent"]) == (True, [], False)
    assert len(z["peaks_hz"]) == 1
    assert "x: no answer" in (tmp_path / "frf.svg").read_text() or "no answer" in (tmp_path / "report.html").read_text()


def test_a_motion_that_symmetry_forbids_is_zero(capsys):
    assert run(["transient", "thesis-3-1", "--initial-velocity=0.3,0,0", "--duration=1", "--highest=5", "--json"]) == 0
    ports = {port["name"]: port["dominant_hz"] for port in json.loads(capsys.readouterr().out)["ports"]}
    assert ports["z"] is None
    assert ports["x"] is not None


def test_positions_have_no_negative_zeros(capsys):
    lengths = "10.78,10.38,10.78,10.38,10.24,10.64,10.24,10.64"
    assert run(["forward", "thesis-3-1", f"--lengths={lengths}"]) == 0
    text = capsys.readouterr().out
    assert "(0.00000, 0.00000, 0.49343) m, turned by (0.0000, 0.0000, -0.1566)" in text
    assert run(["audit", "thesis-3-1", f"--lengths={lengths}"]) == 0
    assert "at (0, 0, 0.4934) m" in capsys.readouterr().out


def test_an_empty_map_of_a_robot_with_few_cables_says_what_to_do(tmp_path, capsys):
    path = tmp_path / "robot.toml"
    path.write_text(ROBOT + ANCHORS)
    assert run(["map", str(path), "--grid=0,0,0.5", "--quantity=sag-max"]) == 1
    assert "--lengths" in capsys.readouterr().out


def test_poses_that_would_be_held_with_free_angles_are_refused_with_that_hint(capsys):
    receiver = f"{EXAMPLES}/telescope-receiver/robot.toml"
    assert run(["inverse", receiver, "--pose=60,-40,130"]) == 1
    assert "Leave its angles free (--free rx,ry,rz" in capsys.readouterr().err
    for quantity in ("workspace", "tension-max"):
        asked = ["map", receiver, "--grid=0:60:2,-40,130", f"--quantity={quantity}"]
        run(asked)
        assert "--free rx,ry,rz lets the platform hang" in capsys.readouterr().out
        assert run([*asked, "--free=rx,ry,rz"]) == 0  # and that helps
        assert "lets the platform hang" not in capsys.readouterr().out
    assert run(["inverse", "thesis-3-1", "--pose=9,0,0.5"]) == 1
    assert "--free" not in capsys.readouterr().err  # beyond the frame: no orientation is held
    run(["map", f"{EXAMPLES}/load-on-one-rope/robot.toml", "--grid=0:1:2,0,0", "--quantity=sag-max"])
    assert "--free" not in capsys.readouterr().out  # one rope cannot place a load


def test_a_map_goes_on_past_poses_that_are_not_stable(tmp_path, capsys):
    text = resources.files("cdpr_struct.robot.builtin").joinpath("thesis-3-1.toml").read_text("utf-8")
    path = tmp_path / "robot.toml"
    path.write_text(re.sub("center_of_mass = .*", "center_of_mass = [0, 0, 10.0]", text))
    arguments = ["map", str(path), "--grid=-3:3:3,-3:3:3,0.5", "--quantity"]
    assert run([*arguments, "first-frequency", "--json"]) == 0
    exact = json.loads(capsys.readouterr().out)
    assert run([*arguments, "platform-frequency", "--json"]) == 0
    assert exact["held"] == 9 > exact["unstable"] > 0
    assert exact["unstable"] == json.loads(capsys.readouterr().out)["unstable"]
    assert run([*arguments, "first-frequency"]) == 0
    assert f"{exact['unstable']} poses would not be stable." in capsys.readouterr().out


def test_a_cable_that_would_break_is_named(capsys):
    assert run(["inverse", "thesis-3-1", "--payload=1e5"]) == 0
    assert "it would break long before" in capsys.readouterr().out
    assert run(["inverse", "thesis-3-1"]) == 0
    assert "break" not in capsys.readouterr().out

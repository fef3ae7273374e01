"""What the program says about input that cannot be used: what is there, what would be right, and at once."""

import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_rows import read_rows
from tests.robustness.test_campaign_files import CAMPAIGN, HEAD, ROWS, complaint

ROOT = Path(__file__).parents[2]


def test_numbers_of_numpy_are_shown_as_numbers(tmp_path, capsys):
    line = complaint(tmp_path, capsys, rows=HEAD + ROWS.replace("a,0,0,1,1,", "a,0,0,1,9,", 1))
    assert "got 9.0; a whole number from 1 to" in line


@pytest.mark.parametrize(
    ("more", "known"),
    [
        ("sigma = { tension = 3.0 }\n", ["sigma.tension", "tension_N is perhaps meant", "rotation_deg"]),
        ("[tolerances]\nanchors_m = 1e-3\n", ["tolerances.anchors_m", "anchor_m is perhaps meant", "platform_mass_kg"]),
        ("[noise]\nx = 1\n", ["noise", "no such key", "lower_bound_N", "tolerances"]),
    ],
)
def test_unknown_keys_are_met_with_the_known_ones(more, known, tmp_path, capsys):
    line = complaint(tmp_path, capsys, campaign=CAMPAIGN + more)
    assert all(word in line for word in known), line


def test_known_keys_of_a_robot_file_too(tmp_path, capsys):
    (tmp_path / "r.toml").write_text('name = "r"\n[platform]\nmas = 3\n')
    assert run(["modes", str(tmp_path / "r.toml")]) == 2
    assert "mass is perhaps meant" in capsys.readouterr().err


def test_another_separator_is_named(tmp_path):
    for row in ("a;0;0", "a;0,5;0,25"):
        (tmp_path / "a.csv").write_text(f"# one line\ncase;x_m;y_m\n{row}\n")
        with pytest.raises(InputError, match=r"separated by ';'.*commas"):
            read_rows("static_state", tmp_path / "a.csv", 8)


def test_remarks_are_allowed_and_misspelt_columns_are_not(tmp_path):
    (tmp_path / "a.csv").write_text("x_m,y_m,z_m,cable,tension_N,comment\n0,0,1,1,100,windy\n")
    assert "comment" not in read_rows("static_state", tmp_path / "a.csv", 8).words
    (tmp_path / "a.csv").write_text("x_m,y_m,z_m,cable,tension_N,lenght_m\n0,0,1,1,100,8\n")
    with pytest.raises(InputError, match=r"length_m is perhaps meant; known are .*column comment"):
        read_rows("static_state", tmp_path / "a.csv", 8)


def test_a_missing_campaign_is_told():
    called = subprocess.run(
        [sys.executable, "-m", "cdpr_struct.cli.main", "diagnose", "none.toml"],
        capture_output=True, text=True, cwd=ROOT, check=False,
    )  # fmt: skip
    assert called.returncode == 2
    assert "got 'none.toml'; no such file" in called.stderr


def test_out_is_tried_before_anything_is_computed(capsys, monkeypatch):
    monkeypatch.setattr("cdpr_struct.diagnosis.diagnosing.diagnosed", None)
    assert run(["diagnose", str(ROOT / "examples/table-4-4/level.toml"), "--out", "/proc/none"]) == 2
    assert "--out" in capsys.readouterr().err


def test_lengths_in_mm_are_recognised(capsys):
    lengths = "10780,10380,10780,10380,10240,10640,10240,10640"
    assert run(["forward", "thesis-3-1", "--lengths", lengths]) == 2
    assert "look like mm" in capsys.readouterr().err


def test_frfs_without_a_pose_are_refused_before_their_modes_are_sought(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("cdpr_struct.measurement.campaign_file.join_signals", None)
    (tmp_path / "u0.csv").write_text("case,frequency_hz,real,imag,respond,excite\nu0,1,1,0,x,x\nu0,2,1,0,x,x\n")
    (tmp_path / "c.toml").write_text('robot = "cogiro"\n[[measurement]]\nkind = "frf"\nfile = "u0.csv"\n')
    assert run(["diagnose", str(tmp_path / "c.toml")]) == 2
    assert "carries no pose" in capsys.readouterr().err


def test_version(capsys):
    assert run(["--version"]) == 0
    assert capsys.readouterr().out == f"cdpr-struct {version('cdpr-struct')}\n"


@pytest.mark.parametrize(
    ("words", "code"),
    [(["examples/free_motion_campaign.py", "/nonexistent", "x"], 2), (["-m", "benchmarks", "-h"], 0)],
)
def test_scripts_neither_trace_back_nor_run_when_asked_for_help(words, code):
    called = subprocess.run([sys.executable, *words], capture_output=True, text=True, cwd=ROOT, check=False)
    assert called.returncode == code
    assert "Traceback" not in called.stderr
    assert "usage:" in called.stderr + called.stdout

"""Unusable options of the commands of statics: one line on stderr, exit 2, nothing on stdout, nothing written."""

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import read_grid

EIGHT = "9,9,9,9,9,9,9,9"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["forward", "thesis-3-1"], ["--lengths", "8"]),
        (["forward", "thesis-3-1", "--lengths", "9,9"], ["--lengths", "9,9", "8"]),
        (["forward", "thesis-3-1", "--lengths", EIGHT.replace("9,9,", "9,-9,", 1)], ["--lengths", "above zero"]),
        (["forward", "thesis-3-1", "--lengths", EIGHT.replace("9,9,", "9,nan,", 1)], ["--lengths", "nan"]),
        (["forward", "thesis-3-1", "--lengths", EIGHT, "--model", "rubber"], ["--model", "rubber", "spring"]),
        (["forward", "thesis-3-1", "--lengths", EIGHT, "--start", "1,2"], ["1,2"]),
        (["forward", "thesis-3-1", "--lengths", EIGHT, "--payload", "-1"], ["--payload", "-1"]),
        (["forward", "no-robot", "--lengths", EIGHT], ["no-robot"]),
        (["inverse", "thesis-3-1", "--upper-bound", "0"], ["--upper-bound", "0"]),
        (["inverse", "thesis-3-1", "--lower-bound", "5", "--upper-bound", "4"], ["--upper-bound", "4"]),
        (["pose-error", "thesis-3-1"], ["--grid", "--sufficient-load"]),
        (["pose-error", "thesis-3-1", "--grid", "0:1:2,0"], ["--grid", "0:1:2,0"]),
        (["pose-error", "thesis-3-1", "--grid", "0:1,0,0"], ["--grid", "X0:X1:NX"]),
        (["pose-error", "thesis-3-1", "--grid", "1:0:3,0,0"], ["--grid", "1:0:3", "ascends"]),
        (["pose-error", "thesis-3-1", "--grid", "0:1:1,0,0"], ["--grid", "0:1:1"]),
        (["pose-error", "thesis-3-1", "--grid", "0:1:2.5,0,0"], ["--grid", "0:1:2.5"]),
        (["pose-error", "thesis-3-1", "--grid", "nan,0,0"], ["--grid", "nan"]),
        (["pose-error", "thesis-3-1", "--grid", "0:inf:3,0,0"], ["--grid", "inf"]),
        (["pose-error", "thesis-3-1", "--grid", "0,0,0,x,0,0"], ["--grid"]),
        (["pose-error", "thesis-3-1", "--grid", "0:1:3000,0:1:3000,0:1:3000"], ["--grid", "at most"]),
        (["pose-error", "thesis-3-1", "--grid", "0,0,0.5", "--mass", "0"], ["--mass", "0"]),
        (["pose-error", "thesis-3-1", "--grid", "0,0,0.5", "--pose", "0,0,0"], ["--pose", "--sufficient-load"]),
        (["pose-error", "thesis-3-1", "--sufficient-load", "0"], ["--sufficient-load", "0"]),
        (["pose-error", "thesis-3-1", "--sufficient-load", "x"], ["--sufficient-load", "x"]),
        (["pose-error", "thesis-3-1", "--grid", "0,0,0.5", "--workers", "0"], ["--workers", "0"]),
        (["map", "thesis-3-1", "--grid", "0,0,0.5"], ["--quantity", "tension-max"]),
        (["map", "thesis-3-1", "--grid", "0,0,0.5", "--quantity", "beauty"], ["--quantity", "beauty", "pose-error"]),
        (["map", "thesis-3-1", "--quantity", "sag-max"], ["--grid"]),
        (["map", "thesis-3-1", "--grid", "0,0,0.5", "--quantity", "sag-max", "--chunk", "0"], ["--chunk", "0"]),
        (
            [
                "map",
                "thesis-3-1",
                "--grid",
                "0,0,0.5",
                "--quantity",
                "sag-max",
                "--workers",
                "2",
                "--scheduler",
                "tcp://x:1",
            ],
            ["--workers", "--scheduler"],
        ),
        (["reproduce", "fig-9.9"], ["fig-9.9", "fig-4.4"]),
    ],
    ids=lambda value: " ".join(value)[:60] if isinstance(value, list) else None,
)
def test_bad_options(arguments, words, capsys, tmp_path):
    out = tmp_path / "out"
    assert run([*arguments, "--out", str(out)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert len(captured.err.strip().splitlines()) == 1, captured.err
    assert all(word in captured.err for word in words), captured.err
    assert not out.exists()


def test_a_scheduler_without_dask_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setitem(__import__("sys").modules, "dask.distributed", None)
    arguments = ["map", "thesis-3-1", "--grid", "0,0,0.5", "--quantity", "sag-max", "--scheduler", "tcp://nowhere:8786"]
    assert run(arguments) == 2
    assert "cdpr-struct[scheduler]" in capsys.readouterr().err


def test_a_platform_that_turns_freely_about_its_cable_is_told_so(tmp_path, capsys):
    """One cable: nothing pushes the platform back about it, and nothing pushes it on."""
    text = """
name = "pendulum"
home_pose = [0, 0, 0]
[platform]
mass = 10.0
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
[cable]
axial_stiffness = 1e5
linear_density = 0.05
[[cables]]
platform_anchor = [0, 0, 0.2]
frame_anchor = [0, 0, 4]
"""
    path = tmp_path / "robot.toml"
    path.write_text(text)
    assert run(["forward", str(path), "--lengths", "3"]) == 0
    assert "turning about the vertical axis" in capsys.readouterr().out


@pytest.mark.parametrize(
    "arguments",
    [
        ["map", "thesis-3-1", "--grid", "0,0,0.5", "--quantity", "sag-max"],
        ["pose-error", "thesis-3-1", "--grid", "0,0,0.5"],
        ["pose-error", "thesis-3-1", "--sufficient-load", "2"],
        ["inverse", "thesis-3-1"],
        ["forward", "thesis-3-1", "--lengths", EIGHT],
        ["reproduce", "table-2.4"],
    ],
    ids=" ".join,
)
def test_output_that_cannot_be_written(arguments, tmp_path, capsys):
    taken = tmp_path / "taken"
    taken.write_text("x")
    assert run([*arguments, "--out", str(taken)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "--out" in captured.err
    assert taken.read_text() == "x"


def test_grid_text():
    grid = read_grid("-3:3:7,-1:1:3,0.5,10,0,-5")
    assert grid.shape == (7, 3, 1)
    assert grid.free == (0, 1)
    np.testing.assert_allclose(grid.positions[[0, 1, -1]], [[-3, -1, 0.5], [-3, 0, 0.5], [3, 1, 0.5]])
    assert grid.fixed_text() == "z = 0.5 m, rx = 10°, rz = -5°"
    with pytest.raises(InputError, match=r"^grid: "):
        read_grid("")

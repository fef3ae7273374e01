"""`distribute`: result.json, files, trajectory forms."""

import csv
import json
import re

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.statics.trajectory import helix

HELIX = ["distribute", "thesis-5", "--trajectory", "helix", "--instants", "61"]


def result_of(arguments, capsys) -> dict:
    """result.json on stdout, and nothing else there."""
    assert run([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_result_holds_the_keys_that_scripts_rely_on(capsys):
    r = result_of([*HELIX, "--bound", "fixed", "--compare", "frequency"], capsys)
    assert len(r["max_force_N"]) == 8
    assert r["energy_J"] == pytest.approx(160800.0, rel=0.01)
    assert r["lower_bound_N"]["min"] == pytest.approx(r["lower_bound_N"]["max"]) == pytest.approx(237.8, rel=1e-3)
    assert r["min_cable_frequency_hz"] < 2.0 <= r["beside"][0]["min_cable_frequency_hz"]
    assert r["frequency_missed"]["instants"] > 0
    assert r["beside"][0]["frequency_missed"]["instants"] == 0
    assert r["certificate"]["max_kkt_residual"] < 1e-10


def test_files(tmp_path, capsys):
    assert run([*HELIX, "--compare", "fixed", "--out", str(tmp_path / "o")]) == 0
    text = capsys.readouterr().out
    assert "saves" in text
    names = {path.name for path in (tmp_path / "o").iterdir()}
    assert names == {
        "result.json", "report.html", "forces_fixed.csv", "forces_pose_dependent.csv",
        *(f"{name}.{form}" for name in ("lower_bounds", "cable_forces", "energy", "cable_frequencies")
          for form in ("svg", "pdf")),
    }  # fmt: skip
    with (tmp_path / "o" / "forces_fixed.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 61
    assert float(rows[30]["force_1_N"]) >= float(rows[30]["lower_bound_1_N"]) * (1.0 - 1e-9)
    page = (tmp_path / "o" / "report.html").read_text()
    page = re.sub(r"plotly-packed.*?</script>", "", page, flags=re.DOTALL)
    assert "http" not in page.replace("http://www.w3.org", "")


def test_a_file_of_the_helix_gives_the_same_forces(tmp_path, capsys):
    path = helix(121)
    rows = np.column_stack([path.time, path.position])
    file = tmp_path / "path.csv"
    np.savetxt(file, rows, delimiter=",", header="time_s,x_m,y_m,z_m", comments="", fmt="%.12g")
    read = result_of(["distribute", "thesis-5", "--trajectory", str(file), "--bound", "fixed"], capsys)
    exact = result_of([*HELIX[:-1], "121", "--bound", "fixed"], capsys)
    assert read["max_force_N"] == pytest.approx(exact["max_force_N"], rel=1e-5)
    assert read["trajectory"]["max_acceleration_m_s2"] == pytest.approx(1.85, abs=0.01)


def test_a_straight_line_with_rotation(capsys):
    line = "line:0,0,1:1,1,2,0,0,10:5"
    r = result_of(["distribute", "cogiro", "--trajectory", line, "--instants", "41", "--b", "3"], capsys)
    assert r["trajectory"] == {
        "instants": 41, "duration_s": 5.0, "max_speed_m_s": pytest.approx(1.875 * 3**0.5 / 5.0),
        "max_acceleration_m_s2": pytest.approx(5.7735 * 3**0.5 / 25.0, rel=1e-2),
    }  # fmt: skip


@pytest.mark.parametrize("cost", ["p-norm", "middle", "centre"])
def test_other_costs(cost, capsys):
    r = result_of([*HELIX, "--cost", cost, "--upper-bound", "8000"], capsys)
    assert r["cost_function"] == cost
    assert max(r["max_force_N"]) <= 8000.0


def test_weights_shift_the_load(capsys):
    """Suspended CoGiRo, where bounds leave room: a dear cable 3 carries less."""
    line = ["distribute", "cogiro", "--trajectory", "line:0,0,1.2:2,0,1.2:5", "--instants", "21", "--b", "3"]
    plain, dear = (
        result_of([*line, *extra], capsys)["max_force_N"] for extra in ([], ["--weights", "1,1,9,1,1,1,1,1"])
    )
    assert dear[2] < plain[2] - 5.0


def test_limits_of_the_trajectory_exit_1(capsys):
    assert run([*HELIX, "--max-speed", "2"]) == 1
    assert "0.3636 m/s above the limit 2 m/s" in capsys.readouterr().err


def test_infeasible_exits_1_with_time_cable_and_amount(tmp_path, capsys):
    assert run([*HELIX, "--upper-bound", "3000", "--out", str(tmp_path / "o")]) == 1
    captured = capsys.readouterr()
    (line,) = captured.err.strip().splitlines()
    assert all(word in line for word in ("at t =", "cable", "bound", " N"))
    assert captured.out == ""
    assert not (tmp_path / "o").exists()

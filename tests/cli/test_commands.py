"""The commands as a script uses them: exit code, stdout, files."""

import json

import pytest

from cdpr_struct.cli.main import run

CABLE = ["cable", "--force", "100,-100", "--length", "20", "--EA", "251327.4123", "--rho", "0.067"]


def result_of(arguments, capsys) -> dict:
    """result.json on stdout, and nothing else there."""
    assert run([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_cable_meets_every_stated_digit(capsys):
    """The example cable of thesis section 2.3, third load."""
    r = result_of(CABLE, capsys)
    stated = {
        "x_m": 13.696,
        "z_m": -14.586,
        "inclination_deg": 46.80,
        "chord_m": 20.008,
        "elongation_m": 0.01163,
        "sag_m": 0.1540,
        "lambda2": 6.529,
        "epsilon": 0.0616,
    }
    digits = {"inclination_deg": 2, "elongation_m": 5, "sag_m": 4, "epsilon": 4}
    for key, value in stated.items():
        assert round(r[key], digits.get(key, 3)) == value, key


def test_cable_stiffness_is_the_inverse_of_its_compliance(capsys):
    r = result_of(CABLE, capsys)
    (a, b), (_, d) = r["stiffness"]
    total = [
        [p + q for p, q in zip(*rows, strict=True)]
        for rows in zip(r["compliance_axial"], r["compliance_sag"], strict=True)
    ]
    assert a * total[0][0] + b * total[1][0] == pytest.approx(1.0, rel=1e-9)
    assert b * total[0][0] + d * total[1][0] == pytest.approx(0.0, abs=1e-9)


def test_robots_lists_the_six_builtin_robots(capsys):
    names = [row["name"] for row in result_of(["robots"], capsys)["robots"]]
    assert names == ["cogiro", "six-cable-4mm", "six-cable-8mm", "thesis-3-1", "thesis-3-1-8mm", "thesis-5"]


def test_inverse_holds_the_pose(capsys):
    r = result_of(["inverse", "thesis-3-1", "--pose", "0.5,-1,0.8,2,0,5"], capsys)
    assert len(r["lengths_m"]) == 8
    assert min(r["tensions_N"]) > 0.0
    assert max(abs(v) for v in r["residual_wrench"]) < 1e-6


def test_payload_raises_the_tensions_in_proportion(capsys):
    """At the centre, by symmetry and for small sag, twice the load is close to twice the tension."""
    light = result_of(["inverse", "thesis-3-1", "--model", "spring"], capsys)["tensions_N"]
    heavy = result_of(["inverse", "thesis-3-1", "--model", "spring", "--payload", "60"], capsys)["tensions_N"]
    assert heavy == pytest.approx([2.0 * t for t in light], rel=1e-9)


@pytest.fixture(scope="module")
def small_verification(tmp_path_factory):
    out = tmp_path_factory.mktemp("verify")
    code = run(["verify", "thesis-3-1", "--elements", "10,20,40", "--modes", "12", "--out", str(out)])
    return code, out


def test_verify_writes_whole_files(small_verification):
    code, out = small_verification
    assert code == 0
    names = {path.name for path in out.iterdir()}
    assert {"result.json", "report.html", "eigenfrequencies.csv", "determinant.svg"} <= names
    assert not [n for n in names if n.startswith(".")], "a temporary file was left behind"


def test_verify_result_has_the_promised_keys(small_verification):
    r = json.loads((small_verification[1] / "result.json").read_text())
    assert {"eigenfrequencies", "convergence", "missed_by_determinant_scan", "limits", "verdict"} <= r.keys()
    assert {"fem_hz", "dsm_hz", "exact_hz", "static_hz", "determinant_minimum_hz", "relative_error", "kind"} <= r[
        "eigenfrequencies"
    ][0].keys()
    assert {"elements", "max_relative_error", "observed_order"} <= r["convergence"].keys()


def test_verify_exits_1_when_the_closed_form_is_judged_and_does_not_hold(capsys):
    """The closed form is off by some 0.04 %; the exact model, which is judged first by default, holds."""
    arguments = ["verify", "thesis-3-1", "--elements", "10,20,40", "--modes", "8", "--tolerance", "1e-4"]
    assert run([*arguments, "--model", "dsm"]) == 1
    said = capsys.readouterr().out
    assert "CLOSED-FORM DSM DOES NOT HOLD" in said
    assert "EXACT MODEL" not in said
    assert run(arguments) == 0
    said = capsys.readouterr().out
    assert said.index("EXACT MODEL HOLDS") < said.index("CLOSED-FORM DSM DOES NOT HOLD") < said.index("What to do")


def test_verify_exits_1_when_the_exact_model_does_not_hold(capsys):
    """Without the geometric term a preloaded robot is off by a quarter (docs/choosing_a_model.md); that is named."""
    arguments = ["verify", "six-cable-4mm", "--elements", "10,20,40", "--modes", "8", "--assembly", "thesis"]
    assert run(arguments) == 1
    said = capsys.readouterr().out
    assert "EXACT MODEL DOES NOT HOLD" in said
    assert "Cause: geometric term of the attachments" in said
    assert "What to do: use --assembly consistent" in said


def test_verify_says_with_how_many_elements_the_fem_is_not_certain(capsys):
    arguments = [
        "verify",
        "thesis-3-1",
        "--elements",
        "10,20,40",
        "--most-elements",
        "40",
        "--modes",
        "8",
        "--tolerance",
        "1e-6",
    ]
    assert run(arguments) == 1
    said = capsys.readouterr().out
    assert "EXACT MODEL NOT DECIDED: the FEM has not converged with 40 elements per cable" in said
    assert "What to do: let the FEM refine further (--most-elements)" in said

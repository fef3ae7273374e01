"""Bad bands, readings and requirements: one sentence each that names file, field, value and what would be right."""

import pytest

from cdpr_struct.cli.main import run

MAP = ["map", "cogiro", "--grid", "0:1:2,0,1.2", "--quantity"]
CABLE = ["cable", "--force", "100,-100", "--length", "20", "--EA", "2.5e5", "--rho", "0.067"]
FRF = ["frf", "cogiro", "--excite", "fz", "--respond", "z", "--band"]
ALONG = ["distribute", "thesis-5", "--trajectory", "helix", "--instants", "11"]
LIMIT = '[[requirement]]\nname = "a"\nquantity = "frequency"\nat_least = 1.0\n'


def complaint(capsys) -> str:
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    return said.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["modes", "cogiro", "--band", "0"], ["band: got 0", "above 0 and below 100"]),
        (["modes", "cogiro", "--band", "100"], ["band: got 100"]),
        (["modes", "cogiro", "--samples", "100"], ["samples: got 100", "belongs to --band"]),
        (["inverse", "cogiro", "--band", "90", "--samples", "3"], ["samples: got 3", "20 to 100000"]),
        (["inverse", "cogiro", "--band", "90", "--model", "ideal"], ["model: got 'ideal'", "sagging or spring"]),
        (
            ["pose-error", "cogiro", "--grid", "0:1:2,0,1", "--band", "90"],
            ["grid: got '2 poses'", "one pose for --band"],
        ),
        (["pose-error", "cogiro", "--grid", "0,0,1", "--pose", "0,0,1", "--band", "90"], ["pose: got '0,0,1'"]),
        (
            [*MAP, "cable-distance", "--band", "90"],
            ["quantity: got 'cable-distance'", "first-frequency", "tension-min"],
        ),
        ([*MAP, "tension-min", "--limit", "3"], ["limit: got 3.0", "belongs to --band"]),
        ([*MAP, "tension-min", "--band", "90", "--limit", "nan"], ["limit: got nan", "a number in N"]),
        ([*MAP, "slack-margin", "--band", "90", "--wrenches", "fx=-1:1"], ["wrenches: got 'given'", "leave it out"]),
        ([*MAP, "pose-error", "--band", "90", "--free", "rx"], ["free: got 'given'", "leave it out"]),
        (
            ["map", "examples/robots/gait-trainer/robot.toml", *MAP[2:], "tension-min", "--band", "90"],
            ["winch_tension", "a band is that of locked lengths"],
        ),
        (
            ["modes", "examples/robots/gait-trainer/robot.toml", "--band", "90"],
            ["winch_tension", "a band is that of locked lengths"],
        ),
        ([*MAP, "workspace", "--band", "90"], ["band: got 90.0", "a workspace has none"]),
        ([*CABLE, "--held", "ends"], ["held: got 'ends'", "belongs to --band"]),
        ([*CABLE, "--band", "90", "--held", "top"], ["held: got 'top'", "force or ends"]),
        ([*CABLE, "--band", "90", "--tolerances", "mass=1"], ["tolerances: got 'mass'", "length_m, anchor_m"]),
        ([*CABLE, "--band", "90", "--tolerances", "length_m=x"], ["tolerances: got 'length_m=x'", "NAME=VALUE"]),
        ([*CABLE, "--band", "90", "--tolerances", "length_m=-1"], ["tolerances: got -1.0", "zero or more"]),
        ([*FRF, "90"], ["band: got '90'", "F0:F1:DF"]),
        ([*FRF, "1:2:0.1", "--band", "3:4:0.1"], ["band: got '1:2:0.1 and 3:4:0.1'", "a level like 90 at most once"]),
        ([*FRF, "1:2:0.1", "--band", "90", "--percent", "50"], ["--band", "at most once"]),
        ([*FRF, "1:2:0.1", "--percent", "100"], ["percent: got 100.0", "below 100"]),
        ([*FRF, "1:2:0.1", "--samples", "50"], ["samples: got 50", "belongs to --percent"]),
        ([*ALONG, "--band", "90", "--model", "ideal"], ["model: got 'ideal'", "sagging or spring"]),
        ([*ALONG, "--samples", "90"], ["samples: got 90", "belongs to --band"]),
        (["sensitivity", "cogiro", "--raise", "first", "--to", "3"], ["raise: got 'first'", "like mode:1"]),
        (["sensitivity", "cogiro", "--to", "3"], ["--raise is missing"]),
        (["sensitivity", "cogiro", "--raise", "mode:1"], ["--to is missing", "frequency in Hz"]),
        (["sensitivity", "cogiro", "--mode", "9"], ["mode: got 9", "1 to 6"]),
        (["sensitivity", "examples/robots/gait-trainer/robot.toml"], ["winch_tension", "rates are those of locked"]),
    ],
)
def test_options(words, said, capsys):
    assert run(words) == 2
    text = complaint(capsys)
    assert all(part in text for part in said), text


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("mode,hertz\n1,2\n", ["hertz"]),
        ("mode,frequency_hz\n0,2.7\n", ["line 2, mode: got '0'", "1 to 500"]),
        ("mode,frequency_hz\n1,-2.7\n", ["line 2, frequency_hz: got '-2.7'", "above zero"]),
        ("frequency_hz\n2,7\n", ["line 2"]),
        ("cable,tension_N\n,330\n", ["line 2, cable is missing", "1 to 8"]),
        ("cable,tension_N\n9,330\n", ["line 2, cable: got '9'"]),
        ("cable,tension_N,sigma\n1,330,0\n", ["line 2, sigma: got '0'", "above 0"]),
        ("cable,tension_N,frequency_hz,sigma\n1,330,2.7,1\n", ["a row of its own"]),
        ("cable,tension_N\n1,\n", ["no readings"]),
        ("cable\n1\n", ["header", "frequency_hz"]),
    ],
)
def test_readings(table, said, tmp_path, capsys):
    (tmp_path / "measured.csv").write_text(table)
    assert run(["compare", "cogiro", str(tmp_path / "measured.csv")]) == 2
    text = complaint(capsys)
    assert all(part in text for part in [*said, "measured.csv"]), text


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("", ["requirement", "missing"]),
        (LIMIT + "at_most = 2.0\n", ["at_least or at_most"]),
        (LIMIT.replace("at_least = 1.0\n", ""), ["at_least or at_most"]),
        (LIMIT.replace('"frequency"', '"stiffness"'), ["requirement[1].quantity: got 'stiffness'", "position_error"]),
        (LIMIT + "probability = 0.4\n", ["requirement[1].probability: got 0.4", "0.5"]),
        (LIMIT.replace("frequency", "tension") + "cable = 9\n", ["requirement[1].cable: got 9", "1 to 8"]),
        ('grid = "0:1:2,0,1"\nposes = [[0, 0, 1]]\n' + LIMIT, ["grid", "not both"]),
        ("poses = [[0.0, 0.0]]\n" + LIMIT, ["poses"]),
        (LIMIT + "atleast = 1\n", ["requirement[1].atleast", "at_least is perhaps meant"]),
    ],
)
def test_requirements(table, said, tmp_path, capsys):
    (tmp_path / "wanted.toml").write_text(table)
    assert run(["accept", "cogiro", str(tmp_path / "wanted.toml"), "--quiet"]) == 2
    text = complaint(capsys)
    assert all(part in text for part in said), text


def test_a_pose_that_is_not_held_fails(tmp_path, capsys):
    (tmp_path / "wanted.toml").write_text("poses = [[0.0, 0.0, 1.2], [30.0, 0.0, 1.2]]\n" + LIMIT)
    assert run(["accept", "cogiro", str(tmp_path / "wanted.toml"), "--quiet", "--json"]) == 1
    assert '"verdict": "fail"' in capsys.readouterr().out


def test_a_platform_that_is_not_held_has_no_band(capsys):
    assert run(["inverse", "cogiro", "--pose", "0,0,8", "--band", "90"]) == 1
    assert capsys.readouterr().out == ""

"""Tables of a campaign file and columns of its data: strict numbers, names that exist, files that are there."""

import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.measurement.campaign_rows import read_rows
from tests.robustness.test_campaign_files import CAMPAIGN, HEAD, ROWS, complaint

PEAKS = 'robot = "cogiro"\n[[measurement]]\nkind = "robot_frequency"\nfile = "states.csv"\n'
NOMINAL = CAMPAIGN + "[nominal]\n"
RESPONSE = "case,frequency_hz,real,imag,respond,excite\n"


@pytest.mark.parametrize(
    ("campaign", "words"),
    [
        (CAMPAIGN + '[checked]\nframe_compliance = "1e-6"\n', ["checked.frame_compliance", "'1e-6'", "without quotes"]),
        (CAMPAIGN + "[checked]\nframe_compliance = true\n", ["checked.frame_compliance", "True", "a number"]),
        (CAMPAIGN + "[checked]\nframe_compliance = 0\n", ["checked.frame_compliance", "got 0", "above"]),
        (CAMPAIGN + "[checked]\nframe_compliance = 1e-300\n", ["checked.frame_compliance", "1e-300", "above 1e-12"]),
        (
            CAMPAIGN + "[checked]\nFrame_Compliance = 1e-6\n",
            ["checked.Frame_Compliance", "1e-06", "frame_compliance is"],
        ),
        (CAMPAIGN + "[checked]\nunit_error = 1\n", ["checked.unit_error", "no such cause", "known are"]),
        (CAMPAIGN + "[loss]\nwrong_name = 5\n", ["loss", "wrong_name = 5", "above unknown above too_wide", "10"]),
        (CAMPAIGN + "[loss]\nto_wide = 5\n", ["loss.to_wide", "no such key", "too_wide"]),
        (CAMPAIGN + "[loss]\nunknown = -1\n", ["loss.unknown", "got -1", "above"]),
        ("checked = 3\n" + CAMPAIGN, ["checked", "got 3", "give a table"]),
        (CAMPAIGN + '[tolerances]\nanchor_m = "0.002"\n', ["tolerances.anchor_m", "without quotes"]),
        (CAMPAIGN + "[tolerances]\nanchor_m = 1e300\n", ["tolerances.anchor_m", "1e+300", "not above 1e+12"]),
        (NOMINAL + "gravity = true\n", ["nominal.gravity", "True", "a number"]),
        (NOMINAL + "axial_stiffness = 1e-300\n", ["nominal.axial_stiffness", "1e-300", "above 1e-12"]),
        (NOMINAL + "platform_inertia = [[], [], []]\n", ["nominal.platform_inertia[1]", "at least 3 entries"]),
        (
            NOMINAL + "platform_inertia = [[-1,0,0],[0,1,0],[0,0,1]]\n",
            ["nominal.platform_inertia", "positive definite"],
        ),
        (CAMPAIGN.replace('"cogiro"', '"CoGiRo"'), ["campaign.toml", "robot", "CoGiRo", "cogiro"]),
        (CAMPAIGN.replace('"cogiro"', '""'), ["campaign.toml", "robot", "got ''"]),
        (CAMPAIGN.replace('"cogiro"', "3"), ["robot", "got 3", "quotes"]),
        (CAMPAIGN.replace("states.csv", ""), ["campaign.toml", "measurement[1].file", "got ''"]),
        (CAMPAIGN.replace("states.csv", "a\\u0000b"), ["measurement[1].file", "data file"]),
    ],
    ids=range(21),
)
def test_bad_tables(campaign, words, tmp_path, capsys):
    line = complaint(tmp_path, capsys, campaign=campaign)
    assert all(word in line for word in words), line


def test_names_in_checked_are_read_before_anything_is_computed(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("cdpr_struct.hypotheses.explain.recorded", None)
    assert "checked.mood" in complaint(tmp_path, capsys, campaign=CAMPAIGN + "[checked]\nmood = 1\n")


@pytest.mark.parametrize(
    ("campaign", "rows", "words"),
    [
        (PEAKS, "x_m,y_m,z_m,frequency_hz\n0,0,1,1e300\n", ["row 1", "frequency_hz", "1e300", "1e+12"]),
        (PEAKS, "x_m,y_m,z_m,frequency_hz\n0,0,1,1e9\n", ["row 1", "frequency_hz", "1000000000.0", "not above 1000"]),
        (PEAKS, "x_m,y_m,z_m,frequency_hz\n0,0,1,0\n", ["row 1", "frequency_hz", "above zero"]),
        (PEAKS, "x_m,y_m,z_m,frequency_hz\n0,0,1,5,3\n", ["row 1", "0, 0, 1, 5, 3", "4 values", "point"]),
        (CAMPAIGN, HEAD + ROWS.replace("300", "300,5"), ["row 1", "6 values", "point"]),
        (PEAKS.replace("robot_frequency", "frf"), RESPONSE + "a,1,0,0,z,\n", ["row 1", "column excite is missing"]),
        (PEAKS.replace("robot_frequency", "frf"), RESPONSE + "a,1,0,0,,fz\n", ["row 1", "column respond is missing"]),
    ],
    ids=range(7),
)
def test_bad_columns(campaign, rows, words, tmp_path, capsys):
    line = complaint(tmp_path, capsys, campaign=campaign, rows=rows)
    assert all(word in line for word in words), line


def test_rows_without_a_case_column_are_named_by_their_poses(tmp_path):
    (tmp_path / "peaks.csv").write_text("x_m,y_m,z_m,frequency_hz\n0,0,1,5\n0,0,1,6\n0,0,2,5\n")
    cases = read_rows("robot_frequency", tmp_path / "peaks.csv", 8).words["case"]
    assert cases[0] == cases[1] != cases[2]


def test_a_path_that_no_file_can_have(capsys):
    assert run(["diagnose", "a\0b"]) == 2
    assert "no such file" in capsys.readouterr().err

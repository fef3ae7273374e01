"""Angles that a file lacks are taken as zero, and that is said; one reader reads the motions of all commands."""

import json

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.errors import InputError
from cdpr_struct.interface.trajectory import read_trajectory
from cdpr_struct.measurement.campaign_file import load_campaign
from tests.robustness.test_campaign_files import CAMPAIGN, HEAD, ROWS

LEVEL = "states.csv has no columns rx_deg, ry_deg, rz_deg: the platform is taken as level there, all angles zero."


def motion(names: str, values: str) -> str:
    return f"time_s,x_m,y_m,z_m{names}\n" + "".join(f"{i},0,0,{1 + 0.1 * i}{values}\n" for i in range(5))


def notes(tmp_path, header=HEAD, rows=ROWS, campaign=CAMPAIGN) -> tuple[str, ...]:
    (tmp_path / "states.csv").write_text(header + rows)
    (tmp_path / "campaign.toml").write_text(campaign)
    return load_campaign(tmp_path / "campaign.toml").notes


def test_a_campaign_without_angles(tmp_path):
    assert notes(tmp_path) == (LEVEL,)


@pytest.mark.parametrize(
    ("angles", "said"),
    [
        ("rx_deg,ry_deg,rz_deg", ()),
        ("rx_deg,ry_deg", ("states.csv has no column rz_deg: this angle is taken as zero there.",)),
        ("rz_deg", ("states.csv has no columns rx_deg, ry_deg: these angles are taken as zero there.",)),
    ],
)
def test_a_campaign_with_some_angles(angles, said, tmp_path):
    zeros = ",".join("0" * len(angles.split(",")))
    header, rows = HEAD.replace("z_m,", f"z_m,{angles},"), ROWS.replace("a,0,0,1,", f"a,0,0,1,{zeros},")
    assert notes(tmp_path, header, rows) == said


def test_each_file_is_named_and_one_without_a_pose_is_not(tmp_path):
    hertz = np.linspace(1.0, 9.0, 200)
    lines = [f"a,{f},{1 / (25 - f * f + 0.1)},0.1,z,fz" for f in hertz]
    (tmp_path / "frf.csv").write_text("\n".join(["case,frequency_hz,real,imag,respond,excite", *lines]) + "\n")
    (tmp_path / "peaks.csv").write_text("case,x_m,y_m,z_m,frequency_hz\nb,0,0,1.2,5\n")
    more = "".join(
        f'[[measurement]]\nkind = "{kind}"\nfile = "{file}"\n'
        for kind, file in (("frf", "frf.csv"), ("robot_frequency", "peaks.csv"))
    )
    assert notes(tmp_path, campaign=CAMPAIGN + more) == (LEVEL, LEVEL.replace("states", "peaks"))


@pytest.mark.parametrize(
    ("names", "values", "said"),
    [
        ("", "", "has no columns rx_deg, ry_deg, rz_deg: the platform is taken as level there"),
        (",rz_deg", ",90", "has no columns rx_deg, ry_deg: these angles are taken as zero there."),
        (",rx_deg,ry_deg,rz_deg", ",0,0,90", ""),
    ],
)
def test_a_trajectory_says_what_it_lacks(names, values, said, tmp_path):
    path = tmp_path / "path.csv"
    path.write_text(motion(names, values))
    found, told = read_trajectory(str(path), None)
    assert [said in note and str(path) in note for note in told] == ([True] if said else [])
    turned = [[0, -1, 0], [1, 0, 0], [0, 0, 1]] if "90" in values else np.eye(3)
    np.testing.assert_allclose(found.rotation[0], turned, atol=1e-15)


def test_built_in_motions_assume_nothing():
    assert read_trajectory("helix", None)[1] == []
    assert read_trajectory("line:0,0,1:1,0,1:5", None)[1] == []


@pytest.mark.parametrize(
    "words",
    [
        ["transient", "thesis-3-1", "--highest", "8", "--model", "static"],
        ["distribute", "thesis-5", "--b", "1"],
        ["audit", "thesis-3-1"],
    ],
    ids=lambda words: words[0],
)
def test_every_command_with_a_trajectory_says_what_it_lacks(words, tmp_path, capsys):
    path = tmp_path / "path.csv"
    path.write_text(motion("", ""))
    assert run([*words, "--trajectory", str(path), "--json"]) in (0, 1)
    (said,) = json.loads(capsys.readouterr().out)["warnings"]
    assert f"{path} has no columns rx_deg, ry_deg, rz_deg" in said


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (motion("", "").upper(), ["header", "rename TIME_S to time_s, X_M to x_m"]),
        (motion("", "").replace("time_s,x_m,y_m,z_m", "t,x,y,z"), ["t to time_s (s), x to x_m (m)"]),
        (motion(",RX_DEG", ",1"), ["header", "rename RX_DEG to rx_deg"]),
        (motion(",rz", ",1"), ["header", "rename rz to rz_deg (deg)"]),
        (motion(",rz [rad]", ",1"), ["rename rz [rad] to rz_deg (deg; convert the values from rad)"]),
        (motion("", "").replace(",", ";"), ["separated by ';'", "read_csv("]),
        (motion("", "").replace("4,0,0,1.4", "4,0,1e300,1.4"), ["line 6, y_m", "1e300"]),
        (motion("", "").replace("\n4,", "\n3.0000001,"), ["line 6, time_s", "ascend"]),
        (motion("", "").replace("4,0,0,1.4", "4,0,0,1.4,7"), ["row 5, line 6", "4 values"]),
    ],
    ids=range(9),
)
@pytest.mark.parametrize("command", [["distribute", "thesis-5"], ["transient", "thesis-3-1"], ["audit", "thesis-3-1"]])
def test_all_commands_refuse_the_same(command, text, words, tmp_path, capsys):
    (tmp_path / "path.csv").write_text(text)
    assert run([*command, "--trajectory", str(tmp_path / "path.csv")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert all(word in line for word in [*words, "path.csv"]), line


def test_vibration_needs_four_instants(tmp_path):
    path = tmp_path / "path.csv"
    path.write_text("time_s,x_m,y_m,z_m\n0,0,0,1\n1,0,0,1\n2,0,0,1\n")
    assert len(read_trajectory(str(path), None)[0]) == 3
    with pytest.raises(InputError, match="at least 4 instants"):
        read_trajectory(str(path), None, 4)

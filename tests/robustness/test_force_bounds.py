"""--lower-bound and --upper-bound of every command that computes a state of balance."""

import json
import re
from pathlib import Path

import pytest

from cdpr_struct.cli.main import COMMANDS, run
from cdpr_struct.measurement.campaign_file import load_campaign

LEVEL = str(Path(__file__).parents[2] / "examples" / "table-4-4" / "level.toml")
AT_REST = {"inverse", "modes", "map", "pose-error", "audit", "verify", "frf", "transient", "spectrogram", "distribute",
           "diagnose", "plan"}  # fmt: skip


@pytest.mark.parametrize("name", sorted(AT_REST))
def test_every_command_at_rest_takes_both_bounds(name, capsys):
    assert name in {command.NAME for command in COMMANDS}
    assert run([name, "-h"]) == 0
    told = capsys.readouterr().out
    assert "--lower-bound N" in told
    assert "--upper-bound N" in told


def test_bounds_of_a_campaign_are_replaced():
    assert load_campaign(LEVEL).lower_bound is None
    campaign = load_campaign(LEVEL, 30.0, 2000.0)
    assert campaign.lower_bound == 30.0
    assert (campaign.robot.force_max == 2000.0).all()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["plan", LEVEL, "--lower-bound", "-1"], "--lower-bound: got -1.0"),
        (["plan", LEVEL, "--upper-bound", "0"], "--upper-bound: got 0.0"),
        (["plan", LEVEL, "--lower-bound", "50", "--upper-bound", "40"], "level.toml"),
        (["modes", "thesis-5", "--upper-bound", "20"], "--upper-bound: got 20.0"),
    ],
)
def test_bounds_that_cannot_be_are_refused_in_one_line(words, said, capsys):
    assert run(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


@pytest.fixture
def lift(tmp_path, capsys):
    """Robot file of the CASPR example without its lower limit; with a high centre of mass it falls over."""
    caspr, made = Path(LEVEL).parents[1] / "caspr", tmp_path / "lift.toml"
    assert run(["import-caspr", str(caspr / "bodies.xml"), str(caspr / "cables.xml"), "--out", str(made)]) == 0
    assert "force_min = 60.0" in made.read_text()
    made.write_text(made.read_text().replace("force_min = 60.0\n", ""))
    capsys.readouterr()
    return made


def test_an_unstable_pose_names_a_bound_that_works(lift, capsys):
    lift.write_text(re.sub(r"center_of_mass = .*", "center_of_mass = [0.0, 0.0, 0.6]", lift.read_text()))
    words = ["modes", str(lift), "--count", "3"]
    assert run(words) == 1
    line = capsys.readouterr().err
    assert "unstable" in line
    assert run([*words, "--lower-bound", re.search(r"--lower-bound (\S+)", line)[1], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["warnings"] == []


@pytest.mark.parametrize("words", [["modes", "--count", "3"], ["inverse"], ["audit"]], ids=lambda words: words[0])
def test_slack_cables_name_a_bound_that_works(words, lift, capsys):
    command = [words[0], str(lift), *words[1:]]
    run([*command, "--json"])
    said, deep = json.loads(capsys.readouterr().out)["warnings"]
    assert "cables 5, 6, 7 and 8 hang slack" in said
    assert deep.startswith("deep sag: cable 5 by ")
    run([*command, "--lower-bound", re.search(r"--lower-bound (\S+)", said)[1], "--json"])
    assert json.loads(capsys.readouterr().out)["warnings"] == []

"""--lower-bound and --upper-bound of every command that computes a state of balance."""

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

"""`diagnose --later`: what is refused before anything is fitted."""

import pytest

from cdpr_struct.cli.main import run

CAMPAIGN = "examples/recorded-motion/campaign.toml"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([CAMPAIGN, "--later", "none.toml"], "none.toml"),
        ([CAMPAIGN, CAMPAIGN.replace("campaign", "later"), "--later", CAMPAIGN], "a single campaign"),
        ([CAMPAIGN, "--later", "examples/table-4-4/campaign.toml"], "8 cables"),
    ],
    ids=["no file", "several campaigns", "another robot"],
)
def test_later_readings_that_cannot_be_used_are_refused(words, said, capsys):
    assert run(["diagnose", *words]) == 2
    assert said in capsys.readouterr().err

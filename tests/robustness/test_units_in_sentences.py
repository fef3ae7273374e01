"""A unit that was mended is said first, whatever else is left open; one that does not suffice is said as such."""

import shutil
from pathlib import Path

import pandas as pd
import pytest

from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.verdict import verdict
from cdpr_struct.measurement.campaign_file import load_campaign

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "table-4-4"


@pytest.mark.parametrize(
    ("campaign", "data", "newton", "status", "words"),
    [
        ("level.toml", "level.csv", 9.80665, "class", "The tensions are not in N but in kgf (mend column tension_N of"),
        pytest.param(
            "campaign.toml",
            "states.csv",
            4.4482216,
            "unknown",
            "That the tensions are not in N but in lbf would explain a",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_units_are_said(campaign, data, newton, status, words, tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "copy")
    table = pd.read_csv(tmp_path / "copy" / data, comment="#")
    table["tension_N"] /= newton
    table.to_csv(tmp_path / "copy" / data, index=False)
    said = verdict(diagnose(load_campaign(tmp_path / "copy" / campaign)))
    assert said.status == status
    assert words in said.sentence
    assert "1 causes" not in said.sentence

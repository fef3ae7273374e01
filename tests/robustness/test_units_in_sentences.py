"""A unit that was corrected is said first, whatever else is left open."""

import shutil
from pathlib import Path

import pandas as pd
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.reports.diagnose.result import result_json

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "table-4-4"


@pytest.mark.parametrize(
    ("campaign", "data", "newton", "words"),
    [
        ("level.toml", "level.csv", 9.80665, "The tensions are not in N but in kgf (correct column tension_N of"),
        pytest.param(
            "campaign.toml", "states.csv", 4.4482216, "he tensions are not in N but in lbf", marks=pytest.mark.slow
        ),
    ],
)
def test_units_are_said(campaign, data, newton, words, tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "copy")
    table = pd.read_csv(tmp_path / "copy" / data, comment="#")
    table["tension_N"] /= newton
    table.to_csv(tmp_path / "copy" / data, index=False)
    said = result_json(diagnosed(load_campaign(tmp_path / "copy" / campaign)))["verdict"]
    assert words in said["sentence"]
    assert "1 causes" not in said["sentence"]

"""The page on the recording of others says what the program computes; its numbers and picture: python docs/pictures."""

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.reports.figures.style import svg
from cdpr_struct.residuals.condensed import condensed
from cdpr_struct.residuals.recorded import recorded
from tests.docs.test_pictures import words

ROOT = Path(__file__).parents[2]
DOCS, FOLDER = ROOT / "docs", ROOT / "examples" / "recorded-motion"
NUMBERS = json.loads((DOCS / "recorded_motion.json").read_text("utf-8"))
PAGE = (DOCS / "recorded_motion.md").read_text("utf-8")


def test_the_page_says_its_numbers():
    rows = re.findall(r"^\| (\d) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", PAGE, re.MULTILINE)
    assert [[float(cell) for cell in row[1:]] for row in rows] == [
        [round(v, 2) for v in r] for r in NUMBERS["later_mm"]
    ]
    assert (NUMBERS["status"], NUMBERS["causes"]) == ("named", ["sensor_delay"])
    said = [
        f"{-NUMBERS['delay_ms']:.1f} ± {NUMBERS['sigma_ms']:.1f} ms newer",
        f"the {NUMBERS['frames']} frames are worth\n{NUMBERS['independent_frames']:.0f} independent ones",
        f"keeps {NUMBERS['states']} of them",
        f"chi2/dof = {NUMBERS['stretches_chi2_per_dof']:.1f}",
        f"widened by {NUMBERS['sigma_factor']:.2f}",
        f"another {NUMBERS['remainder']['log_evidence_gain']:.0f} nats",
        f"| {NUMBERS['remainder']['ahead_nats']:.0f} nats |",
        f"{100 * NUMBERS['explained_by_speed']['after']:.0f} %, before {100 * NUMBERS['explained_by_speed']['before']:.0f} %",
        f"another {100 * NUMBERS['explained_by_acceleration']['after']:.0f} % of the variance",
        f"About {np.mean([row[2] for row in NUMBERS['later_mm']]):.1f} mm remain",
    ]
    assert [one for one in said if one not in PAGE] == []


def test_the_recording_is_what_the_page_says_of_it():
    """The cheap part of it: how the frames are condensed, and the errors of the robot as entered."""
    campaign, later = load_campaign(FOLDER / "campaign.toml"), load_campaign(FOLDER / "later.toml")
    few = condensed(campaign)
    assert (few.frames.of, len(few.states.names)) == (NUMBERS["frames"], NUMBERS["states"])
    assert few.frames.worth == pytest.approx(NUMBERS["independent_frames"], rel=1e-3)
    rms = np.sqrt((AllFrames.read(recorded(later)).errors(None) ** 2).mean(axis=0))
    np.testing.assert_allclose(1e3 * rms, [row[0] for row in NUMBERS["later_mm"]], rtol=1e-3)


def test_the_recording_is_shipped_with_its_notice():
    licence, notice = ((FOLDER / name).read_text("utf-8") for name in ("LICENSE_MIT.txt", "README.md"))
    holder = "Copyright (c) 2023 MohammadrezaDindarloo"
    assert holder in licence
    assert holder in notice
    assert "Permission is hereby granted" in licence


@pytest.mark.slow
def test_the_program_still_finds_it(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS / "pictures"))
    sys.modules.pop("recorded_motion", None)
    import recorded_motion

    found = recorded_motion.found()
    told = found.numbers()
    assert (told["status"], told["causes"]) == (NUMBERS["status"], NUMBERS["causes"])
    for name in ("delay_ms", "sigma_ms", "stretches_ms", "later_mm", "stretches_chi2_per_dof"):
        np.testing.assert_allclose(told[name], NUMBERS[name], rtol=0.02)
    drawn = svg("recorded-motion", recorded_motion.SIZE, lambda figure: recorded_motion.draw(figure, found))
    assert words(drawn) == words((DOCS / "recorded_motion.svg").read_text("utf-8"))

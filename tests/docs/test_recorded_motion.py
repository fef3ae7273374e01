"""The page on the recording of others says what the program computes; its numbers and picture: python docs/pictures."""

import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.diagnosis.all_frames import AllFrames
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses import search
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.observation.motion import length_rates
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
    shown = [[float(cell) for cell in row[1:]] for row in rows]
    assert shown == [[round(value, 2) for value in row] for row in NUMBERS["later_mm"]]
    by_speed, by_acceleration = NUMBERS["explained_by_speed"], NUMBERS["explained_by_acceleration"]
    assert (NUMBERS["status"], NUMBERS["causes"]) == ("named", ["sensor_delay"])
    said = [
        f"{NUMBERS['delay_ms']:.1f} ± {NUMBERS['sigma_ms']:.1f} ms older",
        f"the {NUMBERS['frames']} frames are worth\n{NUMBERS['independent_frames']:.0f} independent ones",
        f"keeps {NUMBERS['states']} of them",
        f"chi2/dof = {NUMBERS['stretches_chi2_per_dof']:.1f}",
        f"widened by {NUMBERS['sigma_factor']:.2f}",
        f"another {NUMBERS['remainder']['log_evidence_gain']:.0f} nats",
        f"| {NUMBERS['remainder']['ahead_nats']:.0f} nats |",
        f"{100 * by_speed['after']:.0f} %, before {100 * by_speed['before']:.0f} %",
        f"all that speed explains | {100 * NUMBERS['bend_of_speed']['size']:.0f} % |",
        f"another {100 * by_acceleration['after']:.0f} % of the variance",
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
def test_without_the_delay_in_the_library_nothing_is_named(monkeypatch):
    """Play of the drives and a shifted centre of mass are then the likeliest; they leave a function of speed."""
    campaign, usual = load_campaign(FOLDER / "campaign.toml"), search.testable
    approach = -np.sign(length_rates(campaign.states)[..., 0])

    def without(seen, checked):
        causes, hidden = usual(seen, checked)
        return [cause for cause in causes if cause.name not in ("sensor_delay", "clock_drift")], hidden

    monkeypatch.setattr(search, "testable", without)
    said = diagnosed(replace(campaign, states=replace(campaign.states, approach=approach)))
    assert "backlash" in max(said.beliefs, key=lambda one: one.probability).names
    assert said.decision.status == "unknown"
    assert said.recording.unnamed_motion


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

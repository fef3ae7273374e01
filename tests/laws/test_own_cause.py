"""The cause of one's own in the docs, run as printed, on readings of a robot that has it (crime=True)."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from cdpr_struct.diagnosis.causes.registry import LIBRARY
from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.verdict import verdict
from tests.laws.crime_campaign import clean_campaign

PAGE = Path(__file__).parents[2] / "docs" / "diagnosis.md"
WARMER = 40.0  # [K]


@pytest.fixture
def own():
    """The names that the printed script defines; its cause is taken out of the library again."""
    before, names = dict(LIBRARY), {"__name__": "own_cause"}
    section = PAGE.read_text("utf-8").split("## A cause of your own")[1]
    exec(re.search(r"```python\n(.*?)```", section, re.S)[1], names)
    yield names
    LIBRARY.clear()
    LIBRARY.update(before)


def test_the_printed_cause_is_found_with_its_size(own):
    """The frame was entered as it was when cold."""
    campaign = clean_campaign(8)
    cold = campaign.robot.frame_anchors / (1.0 + own["ALUMINIUM"] * WARMER)
    found = diagnose(replace(campaign, robot=replace(campaign.robot, frame_anchors=cold)), "small")
    said = verdict(found)
    assert said.causes == ("warm_frame",)
    assert "the frame is warmer by" in said.sentence.lower()
    best = found.selection.fit
    assert best.theta[0] * best.choices[0].prior[0] == pytest.approx(
        WARMER, abs=2.0 * best.covariance[0, 0] ** 0.5 * 15.0
    )


def test_it_is_not_found_where_it_is_not(own):
    assert verdict(diagnose(clean_campaign(8), "small")).status == "adequate"

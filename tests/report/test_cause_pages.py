"""The pages of the cause library are those of the library."""

from pathlib import Path

import pytest

import cdpr_struct as cs
from cdpr_struct.diagnosis.damped import NEEDS_SIGNALS
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.reports.diagnose.cause_descriptions import DESCRIPTIONS
from cdpr_struct.reports.diagnose.cause_pages import pages
from cdpr_struct.reports.diagnose.cause_rivals import CONFUSED

HANDLING = ("unit_error", "sign_error", "swapped_channels", "pose_mismatch", "rotation_convention")
SHORTCUTS = ("cable_sag", "cable_dynamics", "attachment_geometric_stiffness")

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs" / "causes"


def test_pages_are_current():
    written = {p.name: p.read_text("utf-8") for p in DOCS.glob("*.md") if p.name != "gallery.md"}
    assert written == pages()


def test_every_name_that_a_verdict_can_have_has_a_page():
    """What is tested, corrected or left out of a simulation, and the laws of damping."""
    names = {*LIBRARY, internal_force.CAUSE.name, *HANDLING, *SHORTCUTS, *NEEDS_SIGNALS}
    assert {"index.md", *(f"{name}.md" for name in names)} == set(pages())


def test_every_cause_is_described_and_look_alikes_are_causes():
    names = {name.removesuffix(".md") for name in pages()} - {"index"}
    assert set(DESCRIPTIONS) == names
    assert {name for pair in CONFUSED for name in pair} <= names
    assert all(len(pair) == 2 for pair in CONFUSED)


@pytest.mark.slow
@pytest.mark.parametrize("campaign", ["soft-masts", "table-4-4"])
def test_what_a_plan_confuses_is_named_on_the_pages(campaign):
    found = cs.plan(ROOT / "examples" / campaign / "campaign.toml").answer["confusable"]
    assert found
    assert {frozenset(pair) for pair in found} <= CONFUSED

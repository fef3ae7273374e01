"""The pages of the cause library are those of the library."""

from pathlib import Path

from cdpr_struct.diagnosis.damped import NEEDS_SIGNALS
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.reports.diagnose.cause_pages import pages

HANDLING = ("unit_error", "sign_error", "swapped_channels", "pose_mismatch")
SHORTCUTS = ("cable_sag", "cable_dynamics", "attachment_geometric_stiffness")

DOCS = Path(__file__).parents[2] / "docs" / "causes"


def test_pages_are_current():
    assert {p.name: p.read_text("utf-8") for p in DOCS.glob("*.md")} == pages()


def test_every_name_that_a_verdict_can_have_has_a_page():
    """What is tested, corrected or left out of a simulation, and the laws of damping."""
    names = {*LIBRARY, internal_force.CAUSE.name, *HANDLING, *SHORTCUTS, *NEEDS_SIGNALS}
    assert {"index.md", *(f"{name}.md" for name in names)} == set(pages())

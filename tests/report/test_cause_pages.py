"""The pages of the cause library are those of the library."""

from pathlib import Path

from cdpr_struct.diagnosis.causes.registry import HANDLING, LIBRARY, NEEDS_SIGNALS, SHORTCUTS
from cdpr_struct.reports.diagnosis_causes import pages

DOCS = Path(__file__).parents[2] / "docs" / "causes"


def test_pages_are_current():
    assert {p.name: p.read_text("utf-8") for p in DOCS.glob("*.md")} == pages()


def test_every_name_that_a_verdict_can_have_has_a_page():
    """What is tested, corrected or left out of a simulation, and the laws of damping."""
    names = {*LIBRARY, "internal_force", "flexible_platform", *HANDLING, *SHORTCUTS, *NEEDS_SIGNALS}
    assert {f"{name}.md" for name in names} == set(pages())

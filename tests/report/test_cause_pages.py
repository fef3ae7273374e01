"""The pages of the cause library are those of the library."""

from pathlib import Path

from cdpr_struct.reports.diagnosis_causes import pages

DOCS = Path(__file__).parents[2] / "docs" / "causes"


def test_pages_are_current():
    assert {p.name: p.read_text("utf-8") for p in DOCS.glob("*.md")} == pages()

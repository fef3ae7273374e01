"""The paper cites what its bibliography has, all of it, and repeats figures of the records."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAPER = (ROOT / "paper" / "paper.md").read_text("utf-8")
BIBLIOGRAPHY = (ROOT / "paper" / "paper.bib").read_text("utf-8")
FIGURES = {
    "docs/dynamics.md": ("2e-8", "0.8 %", "0.75 %"),
    "docs/tutorial_model_right.md": ("up to 27 %",),
    "docs/benchmarks.md": ("three times our time for twelve certified",),
}
"""Page: what the paper takes from it, as it stands there."""


def test_citations_and_bibliography_are_the_same():
    cited = set(re.findall(r"@(\w+)", PAPER))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", BIBLIOGRAPHY, re.MULTILINE))
    assert len(cited) >= 10


def test_figures_of_the_paper_are_those_of_the_pages():
    for page, figures in FIGURES.items():
        text = " ".join((ROOT / page).read_text("utf-8").split())
        assert [figure for figure in figures if figure not in text] == [], page


def test_the_paper_is_short_enough():
    assert 750 < len(PAPER.split()) < 1750

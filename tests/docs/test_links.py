"""Pages are links, not names in backticks, and the README's links lead somewhere."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
LINK = re.compile(r"\]\(([^)#\s]+)")
NAME = re.compile(r"`docs/[\w./]+?`|(?<!\()\bdocs/[\w.]+\.md\b")


def text_of(page: Path) -> str:
    """A page without its blocks of code."""
    return re.sub(r"^```.*?^```$", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)


def named(text: str) -> list[str]:
    """Pages of docs that a text names without a link; folders and files that are no pages are names."""
    return [name for name in NAME.findall(text) if name.strip("`").endswith((".md", "causes"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_other_pages_are_links(page):
    assert named(text_of(page)) == []


def test_links_of_the_readme_lead_to_files():
    links = {link for link in LINK.findall(text_of(PAGES[0])) if "://" not in link}
    assert len(links) > 20
    assert [link for link in sorted(links) if not (ROOT / link).is_file()] == []


@pytest.mark.parametrize("text", ["see `docs/files.md`", "the library (`docs/causes`)", "has it: docs/files.md."])
def test_a_name_without_a_link_is_seen(text):
    assert named(text)

"""The documentation as a site: it builds strictly, every page can be found, and nothing is loaded from a network."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

pytest.importorskip("mkdocs")
pytest.importorskip("material")
pytest.importorskip("latex2mathml")

ROOT = Path(__file__).parents[2]
LOADED = {"script": "src", "img": "src", "source": "src", "iframe": "src", "object": "data", "link": "href"}
NOT_LOADED = {"canonical", "next", "prev", "alternate"}  # links in the head that are only names
NETWORK = re.compile(r"^\s*(?:https?:)?//", re.IGNORECASE)
IN_STYLES = re.compile(r"(?:url\(|@import)\s*['\"]?((?:https?:)?//[^'\")\s]+)", re.IGNORECASE)
LEAST = 2  # other pages whose text links to a page; the navigation is not counted


@dataclass
class Page(HTMLParser):
    """Links of the navigation and of the text of one page, and what it loads."""

    html: str
    in_navigation: set[str] = field(default_factory=set)
    in_text: set[str] = field(default_factory=set)
    loaded: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self.article = self.nav = 0
        self.feed(self.html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.article += tag == "article"
        self.nav += tag == "nav"
        if tag in LOADED and not NOT_LOADED & set(given.get("rel", "").split()):
            self.loaded += [given[LOADED[tag]]] if LOADED[tag] in given else []
        if tag == "a" and "href" in given:
            (self.in_text if self.article else self.in_navigation if self.nav else set()).add(given["href"])

    def handle_endtag(self, tag: str) -> None:
        self.article -= tag == "article"
        self.nav -= tag == "nav"


def targets(page: str, links: set[str]) -> set[str]:
    """Pages of the site that the links of a page lead to, itself left out."""
    parts = [urlsplit(link) for link in links]
    local = {os.path.normpath(Path(page).parent / unquote(p.path)) for p in parts if p.path and not p.scheme}
    return {name for name in local if name.endswith(".html")} - {page}


def unreachable(pages: dict[str, Page]) -> set[str]:
    """Pages that no row of links joins with the first one."""
    found, new = set(), {"index.html"}
    while new:
        found |= new
        new = {t for n in new for t in targets(n, pages[n].in_text | pages[n].in_navigation)} & pages.keys() - found
    return pages.keys() - found


def seldom_linked(pages: dict[str, Page]) -> dict[str, list[str]]:
    """Pages that the texts of less than LEAST other pages link to, with these pages."""
    places: dict[str, list[str]] = {name: [] for name in pages}
    for name, page in pages.items():
        for target in targets(name, page.in_text) & pages.keys():
            places[target].append(name)
    return {name: found for name, found in places.items() if len(found) < LEAST}


def from_network(html: str) -> list[str]:
    """Addresses that a page or a style sheet loads from a network."""
    return [address for address in Page(html).loaded if NETWORK.match(address)] + IN_STYLES.findall(html)


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    # not --quiet: mkdocs does not count warnings that it does not log
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1", "DISABLE_MKDOCS_2_WARNING": "true"}
    built = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


@pytest.fixture(scope="module")
def pages(site) -> dict[str, Page]:
    """Page by its path in the site."""
    return {p.relative_to(site).as_posix(): Page(p.read_text("utf-8")) for p in site.rglob("*.html") if p.stem != "404"}


def test_every_page_of_docs_is_in_the_site(pages):
    docs = ROOT / "docs"
    expected = {p.relative_to(docs).with_suffix(".html").as_posix() for p in docs.rglob("*.md")}
    assert expected <= pages.keys()


def test_every_page_can_be_reached(pages):
    assert unreachable(pages) == set()


def test_every_page_is_linked_from_two_others(pages):
    assert seldom_linked(pages) == {}


def test_nothing_is_loaded_from_a_network(site):
    files = [path for path in site.rglob("*") if path.suffix in {".html", ".css"}]
    assert {path.name: found for path in files if (found := from_network(path.read_text("utf-8")))} == {}


def test_search_works_from_a_folder(site, pages):
    """The index is a script, and the worker that reads it is replaced where a page comes from a folder."""
    assert (site / "search" / "search_index.js").read_text("utf-8").startswith("var __index = ")
    assert "javascripts/iframe-worker.js" in pages["index.html"].loaded


def test_every_formula_of_the_sheet_is_on_a_page_as_mathml(site):
    sheet = (ROOT / "derivations" / "latex" / "formula_sheet.tex").read_text("utf-8")
    names = re.findall(r"subsection\*\{(\w+)\.(.+?) \\hfill", sheet.replace("\\_", "_"))
    text = {page: (site / "formulas" / f"{page}.html").read_text("utf-8") for page in dict(names)}
    assert {(page, name) for page, name in names if f'id="{name}"' in text[page]} == set(names)
    converted = [formula for page in text.values() for formula in re.findall(r"<math.*?</math>", page, re.DOTALL)]
    assert len(converted) >= len(names)
    assert not [formula for formula in converted if re.search(r">\\[a-zA-Z]", formula) or "<mi></mi>" in formula]


@pytest.mark.parametrize(
    "html",
    [
        '<script src="https://cdn.example/x.js"></script>',
        '<link rel="stylesheet" href="//fonts.example/css">',
        '<link rel="preconnect" href="https://fonts.example" crossorigin>',
        '<img src="http://example/x.png">',
        "<style>@import url(https://fonts.example/css)</style>",
    ],
)
def test_an_address_in_a_network_is_seen(html):
    assert from_network(html)


def test_a_page_without_links_is_seen():
    pages = {
        "index.html": Page('<nav><a href="a.html">A</a></nav><article><a href="a.html#x">a</a></article>'),
        "a.html": Page('<article><a href="index.html">home</a></article>'),
        "b.html": Page('<article><a href="index.html">home</a></article>'),
    }
    assert unreachable(pages) == {"b.html"}
    assert seldom_linked(pages) == {"a.html": ["index.html"], "b.html": []}

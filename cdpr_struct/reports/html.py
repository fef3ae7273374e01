"""One self-contained HTML page from sentences, figures and tables; it loads nothing from anywhere."""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib import resources
from typing import TYPE_CHECKING, Any

import jinja2

from cdpr_struct.reports.figures.plotly_source import plotly_packed
from cdpr_struct.reports.typeset import typeset

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.drawing import Drawing

_WARNINGS, _END = "<!-- warnings -->", "<!-- end -->"
"""Marks in the template, where `completed` writes."""


@dataclass(frozen=True, slots=True)
class Plate:
    """A figure of the page.

    name        : letters and underscores; the figure's id and the name of its files
    picture     : what is shown where scripts do not run, in print, and in papers
    interactive : the same as plotly data, or None
    live        : the same as markup with a script of its own, which hides the static figure; "" for none
    caption     : of the picture;  live_caption : of what stands in its place on the screen, "" where it is the same
    both        : on the screen the picture stays above the interactive figure, which shows something else
    """

    name: str
    title: str
    picture: "Drawing"
    caption: str
    interactive: Mapping[str, Any] | None = None
    live: str = ""
    live_caption: str = ""
    both: bool = False

    @property
    def markup(self) -> str:
        """The <svg> element without XML prologue."""
        return _element(self.picture.svg)

    @property
    def narrow(self) -> str:
        """The <svg> element for narrow screens."""
        return _element(self.picture.narrow_svg)

    @property
    def data(self) -> str:
        """The interactive figure as JSON that cannot end its script element."""
        return json.dumps(self.interactive, allow_nan=False).replace("<", "\\u003c")

    @property
    def solid(self) -> bool:
        """Whether the interactive figure is a scene to be turned, not a plot to be zoomed."""
        return "scene" in (self.interactive or {}).get("layout", {})


@dataclass(frozen=True, slots=True)
class HtmlTable:
    """A table of ready-made text.

    marked : numbers (from 0) of rows that break a limit
    prose  : numbers (from 0) of columns that hold words: set flush left
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""
    marked: frozenset[int] = frozenset()
    prose: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class Page:
    """What a report page holds, in the order it is shown.

    verdict : the outcome first, further sentences after it;  holds : its colour
    facts   : (value, what it is) in large type
    notes   : (heading, paragraphs) of how to read and how it was computed
    listings : (heading, text) shown line by line as it is
    gallery : figures stand two abreast; they are drawn half as wide
    robot   : whose it is; figures say so, too

    `completed` adds what the command line knows: how to repeat the run, warnings, extensions of the robot file.
    """

    title: str
    subtitle: str
    verdict: Sequence[str]
    holds: bool
    facts: Sequence[tuple[str, str]]
    plates: Sequence[Plate]
    tables: Sequence[HtmlTable]
    notes: Sequence[tuple[str, Sequence[str]]]
    listings: Sequence[tuple[str, str]] = ()
    gallery: bool = False
    robot: str = ""

    @property
    def sections(self) -> list[tuple[str, str]]:
        """Mark and heading of everything on the page, for the list of contents."""
        parts = (
            ("table", [table.title for table in self.tables]),
            ("listing", [heading for heading, _ in self.listings]),
            ("note", [heading for heading, _ in self.notes]),
        )
        figures = [(plate.name, plate.title) for plate in self.plates]
        return figures + [(f"{kind}-{i}", title) for kind, titles in parts for i, title in enumerate(titles, start=1)]

    def heading(self, plate: Plate) -> str:
        """Title of a figure where it stands alone."""
        return f"{self.robot}: {plate.title}" if self.robot else plate.title


def page_files(page: Page) -> dict[str, str | bytes]:
    """The page, and each of its figures as SVG and as PDF, by name."""
    files: dict[str, str | bytes] = {}
    for plate in page.plates:
        files[f"{plate.name}.svg"] = plate.picture.svg_file(page.heading(plate))
        files[f"{plate.name}.pdf"] = plate.picture.pdf(page.heading(plate))
    return {**files, "report.html": render_page(page)}


def render_page(page: Page) -> str:
    """The page as HTML; plotly.js is in it if a figure is interactive."""
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(_template), autoescape=True, trim_blocks=True, lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )  # fmt: skip
    environment.filters["typeset"] = typeset
    template = environment.get_template("page.html.j2")
    packed = plotly_packed() if any(plate.interactive for plate in page.plates) else ""
    return template.render(
        page=page, style=_template("page.css"), script=_template("interactive.js"), plotly_packed=packed
    )


def completed(
    page: str | bytes,
    command: str,
    warnings: Sequence[str] = (),
    extensions: Sequence[str] = (),
    locked: Sequence[str] = (),
) -> str:
    """A rendered page with the command that repeats the run, and sentences that stand on the screen beside the result.

    warnings, and how the rest at locked lengths was found, stand below the verdict; extensions and the command at the
    end
    """
    text = page.decode("utf-8") if isinstance(page, bytes) else page
    top = f'<section class="warnings">{_paragraphs(f"Warning: {w}" for w in warnings)}</section>' if warnings else ""
    top += f'<section class="notes">{_paragraphs(locked)}</section>' if locked else ""
    end = f'<section class="notes"><h2>Extensions</h2>{_paragraphs(extensions)}</section>\n' if extensions else ""
    end += f'<section class="notes"><h2>Reproduce</h2>\n<pre>{_words(command)}</pre></section>'
    return text.replace(_WARNINGS, top, 1).replace(_END, end, 1)


def _element(svg: str) -> str:
    return svg[svg.index("<svg") :]


def _paragraphs(sentences: Iterable[str]) -> str:
    return "".join(f"<p>{escape(typeset(sentence))}</p>" for sentence in sentences)


def _words(command: str) -> str:
    """A command whose lines break between its words, not inside them; copied, it is the same text."""
    return "".join(
        part if part.isspace() else f'<span class="word">{escape(part)}</span>'
        for part in re.split(r"(\s+)", command) if part
    )  # fmt: skip


def _template(name: str) -> str:
    return resources.files("cdpr_struct.reports.templates").joinpath(name).read_text(encoding="utf-8")

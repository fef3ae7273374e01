"""A figure in every form in which a report gives it: for the page, for a narrow screen, for a paper."""

import io
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.narrow import NarrowFigure, extent, make_legible
from cdpr_struct.reports.figures.style import LOOK, Draw, shown_part, svg_of

_PDF_LOOK: Any = {"pdf.fonttype": 42}  # TrueType: text stays text that can be searched and edited
_UNDATED = {"CreationDate": None, "Creator": None, "Producer": None}


@dataclass(frozen=True, eq=False)
class Drawing:
    """What to draw, and its forms; equal input gives equal bytes.

    name : letters and underscores; ids start with it, so that a page can hold many figures
    size : width and height [inch] on a wide page and in a paper
    draw : called with an empty figure, once for wide forms and once for the narrow one
    """

    name: str
    size: tuple[float, float]
    draw: Draw

    @cached_property
    def _wide(self) -> Figure:
        figure = Figure(figsize=self.size, layout="constrained")
        with mpl.rc_context(LOOK):
            self.draw(figure)
        return figure

    @cached_property
    def svg(self) -> str:
        """SVG text for a wide page."""
        return svg_of(self._wide, self.name)

    @cached_property
    def narrow_svg(self) -> str:
        """SVG text for a phone: panels one below the other, letters as large as elsewhere."""
        figure = NarrowFigure(self.size)
        with mpl.rc_context(LOOK):
            self.draw(figure)
            make_legible(figure)
        text = svg_of(figure, f"{self.name}-narrow")
        return shown_part(text, figure.get_figheight(), extent(figure))

    def svg_file(self, title: str) -> str:
        """SVG that says what it shows where nothing else does."""
        head, mark, rest = self.svg.partition("<svg ")
        tag, end, body = rest.partition(">")
        return f"{head}{mark}{tag}{end}\n <title>{escape(title)}</title>{body}"

    def pdf(self, title: str) -> bytes:
        """PDF for a paper: fonts inside, no date."""
        self.svg  # noqa: B018  (its layout is the one to print)
        self._wide.set_layout_engine("none")
        buffer = io.BytesIO()
        with mpl.rc_context({**LOOK, **_PDF_LOOK}):
            FigureCanvasPdf(self._wide).print_pdf(buffer, metadata={**_UNDATED, "Title": title})
        return buffer.getvalue()

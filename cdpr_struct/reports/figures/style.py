"""The common look of all figures, and how one becomes SVG text."""

import io
import re
from collections.abc import Callable
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator
from matplotlib.transforms import Bbox

from cdpr_struct.reports.typeset import raised

# Okabe and Ito's palette, distinguishable with any colour vision.
BLACK, GREY, LIGHT = "#222222", "#8a8f98", "#e3e6ea"
ON_MAP = "#1a1a1a"
"""Lines and letters on coloured areas, which stay light where the page is dark."""
BLUE, SKY, GREEN = "#0072B2", "#56B4E9", "#009E73"
ORANGE, VERMILLION, PURPLE = "#E69F00", "#D55E00", "#CC79A7"

GOOD, BAD = GREEN, VERMILLION
KIND_COLOURS = {"platform": BLUE, "mixed": PURPLE, "cable": ORANGE}
KIND_WORDS = {"platform": "blue", "mixed": "pink", "cable": "orange"}
KIND_MARKERS = {"platform": "s", "mixed": "D", "cable": "o"}

FONT_STACK = "'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"

LOOK: Any = {
    "svg.fonttype": "none",
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": GREY,
    "axes.labelcolor": BLACK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": LIGHT,
    "grid.linewidth": 0.6,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "text.color": BLACK,
    "text.parse_math": False,  # names of robots and cases may hold any sign
    "figure.facecolor": "white",
}
_NO_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}


Draw = Callable[[Figure], None]
"""Draws into an empty figure."""


def svg(name: str, size: tuple[float, float], draw: Draw) -> str:
    """Draw a figure and return it as SVG: same input, same text; ids start with `name` so that pages can hold many.

    Parameters
    ----------
    size : width and height [inch]
    draw : called with the empty figure
    """
    with mpl.rc_context(LOOK):
        figure = Figure(figsize=size, layout="constrained")
        draw(figure)
    return svg_of(figure, name)


def svg_of(figure: Figure, name: str) -> str:
    """A drawn figure as SVG."""
    buffer = io.StringIO()
    with mpl.rc_context({**LOOK, "svg.hashsalt": name}):
        FigureCanvasSVG(figure).print_svg(buffer, metadata=_NO_METADATA)
    return _portable(buffer.getvalue(), name)


def shown_part(text: str, height: float, part: Bbox) -> str:
    """SVG text of a figure so high, cut or widened to a part of it [inch]: sizes in points, y downwards."""
    left, top, width, high = (72.0 * v for v in (part.x0, height - part.y1, part.width, part.height))
    size = f'width="{width:.3f}pt" height="{high:.3f}pt" viewBox="{left:.3f} {top:.3f} {width:.3f} {high:.3f}"'
    return re.sub(r'width="[\d.]+pt" height="[\d.]+pt" viewBox="[-\d. ]+"', size, text, count=1)


def _portable(text: str, name: str) -> str:
    """Fonts that every system has, ids of this figure only."""
    text = re.sub(r"'?DejaVu Sans'?(, sans-serif)?", FONT_STACK, text)
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r"url\(#", f"url(#{name}-", text)
    return re.sub(r'href="#', f'href="#{name}-', text)


def kind_group(kind: str) -> str:
    """`platform`, `mixed` or `cable`: the last stands for `cable i` and `cables` alike."""
    return kind if kind in KIND_COLOURS else "cable"


def plain_number(value: float) -> str:
    """Tick text: 0.001, 10, 1000, and powers of ten beyond 0.0001 and 10000, like 2·10⁵."""
    if value == 0.0 or 1e-4 <= abs(value) * (1.0 + 1e-9) < 1e5:
        return f"{value:.10g}"
    factor, exponent = f"{value:.0e}".split("e")
    power = "10" + raised(str(int(exponent)))
    return power if factor == "1" else f"{factor}·{power}"


def plain_ticks(axis: mpl.axis.Axis) -> None:
    """Write the major ticks of a log axis as plain numbers and the minor ones not at all; 1, 2, 5 on a short axis."""
    low, high = axis.get_view_interval()
    if high < 300.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain_number(value)))
    axis.set_minor_formatter(FuncFormatter(lambda *_: ""))


def quiet(axes: Axes, which: str = "y") -> None:
    """Keep the grid lines of one direction only."""
    axes.grid(False)
    axes.grid(True, axis=which)  # type: ignore[arg-type]

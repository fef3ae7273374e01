"""A figure of the reports on the screen: in a notebook, or in a window of matplotlib's own."""

from typing import Any

import matplotlib as mpl
from matplotlib import pyplot
from matplotlib.axes import Axes

from cdpr_struct.reports.figures.style import LOOK, Draw

__all__ = ["Axes", "Draw", "shown"]
_COLOUR_BAR = "<colorbar>"  # matplotlib's label of such axes
_HIGHEST = 0.93  # of the figure: axes that reach higher leave no room for a title above them


def shown(draw: Draw, size: tuple[float, float], title: str) -> Axes:
    """Draw into a new pyplot figure in the common look, and return its axes at the upper left, which carry the title.

    size : width and height [inch]
    draw : called with the empty figure
    """
    with mpl.rc_context(LOOK):
        figure = pyplot.figure(figsize=size, layout="constrained")
        draw(figure)
        panels = [axes for axes in figure.axes if axes.get_label() != _COLOUR_BAR]
        axes = min(panels, key=_from_the_upper_left)
        own = axes.get_title(loc="left")
        axes.set_title("", loc="left")
        more = f"\n{own}" if own and own.lower() not in title.lower() else ""
        axes.set_title(f"{title}{more}", loc="center", **_place(axes))
    return axes


def _from_the_upper_left(axes: Axes) -> tuple[float, float]:
    """Ranks axes by how far they are from the top, then from the left."""
    box = axes.get_position()
    return round(1.0 - box.y1, 6), box.x0


def _place(axes: Axes) -> dict[str, Any]:
    """Where the title goes if the axes fill the figure: inside it; else above the axes, as matplotlib does."""
    box = axes.get_position()
    if box.y1 <= _HIGHEST:
        return {}
    return {"y": (_HIGHEST - box.y0) / box.height, "x": (0.5 - box.x0) / box.width}

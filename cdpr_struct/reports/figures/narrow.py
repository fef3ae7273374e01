"""Figures on narrow screens: the same drawing, with panels below each other and letters that can be read."""

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.category import StrCategoryLocator
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator
from matplotlib.transforms import Bbox

WIDTH = 4.2
"""Of a narrow figure [inch]: on a phone 400 pixels wide a letter of 8 points is then 9 to 10 pixels high."""
_SMALLEST = 7.6  # letters [pt]
_LOWEST = 0.72  # of the height on a wide page, at least; less would press curves flat
_PANEL_LOWEST = 1.9  # height of a panel that is as wide as the figure [inch]
_MANY = 6  # panels from which on two stand side by side
_LETTER, _HANDLE = 4.9, 36.0  # widths in a legend [pt]
_LINE, _AROUND = 0.13, 0.9  # height of a line of names, and of what is above and below them [inch]
_SPREAD = 0.56  # width of a letter over its size
_MARGIN = 0.04  # around what is shown [inch]
_LETTERS = 26  # of a name beside an axis, before it is broken into lines


class NarrowFigure(Figure):
    """A figure that lays out panels and legends for a narrow screen.

    size : width and height on a wide page [inch]
    """

    def __init__(self, size: tuple[float, float]) -> None:
        self._wide = size
        super().__init__(figsize=(WIDTH, self._height(1, 1, 1)), layout="constrained")

    def subplots(self, nrows: int = 1, ncols: int = 1, **options: Any) -> Any:
        """As on a wide page, and returned in that shape, but one or two panels wide."""
        if ncols == 1 or options.get("sharex") == "col" or options.get("sharey") == "row":
            return super().subplots(nrows, ncols, **options)  # each row and column means something
        count = nrows * ncols
        across = 2 if count >= _MANY else 1
        rows = -(-count // across)
        squeeze = options.pop("squeeze", True)
        options.pop("width_ratios", None)
        heights = options.pop("height_ratios", None)
        if heights is not None and across == 1:
            options["height_ratios"] = np.repeat(heights, ncols)
        self.set_figheight(self._height(rows / nrows, ncols / across, rows))
        panels = super().subplots(rows, across, squeeze=False, **options).ravel()
        for spare in panels[count:]:
            spare.remove()
        shaped = panels[:count].reshape(nrows, ncols)
        return shaped.squeeze() if squeeze else shaped

    def legend(self, *args: Any, **options: Any) -> Legend:
        """In as many columns as fit; below the panels if it is beside them elsewhere."""
        if str(options.get("loc", "")).startswith("outside right"):
            options |= {"loc": "outside lower center", "ncols": 8}
        most = options.pop("ncols", 1)
        if len(args) == 2:
            labels = list(args[1])
        else:
            handles = options.get("handles") or [h for axes in self.axes for h in axes.get_legend_handles_labels()[0]]
            labels = [str(handle.get_label()) for handle in handles]
        longest = max((len(label) for label in labels), default=1)
        fit = int(WIDTH * 72.0 / (_HANDLE + _LETTER * longest))
        return super().legend(*args, ncols=max(1, min(most, fit)), **options)

    def _height(self, more_rows: float, fewer_columns: float, rows: int) -> float:
        """Height of the figure [inch] when each panel keeps about its shape."""
        width, height = self._wide
        if width <= WIDTH:
            return height
        kept = height * more_rows * max(WIDTH / width * fewer_columns, _LOWEST if more_rows == 1 else 0.0)
        return max(kept, _PANEL_LOWEST * rows) if more_rows > 1 else kept


def make_legible(figure: Figure) -> None:
    """Make letters large enough, and lines of names and titles short enough."""
    for text in figure.findobj(Text):
        if isinstance(text, Text) and float(text.get_fontsize()) < _SMALLEST:
            text.set_fontsize(_SMALLEST)
    for axes in figure.axes:
        _break_names(axes)
        _break_title(axes)
        _break_labels(axes)


def extent(figure: Figure) -> Bbox:
    """What of a drawn figure is to be shown [inch]: its whole width, and as much of its height as is used."""
    figure.set_layout_engine("none")  # it is laid out
    box = figure.get_tightbbox()
    return Bbox([[min(0.0, box.x0), box.y0 - _MARGIN], [max(WIDTH, box.x1 + _MARGIN), box.y1 + _MARGIN]])


def _break_names(axes: Axes) -> None:
    """Names beside an axis in several lines, and room for these."""
    if not isinstance(axes.yaxis.get_major_locator(), FixedLocator | StrCategoryLocator):
        return
    places = axes.get_yticks()
    names = axes.yaxis.get_major_formatter().format_ticks(list(places))
    lines = [textwrap.wrap(name, _LETTERS) for name in names]
    if any(len(each) > 1 for each in lines):
        axes.set_yticks(places, ["\n".join(each) for each in lines], linespacing=0.95)
        figure = axes.get_figure()
        if isinstance(figure, Figure):
            room = len(lines) * max(map(len, lines)) * _LINE + _AROUND
            figure.set_figheight(max(figure.get_figheight(), room))


def _break_title(axes: Axes) -> None:
    share = axes.get_position().width * WIDTH * 72.0
    for where in ("left", "center"):
        title = axes.get_title(loc=where)
        size = float(axes.title.get_fontsize())
        if title:
            lines = [textwrap.fill(line, max(int(share / (_SPREAD * size)), 16)) for line in title.split("\n")]
            axes.set_title("\n".join(lines), loc=where)


def _break_labels(axes: Axes) -> None:
    """Names of the axes in lines no longer than the axis."""
    box, size = axes.get_position(), axes.xaxis.label.get_fontsize()
    figure = axes.get_figure()
    height = figure.get_size_inches()[1] if isinstance(figure, Figure) else WIDTH
    for label, length in ((axes.xaxis.label, box.width * WIDTH), (axes.yaxis.label, box.height * height)):
        letters = max(int(72.0 * length / (_SPREAD * float(size))), 12)
        label.set_text("\n".join(textwrap.fill(line, letters) for line in label.get_text().split("\n")))

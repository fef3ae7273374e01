"""Parts that all plotly figures share, as the plain data that plotly.js draws.

Plain data rather than plotly's Python objects: importing and validating those takes longer than the report itself; the
tests validate the data instead.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cdpr_struct.reports.figures.style import BLACK, FONT_STACK, GREY, LIGHT
from cdpr_struct.reports.typeset import typeset

Plot = dict[str, Any]
_DIGITS = 6


def plot_layout(height: int) -> Plot:
    """Paper, letters, margins and legend of a figure so high [px]."""
    return {
        "height": height,
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "font": {"family": FONT_STACK, "size": 13, "color": BLACK},
        "margin": {"l": 64, "r": 16, "t": 72, "b": 48},
        "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0.0},
        "hovermode": "closest",
    }


def plot_axis(title: str) -> Plot:
    """An axis in the look of the static figures."""
    return {
        "title": {"text": typeset(title), "font": {"size": 13}},
        "gridcolor": LIGHT,
        "zeroline": False,
        "linecolor": GREY,
        "ticks": "outside",
    }


def plot_line(x: np.ndarray, y: np.ndarray, name: str, line: Plot, hover: str = "%{x:.2f} Hz: %{y:.2f}") -> Plot:
    """A curve; hover : what is said of a point."""
    return {
        "type": "scatter", "mode": "lines", "name": name, "x": short(x), "y": short(y), "line": line,
        "hovertemplate": f"{hover}<extra>{name}</extra>",
    }  # fmt: skip


def colour_bar(title: str) -> Plot:
    """A slim colour bar with its title along it."""
    name = {"text": typeset(title), "side": "right", "font": {"size": 13}}
    return {"title": name, "thickness": 12, "outlinewidth": 0}


def short(values: np.ndarray | Sequence[float]) -> list[Any]:
    """Numbers with no more digits than show, and None where there is none; rows of rows stay rows."""
    array = np.asarray(values, dtype=float)
    if array.ndim > 1:
        return [short(row) for row in array]
    return [float(f"{v:.{_DIGITS}g}") if np.isfinite(v) else None for v in array.tolist()]

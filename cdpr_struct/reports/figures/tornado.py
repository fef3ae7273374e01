"""What moves one frequency most, and where the variance of every predicted number comes from."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, GREY, LIGHT, ORANGE, PURPLE, SKY, VERMILLION, quiet
from cdpr_struct.reports.sensitivity_told import tornado

SIZE = (10.6, 5.8)
_BARS = 14
_COLOURS = (BLUE, SKY, GREEN, ORANGE, VERMILLION, PURPLE, GREY, BLACK, LIGHT)
CAPTION = (
    "Left: change of the frequency of one mode if a single number is one sigma of its tolerance higher, the largest "
    "first; to the right it rises. Right: the share of the variance of every predicted number by kind of tolerance; "
    "the widest piece of a bar is what to measure better, the sigma stands beside it."
)


def draw_tornado(figure: Figure, result: Mapping[str, Any]) -> None:
    """Bars of single numbers to both sides of zero; stacked shares of the variance."""
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 1.3], squeeze=False)[0]
    _bars(left, result)
    _shares(right, result)


def _bars(axes: Axes, result: Mapping[str, Any]) -> None:
    found = tornado(result, _BARS)
    change = np.array([value for _, value in found])
    place = np.arange(len(found))
    axes.barh(place, change, color=np.where(change > 0.0, BLUE, ORANGE), height=0.7)
    axes.set_yticks(place, [words for words, _ in found], fontsize=7.5)
    axes.invert_yaxis()
    axes.axvline(0.0, color=BLACK, linewidth=0.8)
    reach = 1.15 * max(float(np.abs(change).max(initial=0.0)), 1e-12)
    axes.set_xlim(-reach, reach)
    hertz = result["frequencies_hz"][result["mode"] - 1]
    axes.set_xlabel(f"change of mode {result['mode']} ({hertz:.3f} Hz) per sigma [%]")
    axes.set_ylabel("number of the robot")
    quiet(axes, "x")


def _shares(axes: Axes, result: Mapping[str, Any]) -> None:
    rows = result["shares"]
    place, start = np.arange(len(rows)), np.zeros(len(rows))
    keys = [key for key in rows[0]["shares"] if any(row["shares"][key] >= 0.005 for row in rows)]
    for key, colour in zip(keys, _COLOURS, strict=False):
        share = 100.0 * np.array([row["shares"][key] for row in rows])
        axes.barh(place, share, left=start, color=colour, height=0.8, label=key.replace("_", " "))
        start += share
    axes.set_yticks(place, [f"{row['of']} ({row['sigma']})" for row in rows], fontsize=7.0)
    axes.invert_yaxis()
    axes.set_xlim(0.0, 100.0)
    axes.set_xlabel("share of the variance [%]")
    axes.set_ylabel("predicted number (sigma)")
    axes.legend(fontsize=7.0, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
    quiet(axes, "x")

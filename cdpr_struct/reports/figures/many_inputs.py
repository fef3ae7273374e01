"""One value of each of many inputs, as bars."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from cdpr_struct.reports.figures.style import BLUE, GREEN, GREY, ORANGE, VERMILLION

_COLOURS = (BLUE, ORANGE, VERMILLION, GREEN)
_MOST_NAMED = 60


def size(count: int) -> tuple[float, float]:
    """Width and height [inch] for so many inputs."""
    return 7.0, float(np.clip(0.9 + 0.17 * count, 1.6, 11.0))


def draw_values(
    figure: Figure,
    names: Sequence[str],
    values: Sequence[float],
    groups: Sequence[str],
    order: Sequence[str],
    label: str,
) -> None:
    """A bar an input, the first on top.

    groups : of each input, one of `order`, for its colour; empty if there are none
    """
    axes = figure.subplots()
    colour = dict(zip(order, _COLOURS, strict=False))
    colours = [colour.get(group, GREY) for group in groups] or [BLUE] * len(names)
    places = np.arange(len(names))
    axes.barh(places, values, color=colours, height=0.75)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlabel(label)
    if len(names) <= _MOST_NAMED:
        axes.set_yticks(places, [name if len(name) <= 40 else f"{name[:39]}…" for name in names])
    else:
        axes.set_ylabel("input, in the order of the table")
    present = [group for group in order if group in groups]
    if present:
        handles = [Patch(color=colour[group], label=group) for group in present]
        figure.legend(handles=handles, loc="outside upper right", ncols=len(handles))

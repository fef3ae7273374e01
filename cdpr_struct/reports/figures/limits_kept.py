"""Predictions with bands over the poses, and the limits that they are to keep."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.reports.figures.style import BAD, BLACK, GOOD, GREY, quiet

CAPTION = (
    "One panel a requirement: the prediction at every pose with its 90 % band, the limit as a line. Green passes, red "
    "fails, grey cannot be said within the tolerances; the pose where the band reaches furthest over the line decides."
)
_COLOURS = {"pass": GOOD, "fail": BAD, "undecided": GREY}
_AXES = {
    "frequency": "frequency [Hz]",
    "platform_frequency": "frequency [Hz]",
    "tension": "tension [N]",
    "strain": "strain [-]",
    "position_error": "error [m]",
    "rotation_error": "error [deg]",
}


def size(result: Mapping[str, Any]) -> tuple[float, float]:
    """Of the figure [inch]."""
    return 8.6, 0.6 + 1.9 * len(result["requirements"])


def draw_limits(figure: Figure, result: Mapping[str, Any]) -> None:
    """A panel for each requirement, poses in their order."""
    rows = result["requirements"]
    panels = figure.subplots(len(rows), 1, sharex=True, squeeze=False)[:, 0]
    for axes, row in zip(panels, rows, strict=True):
        _panel(axes, row)
    panels[-1].set_xlabel("pose [count]")
    panels[-1].xaxis.set_major_locator(MaxNLocator(integer=True))


def _panel(axes: Axes, row: Mapping[str, Any]) -> None:
    found = row["at_poses"]
    number = np.arange(1, len(found) + 1)
    value = np.array([at["value"] for at in found], dtype=float)
    ends = np.array([at["band"] for at in found], dtype=float)
    colour = _COLOURS[row["verdict"]]
    axes.vlines(number, ends[:, 0], ends[:, 1], color=colour, linewidth=2.0 if len(found) < 60 else 0.8)
    axes.plot(number, value, ".", color=colour, markersize=5 if len(found) < 60 else 2)
    axes.axhline(row["limit"], color=BLACK, linewidth=1.0)
    axes.set_title(f"{row['name']}: {row['words']}", fontsize=8.5, loc="left")
    axes.set_ylabel(_AXES[row["quantity"]])
    quiet(axes)

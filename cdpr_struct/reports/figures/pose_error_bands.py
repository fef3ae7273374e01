"""The parts of a pose error, each with its band."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.style import BLUE, GREY, ORANGE, quiet

SIZE = (9.0, 3.3)
_PANELS = {
    "whole error [mm]": ("global_x_mm", "global_y_mm", "global_z_mm", "global_mm"),
    "from stretch [mm]": ("axial_x_mm", "axial_y_mm", "axial_z_mm", "axial_mm"),
    "from sag [mm]": ("sag_x_mm", "sag_y_mm", "sag_z_mm", "sag_mm"),
    "turn [°]": ("global_rx_deg", "global_ry_deg", "global_rz_deg", "global_turn_deg"),
}
_BESIDE = 0.16  # of the distance of two numbers, by which drawn robots stand beside


def caption(bands: Mapping[str, Any]) -> str:
    """What is to be seen."""
    said = (
        f"Dots: the pose error of the robot as entered. Blue: {bands['level']:g} % of robots within the tolerances lie "
        "inside, each number by itself. A band that reaches over zero leaves the direction of the error open."
    )
    return said + (" Orange: robots drawn within the tolerances, solved anew." if "samples" in bands else "")


def draw_bands(figure: Figure, bands: Mapping[str, Any]) -> None:
    """A panel each for the error, its parts and the turn; x, y, z and the size in each."""
    panels = figure.subplots(1, len(_PANELS))
    for axes, (label, names) in zip(panels, _PANELS.items(), strict=True):
        _panel(axes, [bands["errors"][name] for name in names])
        axes.set_ylabel(label)
        turns = label.startswith("turn")
        axes.set_xticks(range(4), ["rx", "ry", "rz", "size"] if turns else ["x", "y", "z", "size"])
    panels[0].legend(fontsize=8.0, loc="best")


def _panel(axes: Axes, rows: list[Mapping[str, Any]]) -> None:
    place = np.arange(len(rows))
    ends = np.array([row["band"] for row in rows], dtype=float)
    axes.axhline(0.0, color=GREY, linewidth=0.7)
    axes.vlines(place, ends[:, 0], ends[:, 1], color=BLUE, linewidth=4.0, alpha=0.6, label="band")
    if "drawn" in rows[0]:
        drawn = np.array([row["drawn"] for row in rows], dtype=float)
        axes.vlines(place + _BESIDE, drawn[:, 0], drawn[:, 1], color=ORANGE, linewidth=2.0, label="drawn robots")
    axes.plot(place, [row["value"] for row in rows], "o", color=BLUE, markersize=5, label="as entered")
    axes.set_xlim(-0.6, len(rows) - 0.4)
    quiet(axes, "y")

"""Frames of several robots from above, to one scale."""

from collections.abc import Sequence
from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.frame_plan import outline
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION
from cdpr_struct.robot.robot import Robot

SIZE = (9.6, 5.6)
_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK)


def draw_footprints(figure: Figure, robots: Sequence[Robot]) -> None:
    """Outline of the frame anchors in the plane of x and y, and the anchors; robots with the same ones share them."""
    axes = figure.subplots()
    alike: dict[bytes, list[Robot]] = {}
    for robot in robots:
        alike.setdefault(np.round(robot.frame_anchors[:, :2], 6).tobytes(), []).append(robot)
    for colour, group in zip(cycle(_COLOURS), alike.values(), strict=False):
        anchors = group[0].frame_anchors[:, :2]
        label = ", ".join(robot.name for robot in group)
        axes.plot(*outline(anchors).T, color=colour, linewidth=1.3, label=label)
        axes.plot(*anchors.T, "o", color=colour, markersize=4)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)

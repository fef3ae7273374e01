"""A workspace in slices: what rejects each pose, and the boundary of what all requirements leave."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from cdpr_struct.reports.figures.panels import label_ends
from cdpr_struct.reports.figures.plot_parts import Plot, short
from cdpr_struct.reports.figures.solid_scene import anchor_labels, solid_scene
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY, LIGHT
from cdpr_struct.reports.figures.workspace_map import LINE_SIZE, map_size
from cdpr_struct.reports.figures.workspace_slices import Slices
from cdpr_struct.reports.typeset import typeset
from cdpr_struct.robot.robot import Robot
from cdpr_struct.workspace.grid import AXES, Grid
from cdpr_struct.workspace.region import Region

_HOLDS = "#8fd0a5"
_WHY = (LIGHT, GREY, "#f2c14e", "#e07a5f", "#7aa6d6", "#b48ead", "#9c6b4f", "#d98cb3", "#c9c25a", "#6fa8a0")
_WIDTH, _COLUMNS, _MOST = 9.6, 3, 9
_POINTS = 60_000  # of the surface on a page
_MARGIN = 0.04  # around it, of the largest edge


def region_size(grid: Grid) -> tuple[float, float]:
    """Size of the figure [inch]."""
    if len(grid.free) < 3:
        return LINE_SIZE if len(grid.free) < 2 else map_size(grid)
    slices = Slices.of(grid, _MOST)
    return _WIDTH, _height(slices, _WIDTH, _COLUMNS)


def _height(slices: Slices, width: float, columns: int) -> float:
    """Of a figure so wide with so many slices beside each other [inch]."""
    across, up = (float(np.ptp(slices.grid.axes[i])) for i in range(3) if i != slices.axis)
    rows = -(-len(slices.index) // columns)
    return 1.0 + rows * (0.45 + 0.9 * width / columns * float(np.clip(up / across, 0.2, 2.0)))


def draw_region(figure: Figure, grid: Grid, why: np.ndarray, names: list[str], region: Region) -> None:
    """why : (n,) number in `names` of what rejects each pose, 0 where nothing does."""
    if len(grid.free) == 3:
        slices = Slices.of(grid, _MOST)
        rows = -(-len(slices.index) // _COLUMNS)
        panels = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False).ravel().tolist()
        figure.set_figheight(_height(slices, figure.get_figwidth(), panels[0].get_subplotspec().get_gridspec().ncols))
        for axes in panels[len(slices.index) :]:
            axes.remove()
        for axes, index in zip(panels, slices.index.tolist(), strict=False):
            _draw_slice(axes, grid, why, region, slices.axis, index)
            axes.set_title(f"{AXES[slices.axis]} = {grid.axes[slices.axis][index]:g} m")
        across, up = (i for i in range(3) if i != slices.axis)
        label_ends(panels[: len(slices.index)], f"{AXES[up]} [m]", f"{AXES[across]} [m]")
    else:
        axis = next(i for i in (2, 1, 0) if i not in grid.free)
        _draw_slice(figure.subplots(), grid, why, region, axis, 0)
    used = np.unique(why).tolist()
    handles: list[Any] = [Patch(facecolor=_colour(i), edgecolor=GREY, label=_label(names[i])) for i in used]
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(used), 4))


def _label(name: str) -> str:
    return {"held": "not held", "stable": "not stable"}.get(name, typeset(name))


def _colour(number: int) -> str:
    return _HOLDS if number == 0 else _WHY[(number - 1) % len(_WHY)]


def _draw_slice(axes: Axes, grid: Grid, why: np.ndarray, region: Region, axis: int, index: int) -> None:
    """One slice across an axis at a position of the grid; a single row where the grid has one axis."""
    across, up = (i for i in range(3) if i != axis)
    if len(grid.free) == 1 and up in grid.free:
        across, up = up, across
    part = np.take(why.reshape(grid.shape), index, axis=axis)
    part = part if across < up else part.T
    count = int(why.max()) + 1
    colours = ListedColormap([_colour(i) for i in range(count)])
    x, y = grid.axes[across], grid.axes[up]
    axes.grid(False)
    axes.pcolormesh(x, y, part.T, cmap=colours, vmin=-0.5, vmax=count - 0.5, shading="nearest", rasterized=True)
    axes.set_xlabel(f"{AXES[across]} [m]")
    if len(grid.free) == 1:
        axes.set_yticks([])
        return
    axes.set_ylabel(f"{AXES[up]} [m]")
    axes.set_aspect("equal")
    fine, step = region.grid, len(region.levels) - 1
    place = index * 2**step if axis in grid.free else 0
    holds = np.take(region.holds.reshape(fine.shape), place, axis=axis).astype(float)
    if 0.0 < holds.mean() < 1.0:
        axes.contour(fine.axes[across], fine.axes[up], holds.T, levels=[0.5], colors=BLACK, linewidths=1.0)


def surface(robot: Robot, region: Region) -> Plot:
    """The surface of the workspace between the frame anchors, as a scene to be turned."""
    shown = region
    while shown.grid.size > _POINTS and shown.coarser is not None:
        shown = shown.coarser
    place, anchors = shown.grid.positions, robot.frame_anchors
    solid = {
        "type": "isosurface", **_xyz(place), "value": shown.holds.astype(int).tolist(), "isomin": 0.5, "isomax": 1.0,
        "surface": {"count": 1}, "showscale": False, "colorscale": [[0, BLUE], [1, BLUE]], "opacity": 0.55,
        "caps": {axis: {"show": True} for axis in AXES}, "hoverinfo": "skip", "name": "workspace",
    }  # fmt: skip
    box = _box(np.concatenate([place, anchors]))
    marks = {
        "type": "scatter3d", "mode": "markers+text", **_xyz(anchors), "name": "frame anchors", "hoverinfo": "text",
        "text": anchor_labels(anchors, box), "marker": {"color": BLACK, "size": 3},
        "hovertext": [f"frame anchor of cable {i + 1}" for i in range(len(anchors))],
    }  # fmt: skip
    scene = solid_scene(box)
    scene["layout"]["showlegend"] = False
    return {"data": [solid, marks], **scene}


def _box(points: np.ndarray) -> np.ndarray:
    """(2, 3) corners of what is shown, with a margin [m]."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * float((high - low).max())
    return np.array([low - margin, high + margin])


def _xyz(points: np.ndarray) -> dict[str, list[Any]]:
    return {axis: short(points[:, i]) for i, axis in enumerate(AXES)}

"""A quantity over a grid of poses: a heat map over two axes, a curve over one."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from cdpr_struct.reports.figures.frame_plan import FramePlan, draw_plan
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY, LIGHT, ON_MAP
from cdpr_struct.workspace.grid import AXES, Grid

WIDTH, HIGHEST = 9.6, 5.8
LINE_SIZE = (9.6, 3.8)
UNHELD = "cannot be held, or not stable"
OTHER = "spring model: another pose is more stable"
_HATCH = "////"
_EQUAL = 1e-6  # relative: values whose differences mean nothing
_BELOW, _ABOVE = 0.8, 1.2  # of the one value of a constant map: ends of its scale
Scale = tuple[Normalize, Colormap]


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """What one panel shows.

    title, unit : heading and colour bar
    values      : (n,) over the grid; nan is hatched
    marked      : (n,) bool, poses that carry a mark
    signed      : zero means something: above it is red, below it blue
    mark        : what the marks say
    """

    title: str
    unit: str
    values: np.ndarray
    marked: np.ndarray
    signed: bool = False
    mark: str = OTHER


def drawable(grid: Grid) -> bool:
    """Whether there is an axis to draw over; a single pose has none."""
    return len(grid.free) > 0


def map_size(grid: Grid) -> tuple[float, float]:
    """Size of a figure of one quantity over one or two axes [inch]: a heat map as high as its axes ask."""
    if len(grid.free) < 2:
        return LINE_SIZE
    across, up = (float(np.ptp(grid.axes[i])) for i in grid.free)
    return WIDTH, float(np.clip(1.1 + 7.2 * up / across, 2.4, HIGHEST))


def draw_map(figure: Figure, grid: Grid, layer: Layer, plan: FramePlan) -> None:
    """One quantity over one or two axes of the grid; beside a map, where it lies in the frame."""
    if len(grid.free) == 2:
        axes, beside = figure.subplots(1, 2, width_ratios=[3.2, 1.0])
        draw_heat(figure, axes, grid, layer)
        draw_plan(beside, plan, grid, *grid.free)
    else:
        axes = figure.subplots()
        draw_line(axes, grid, layer, BLUE)
        hatch_gaps(axes, grid, layer.values)
        axes.set_ylabel(f"{layer.title} [{layer.unit}]")
    add_legend(figure, [layer])


def draw_heat(figure: Figure, axes: Axes, grid: Grid, layer: Layer, levels: int = 8) -> None:
    """A heat map with about so many level lines and a colour bar of its own."""
    image = paint_heat(axes, grid, layer, colour_scale(layer), levels)
    add_bar(figure, image, [axes], layer.unit)


def paint_heat(axes: Axes, grid: Grid, layer: Layer, scale: Scale, levels: int | np.ndarray) -> QuadMesh:
    """A heat map over the two free axes; poses without a value are hatched.

    levels : about how many level lines, or their values
    """
    across, up = grid.free
    shape = (grid.shape[across], grid.shape[up])
    x, y, value = grid.axes[across], grid.axes[up], layer.values.reshape(shape).T
    axes.grid(False)
    axes.set_facecolor(LIGHT)
    axes.patch.set(hatch=_HATCH, edgecolor=GREY, linewidth=0)
    image = axes.pcolormesh(
        x, y, np.ma.masked_invalid(value), norm=scale[0], cmap=scale[1], shading="nearest", rasterized=True
    )
    _levels(axes, x, y, value, levels)
    if layer.marked.any():
        place = grid.positions[layer.marked]
        edge: Any = {"markeredgecolor": "white", "markeredgewidth": 0.4}
        axes.plot(place[:, across], place[:, up], "^", color=ON_MAP, markersize=3, **edge)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{AXES[across]} [m]")
    axes.set_ylabel(f"{AXES[up]} [m]")
    axes.set_title(layer.title)
    return image


def add_bar(figure: Figure, image: QuadMesh, beside: Sequence[Axes], unit: str) -> None:
    """A colour bar with its unit on top, for one panel or for several."""
    bar = figure.colorbar(image, ax=list(beside), shrink=0.85 if len(beside) == 1 else 0.6)
    bar.ax.set_title(f"[{unit}]", fontsize=8, fontweight="normal", loc="left")
    bar.outline.set_visible(False)


def draw_line(axes: Axes, grid: Grid, layer: Layer, colour: str, label: str = "") -> None:
    """A curve over the one free axis; gaps where there is no value."""
    (free,) = grid.free
    axes.plot(grid.axes[free], layer.values, color=colour, linewidth=1.6, label=label or None)
    if layer.marked.any():
        axes.plot(grid.axes[free][layer.marked], layer.values[layer.marked], "^", color=BLACK, markersize=4)
    axes.set_xlabel(f"{AXES[free]} [m]")


def hatch_gaps(axes: Axes, grid: Grid, values: np.ndarray) -> None:
    """Hatch what lies between the poses of a curve that have a value and those that have none."""
    (free,) = grid.free
    x, missing = grid.axes[free], np.isnan(values)
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    starts = np.flatnonzero(missing & ~np.concatenate([[False], missing[:-1]]))
    ends = np.flatnonzero(missing & ~np.concatenate([missing[1:], [False]]))
    for start, end in zip(starts, ends, strict=True):
        axes.axvspan(edges[start], edges[end + 1], facecolor=LIGHT, edgecolor=GREY, hatch=_HATCH, linewidth=0, zorder=0)
    axes.set_xlim(x[0], x[-1])


def legend_handles(layers: list[Layer]) -> list[Patch | Line2D]:
    """Legend entries for what is hatched and marked, if anything is."""
    handles: list[Patch | Line2D] = []
    if any(np.isnan(layer.values).any() for layer in layers):
        handles.append(Patch(facecolor=LIGHT, edgecolor=GREY, hatch=_HATCH, linewidth=0, label=UNHELD))
    for mark in dict.fromkeys(layer.mark for layer in layers if layer.marked.any()):
        handles.append(Line2D([], [], color=BLACK, marker="^", markersize=4, linestyle="none", label=mark))
    return handles


def add_legend(figure: Figure, layers: list[Layer]) -> None:
    """Say below the figure what is hatched and marked, if anything is."""
    handles = legend_handles(layers)
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=2)


def colour_scale(layer: Layer) -> Scale:
    """Diverging about zero where signs mix; else from light to dark with growing size.

    One value everywhere has a range about it, or from 0 to 1 if it is zero.
    """
    value = layer.values
    if not np.isfinite(value).any():
        return Normalize(0.0, 1.0), _light("YlGnBu")
    low, high = float(np.nanmin(value)), float(np.nanmax(value))
    if not np.any(value[np.isfinite(value)]):
        return Normalize(0.0, 1.0), _light("YlGnBu")
    if high - low < _EQUAL * max(abs(low), abs(high)):
        low, high = sorted((_BELOW * low, _ABOVE * high))
    margin = _EQUAL * max(abs(low), abs(high))
    if layer.signed and low < -margin and high > margin:
        reach = max(-low, high)
        return Normalize(-reach, reach), _light("RdBu_r", 0.1, 0.9)
    below = layer.signed and high <= margin
    name = "YlGnBu" if below or not layer.signed else "YlOrRd"
    colours = _light(name)
    return Normalize(low - margin, high + margin), colours.reversed() if below else colours


def _light(name: str, low: float = 0.0, high: float = 0.7) -> Colormap:
    """Part of a colour map on which black lines can be read."""
    return ListedColormap(colormaps[name](np.linspace(low, high, 256)))


def _levels(axes: Axes, x: np.ndarray, y: np.ndarray, value: np.ndarray, levels: int | np.ndarray) -> None:
    finite = value[np.isfinite(value)]
    if finite.size < 9 or np.ptp(finite) < _EQUAL * np.abs(finite).max() or not np.size(levels):
        return
    field = np.ma.masked_invalid(value)
    lines = axes.contour(x, y, field, levels=levels, colors=ON_MAP, linewidths=0.5, linestyles="solid", alpha=0.7)
    axes.clabel(lines, fontsize=6.5, fmt=lambda level: f"{level:.4g}")

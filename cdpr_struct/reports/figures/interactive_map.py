"""Maps of the workspace that can be zoomed, with a slider through the slices of a third axis."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle

import numpy as np
from contourpy import contour_generator

from cdpr_struct.reports.figures.frame_plan import FramePlan
from cdpr_struct.reports.figures.plot_parts import Plot, colour_bar, plot_axis, plot_layout, plot_line, short
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY, LIGHT, ON_MAP, VERMILLION
from cdpr_struct.reports.figures.workspace_map import Layer, colour_scale
from cdpr_struct.reports.figures.workspace_slices import Slices, shared_levels
from cdpr_struct.workspace.grid import AXES, Grid

_HEIGHT = 660
_MOST = 200
_SHADES = 24
_NAMED = 0.15  # length of a level line from which on it carries its value, of the map's width and height


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """What the map shows at one step of its slider.

    label : of the step
    grid  : over two axes
    of    : the whole that gives the colour scale, so that slices share it
    """

    label: str
    grid: Grid
    layer: Layer
    of: Layer


def scenes(grid: Grid, layers: Sequence[Layer]) -> list[Scene]:
    """A step for each layer, and for each slice of a third axis."""
    if len(grid.free) == 2:
        return [Scene(layer.title, grid, layer, layer) for layer in layers]
    slices = Slices.of(grid, _MOST)
    return [
        Scene(
            f"{layer.title}, {slices.layer_at(layer, i).title}" if len(layers) > 1 else slices.layer_at(layer, i).title,
            slices.grid_at(i), slices.layer_at(layer, i), layer,
        )
        for layer in layers
        for i in slices.index.tolist()
    ]  # fmt: skip


def map_plot(grid: Grid, layers: Sequence[Layer], plan: FramePlan) -> Plot:
    """Quantities over one to three axes of the grid, with a slider if there is more than one map."""
    if len(grid.free) == 1:
        return _curves(grid, layers)
    steps = scenes(grid, layers)
    across, up = steps[0].grid.free
    first = 0 if len(grid.free) == 2 else len(steps) // len(layers) // 2
    heats = [
        {**trace, "visible": i == first}
        for i, scene in enumerate(steps)
        for trace in (_heat(scene, across, up), _levels(scene, across, up))
    ]
    frame = _frame(plan, grid, across, up)
    x, y = grid.axes[across], grid.axes[up]
    layout = {
        **plot_layout(_HEIGHT),
        "margin": {"l": 64, "r": 16, "t": 56, "b": 48 if len(steps) == 1 else 110},
        "xaxis": {**plot_axis(f"{AXES[across]} [m]"), "range": _reach(x), "constrain": "domain", "showgrid": False},
        "yaxis": {
            **plot_axis(f"{AXES[up]} [m]"), "range": _reach(y), "scaleanchor": "x", "constrain": "domain",
            "showgrid": False,
        },
        "updatemenus": [_views((x, y), plan, across, up)],
        "showlegend": False,
    }  # fmt: skip
    if len(steps) > 1:
        layout["sliders"] = [_slider([scene.label for scene in steps], len(frame), first)]
    return {"data": [*heats, *frame], "layout": layout}


def _heat(scene: Scene, across: int, up: int) -> Plot:
    grid, layer = scene.grid, scene.layer
    scale, colours = colour_scale(scene.of)
    value = layer.values.reshape(grid.shape[across], grid.shape[up]).T
    names = f"{AXES[across]} %{{x:.4g}} m, {AXES[up]} %{{y:.4g}} m"
    shades = colours(np.linspace(0.0, 1.0, _SHADES))[:, :3]
    steps = [
        [i / (_SHADES - 1), "rgb({:.0f},{:.0f},{:.0f})".format(*(255.0 * shade))] for i, shade in enumerate(shades)
    ]
    bar = colour_bar(f"{scene.of.title} [{layer.unit}]")
    if layer.unit == "count":
        bar["dtick"] = max(1, round(float((scale.vmax or 0.0) - (scale.vmin or 0.0)) / 5.0))
    return {
        "type": "heatmap", "name": layer.title, "x": short(grid.axes[across]), "y": short(grid.axes[up]),
        "z": short(value), "zmin": float(scale.vmin or 0.0), "zmax": float(scale.vmax or 0.0), "colorscale": steps,
        "colorbar": bar, "hoverongaps": False,
        "hovertemplate": f"{names}<br>%{{z:.5g}} {layer.unit}<extra></extra>",
    }  # fmt: skip


def _levels(scene: Scene, across: int, up: int) -> Plot:
    """Lines of equal value with their values, the same in all slices; only between poses that all have one."""
    grid = scene.grid
    value = scene.layer.values.reshape(grid.shape[across], grid.shape[up]).T
    x, y = grid.axes[across], grid.axes[up]
    lines = contour_generator(x, y, np.ma.masked_invalid(value))
    wide = np.array([np.ptp(x), np.ptp(y)])
    places, words = [np.empty((0, 2))], list[str]()
    for level in shared_levels(scene.of).tolist():
        for line in lines.lines(level):
            points = np.asarray(line)
            named = float(np.linalg.norm(np.diff(points, axis=0) / wide, axis=1).sum()) > _NAMED
            middle = len(points) // 2
            words += [f"{level:.4g}" if named and i == middle else "" for i in range(len(points))] + [""]
            places += [points, np.full((1, 2), np.nan)]
    found = np.concatenate(places)
    return {
        "type": "scatter", "mode": "lines+text", "x": short(found[:, 0]), "y": short(found[:, 1]), "text": words,
        "textposition": "top center", "textfont": {"size": 11, "color": ON_MAP}, "hoverinfo": "skip",
        "line": {"color": ON_MAP, "width": 1}, "opacity": 0.75, "cliponaxis": True,
    }  # fmt: skip


def _frame(plan: FramePlan, grid: Grid, across: int, up: int) -> list[Plot]:
    """The mapped rectangle, frame anchors with their numbers, the outline around them, and the platform."""
    outline, platform = plan.frame_outline(across, up), plan.platform_outline(across, up)
    anchors = plan.anchors[:, (across, up)]
    frame = plot_line(outline[:, 0], outline[:, 1], "frame", {"color": GREY, "width": 1.5}, "frame")
    body = plot_line(platform[:, 0], platform[:, 1], "platform", {"color": BLACK, "width": 2}, "platform")
    marks = {
        "type": "scatter", "mode": "markers+text", "name": "frame anchors", "x": short(anchors[:, 0]),
        "y": short(anchors[:, 1]), "text": [str(i + 1) for i in range(len(anchors))], "textposition": "top center",
        "marker": {"color": BLACK, "size": 7},
        "hovertemplate": "frame anchor of cable %{text}<br>(%{x:.3f}, %{y:.3f}) m<extra></extra>",
    }  # fmt: skip
    x, y = (grid.axes[i][[0, -1]] for i in (across, up))
    mapped = plot_line(x[[0, 1, 1, 0, 0]], y[[0, 0, 1, 1, 0]], "mapped", {"color": BLUE, "width": 1.5}, "mapped")
    return [mapped, frame, body, marks]


def _reach(values: np.ndarray) -> list[float]:
    """Ends of an axis: half a step beyond the poses."""
    return [float(1.5 * values[0] - 0.5 * values[1]), float(1.5 * values[-1] - 0.5 * values[-2])]


def _views(axes: tuple[np.ndarray, np.ndarray], plan: FramePlan, across: int, up: int) -> Plot:
    """Buttons: the map alone, or the map in the whole frame."""
    frame = plan.frame_outline(across, up)
    margin = 0.06 * float(np.ptp(frame, axis=0).max())
    whole = [
        [float(min(frame[:, i].min(), axis[0]) - margin), float(max(frame[:, i].max(), axis[-1]) + margin)]
        for i, axis in enumerate(axes)
    ]
    near = [_reach(axis) for axis in axes]
    buttons = [
        {"label": label, "method": "relayout", "args": [{"xaxis.range": x, "yaxis.range": y}]}
        for label, (x, y) in (("map", near), ("whole frame", whole))
    ]
    return {
        "type": "buttons", "direction": "right", "showactive": False, "buttons": buttons, "x": 0.0, "xanchor": "left",
        "y": 1.02, "yanchor": "bottom", "bgcolor": "white", "bordercolor": LIGHT, "font": {"color": BLUE},
        "pad": {"t": 0, "b": 0},
    }  # fmt: skip


def _slider(labels: Sequence[str], more: int, first: int) -> Plot:
    count = len(labels)
    steps = [
        {
            "label": label, "method": "restyle",
            "args": [{"visible": [*(i == j for j in range(count) for _ in range(2)), *[True] * more]}],
        }
        for i, label in enumerate(labels)
    ]  # fmt: skip
    return {
        "active": first, "steps": steps, "currentvalue": {"font": {"size": 14, "color": BLACK}}, "pad": {"t": 44},
        "bordercolor": LIGHT, "bgcolor": LIGHT, "tickcolor": GREY, "ticklen": 4,
        "font": {"color": "rgba(0,0,0,0)", "size": 1},
    }  # fmt: skip


def _curves(grid: Grid, layers: Sequence[Layer]) -> Plot:
    (free,) = grid.free
    curves = [
        plot_line(
            grid.axes[free], layer.values, layer.title, {"color": colour, "width": 2},
            f"{AXES[free]} %{{x:.4g}} m: %{{y:.5g}} {layer.unit}",
        )
        for layer, colour in zip(layers, cycle((BLUE, VERMILLION, BLACK)), strict=False)
    ]  # fmt: skip
    name = layers[0].title if len(layers) == 1 else "value"
    layout = {
        **plot_layout(420),
        "xaxis": plot_axis(f"{AXES[free]} [m]"),
        "yaxis": plot_axis(f"{name} [{layers[0].unit}]"),
        "showlegend": len(layers) > 1,
    }
    return {"data": curves, "layout": layout}

"""A quantity over three axes: slices at several values of one axis, drawn side by side on one colour scale."""

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.reports.figures.frame_plan import FramePlan, draw_plan
from cdpr_struct.reports.figures.panels import label_ends
from cdpr_struct.reports.figures.workspace_map import Layer, add_bar, add_legend, colour_scale, paint_heat
from cdpr_struct.workspace.grid import AXES, Grid

MOST = 12
_WIDTH = 9.6
_LEVELS = 5


@dataclass(frozen=True, slots=True, eq=False)
class Slices:
    """Which slices of a grid over three axes are drawn.

    axis  : number of the axis with the fewest positions (the last of several); each slice is at one of them
    index : (k,) positions that are shown, both ends among them
    """

    grid: Grid
    axis: int
    index: np.ndarray

    @classmethod
    def of(cls, grid: Grid, most: int = MOST) -> "Slices":
        """At most so many slices, both ends among them: evenly spaced if half as many can be, else nearly so."""
        axis = min((2, 1, 0), key=lambda i: grid.shape[i])
        last = grid.shape[axis] - 1
        even = [count for count in range(most, most // 2 - 1, -1) if count > 1 and last % (count - 1) == 0]
        count = last + 1 if last < most else even[0] if even else most
        return cls(grid, axis, np.linspace(0, last, count).round().astype(int))

    @property
    def values(self) -> np.ndarray:
        """(k,) where the slices are along the axis [m]."""
        return self.grid.axes[self.axis][self.index]

    def grid_at(self, index: int) -> Grid:
        """The grid of one slice."""
        return replace(self.grid, **{AXES[self.axis]: self.grid.axes[self.axis][[index]]})

    def layer_at(self, layer: Layer, index: int) -> Layer:
        """Values and marks of one slice, its place as the title."""
        title = f"{AXES[self.axis]} = {self.grid.axes[self.axis][index]:g} m"
        return replace(layer, title=title, values=self._cut(layer.values, index), marked=self._cut(layer.marked, index))

    def _cut(self, values: np.ndarray, index: int) -> np.ndarray:
        return np.take(values.reshape(self.grid.shape), index, axis=self.axis).ravel()

    def said(self) -> str:
        """Which slices are shown, in words."""
        name, count = AXES[self.axis], self.grid.shape[self.axis]
        ends = f"{name} = {self.values[0]:g} to {self.values[-1]:g} m"
        if len(self.index) == count:
            return f"One slice for each of the {count} values of {name}, {ends}; all on one colour scale."
        shown = ", ".join(f"{value:g}" for value in self.values)
        return f"{len(self.index)} of {count} slices, at {name} = {shown} m; all on one colour scale."


def slices_size(grid: Grid) -> tuple[float, float]:
    """Size of the figure of one quantity [inch]."""
    slices = Slices.of(grid)
    rows, columns = _arrangement(slices)
    return _WIDTH, 0.9 + rows * (0.35 + 0.87 * _WIDTH / columns * _slope(slices))


def _slope(slices: Slices) -> float:
    """Height of a slice over its width, within what can be drawn."""
    across, up = (float(np.ptp(axis)) for axis in _plane(slices))
    return float(np.clip(up / across, 0.2, 3.0))


def _plane(slices: Slices) -> list[np.ndarray]:
    return [slices.grid.axes[i] for i in range(3) if i != slices.axis]


def _arrangement(slices: Slices) -> tuple[int, int]:
    """Rows and columns of panels: fewer columns for wide slices, and few empty places."""
    count = len(slices.index) + 1  # the plan of the frame
    fewest = 2 if _slope(slices) < 0.5 else 3
    columns = min(range(min(count, fewest), fewest + 2), key=lambda n: -count % n)
    return -(-count // columns), columns


def draw_slices(figure: Figure, grid: Grid, layer: Layer, plan: FramePlan) -> None:
    """Small multiples of one quantity; in the last place, where they lie in the frame."""
    slices = Slices.of(grid)
    rows, columns = _arrangement(slices)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel().tolist()
    scale, levels, count = colour_scale(layer), shared_levels(layer), len(slices.index)
    for axes, index in zip(panels, slices.index.tolist(), strict=False):
        image = paint_heat(axes, slices.grid_at(index), slices.layer_at(layer, index), scale, levels)
    free = [panels[place].get_subplotspec() for place in range(count, len(panels))]
    for spare in panels[count:]:
        spare.remove()
    across, up = (i for i in range(3) if i != slices.axis)
    label_ends(panels[:count], f"{AXES[up]} [m]", f"{AXES[across]} [m]")
    draw_plan(figure.add_subplot(free[0]), plan, grid, across, up)
    add_bar(figure, image, panels[:count], layer.unit)
    add_legend(figure, [layer])


def shared_levels(layer: Layer) -> np.ndarray:
    """Values of the level lines, the same in all slices; none where nothing varies."""
    finite = layer.values[np.isfinite(layer.values)]
    if not finite.size or np.ptp(finite) < 1e-6 * np.abs(finite).max():
        return np.empty(0)
    return np.asarray(MaxNLocator(_LEVELS).tick_values(float(finite.min()), float(finite.max())))

"""Static pose error over the workspace, and over the load (thesis figs 3.4-3.7 and 4.4)."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.frame_plan import FramePlan, draw_plan
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, VERMILLION, plain_ticks
from cdpr_struct.reports.figures.workspace_map import (
    Layer,
    add_legend,
    colour_scale,
    draw_heat,
    draw_line,
    hatch_gaps,
    paint_heat,
)
from cdpr_struct.reports.figures.workspace_slices import Slices, shared_levels
from cdpr_struct.statics.sufficient_load import SufficientLoad
from cdpr_struct.workspace.pose_error_map import PoseErrorMap

LOAD_SIZE = (9.6, 4.2)
_MOST_SLICES = 6  # rows of three panels that still fit on a page
_TITLES = {"global": "a) global", "sag": "b) from sag", "axial": "c) from stretch"}
_COLOURS = {"global": VERMILLION, "sag": BLUE, "axial": BLACK}


def pose_error_size(errors: PoseErrorMap) -> tuple[float, float]:
    """Size of the figure [inch]: maps as high as their axes ask, one row a slice, or one plot of three curves."""
    free = len(errors.grid.free)
    if free < 2:
        return (9.6, 4.0)
    slices = Slices.of(errors.grid, _MOST_SLICES) if free == 3 else None
    across, up = (np.ptp(errors.grid.axes[i]) for i in errors.grid.free if slices is None or i != slices.axis)
    if slices is not None:
        return (9.6, 1.3 + len(slices.index) * float(np.clip(0.4 + 2.6 * up / across, 0.8, 4.2)))
    return (9.6, float(np.clip(1.3 + 2.4 * up / across, 2.2, 9.0)))


def draw_pose_error(figure: Figure, errors: PoseErrorMap, plan: FramePlan | None = None) -> None:
    """Error along z: global, from sag, from stretch; beside maps over two axes, where they lie in the frame."""
    layers = error_layers(errors)
    if len(errors.grid.free) == 2:
        _draw_maps(figure, errors, layers, plan)
    else:
        draw = _draw_curves if len(errors.grid.free) == 1 else _draw_slices
        draw(figure, errors, layers)
    add_legend(figure, list(layers.values()))


def error_layers(errors: PoseErrorMap) -> dict[str, Layer]:
    """Error along z of each part."""
    return {
        part: Layer(title, "mm", errors.vertical(part), errors.more_stable, signed=True)
        for part, title in _TITLES.items()
    }


def _draw_curves(figure: Figure, errors: PoseErrorMap, layers: Mapping[str, Layer]) -> None:
    axes = figure.subplots()
    for part, layer in layers.items():
        draw_line(axes, errors.grid, layer, _COLOURS[part], layer.title)
    hatch_gaps(axes, errors.grid, errors.vertical("global"))
    axes.set_ylabel("pose error along z [mm]")
    axes.legend()


def _draw_maps(figure: Figure, errors: PoseErrorMap, layers: Mapping[str, Layer], plan: FramePlan | None) -> None:
    panels = figure.subplots(1, 3 if plan is None else 4, width_ratios=[1.0] * 3 + [0.8] * (plan is not None))
    for axes, layer in zip(panels[:3], layers.values(), strict=True):
        draw_heat(figure, axes, errors.grid, layer, 5)
        if axes is not panels[0]:
            axes.sharey(panels[0])
        axes.label_outer()
    if plan is not None:
        draw_plan(panels[3], plan, errors.grid, *errors.grid.free)


def _draw_slices(figure: Figure, errors: PoseErrorMap, layers: Mapping[str, Layer]) -> None:
    """One row a slice, one column a part, and below each column its colour scale."""
    slices = Slices.of(errors.grid, _MOST_SLICES)
    panels = figure.subplots(len(slices.index), 3, sharex="col", sharey="row", squeeze=False)
    for column, layer in zip(panels.T, layers.values(), strict=True):
        scale, levels = colour_scale(layer), shared_levels(layer)
        for axes, index in zip(column, slices.index.tolist(), strict=True):
            piece = slices.layer_at(layer, index)
            image = paint_heat(axes, slices.grid_at(index), piece, scale, levels)
            axes.set_title(f"{layer.title}\n{piece.title}" if axes is column[0] else piece.title)
            axes.label_outer()
        bar = figure.colorbar(
            image, ax=list(column), location="bottom", shrink=0.9, aspect=30, fraction=0.03, label="[mm]"
        )
        bar.outline.set_visible(False)


def pose_error_caption(errors: PoseErrorMap, live: bool = False) -> str:
    """What to see in the figure; live : in the one that can be zoomed, with one map or slice at a time."""
    means = ", ".join(f"{errors.mean(part):+.2f} mm {what}" for part, what in _MEANING.items())
    worst, (x, y, z) = errors.extreme("global")
    left_out = errors.grid.size - int(errors.counts.sum())
    other = int(errors.more_stable.sum())
    where = errors.grid.fixed_text()
    gaps = ("Blank" if len(errors.grid.free) > 1 else "Gaps") if live else "Hatched"
    said = (
        f"Pose error of {errors.robot} along z{', ' + where if where else ''}, {errors.mass:g} kg: cables are given "
        "the lengths of straight, inextensible ones, and the platform hangs where sag and stretch let it. Above zero "
        f"it hangs too high. Mean over {int(errors.counts.sum())} poses: {means}. Largest: {worst:+.2f} mm at "
        f"({x:g}, {y:g}, {z:g}) m. {_layout_text(errors, live)}"
        + (f" {gaps}: {left_out} poses that ideal cables cannot hold or that are not stable." if left_out else "")
    )
    if not other or live:
        return said
    return (
        f"{said} Triangles: {other} poses at which the spring model has another equilibrium of lower energy; shown is "
        "the one that is continuous with the reference pose."
    )


def _layout_text(errors: PoseErrorMap, live: bool) -> str:
    if live and len(errors.grid.free) > 1:
        what = "the part and the slice" if len(errors.grid.free) == 3 else "the part"
        return f"The slider changes {what}. Blue line: the mapped rectangle."
    if len(errors.grid.free) < 3:
        return "Each map has its own scale." if len(errors.grid.free) == 2 else "All curves have one scale."
    return f"{Slices.of(errors.grid, _MOST_SLICES).said()[:-1]} in each column."


_MEANING = {"sag": "from sag", "axial": "from stretch", "global": "together"}


def draw_load_ladder(figure: Figure, found: SufficientLoad) -> None:
    """Vertical pose error over the load; beside it what sag adds, against the tolerance."""
    left, right = figure.subplots(1, 2)
    known = np.isfinite(found.mass)
    far = found.masses <= (max(3.0 * found.mass, 30.0) if known else found.masses[-1])
    shown = far & (found.masses >= 0.15 * found.masses[far][-1])
    mass = found.masses[shown]
    left.plot(mass, 1e3 * found.global_error[shown, 2], color=VERMILLION, linewidth=1.8, label="sagging model")
    left.plot(mass, 1e3 * found.axial_error[shown, 2], color=BLACK, linestyle="-.", label="spring model")
    left.axhline(0.0, color=BLUE, linestyle="--", label="ideal model (reference)")
    left.set_ylabel("pose error along z [mm]")
    left.legend()
    right.loglog(found.masses, 1e3 * np.abs(found.sag_error[:, 2]), color=VERMILLION, linewidth=1.8)
    right.axhline(1e3 * found.tolerance, color=GREEN, linestyle="--")
    right.annotate(f"tolerance {1e3 * found.tolerance:g} mm", (found.masses[0], 1e3 * found.tolerance), (2, 3),
                   textcoords="offset points", color=GREEN)  # fmt: skip
    right.set_ylabel("|sagging minus spring| along z [mm]")
    for axes in (left, right):
        axes.set_xlabel("mass of the platform with its load [kg]")
        if known:
            axes.axvline(found.mass, color=GREEN, linewidth=1.2)
    plain_ticks(right.xaxis)
    plain_ticks(right.yaxis)


def load_ladder_caption(found: SufficientLoad) -> str:
    """What to see in the figure."""
    limit = (
        f"From {found.mass:.4g} kg on the two differ by less than {1e3 * found.tolerance:g} mm."
        if np.isfinite(found.mass)
        else f"They differ by more than {1e3 * found.tolerance:g} mm up to {found.masses[-1]:g} kg."
    )
    return (
        "A load straightens the cables: the sagging model tends to the spring model, whose error grows in "
        f"proportion to the load. {limit} On logarithmic axes: what sag adds."
    )

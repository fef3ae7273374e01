"""Broken limits over a grid of poses, or along a trajectory."""

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.crosscheck.limits_poses import PARAMETERS, PoseAudit
from cdpr_struct.reports.audit_result import WORDS
from cdpr_struct.reports.figures.frame_plan import FramePlan, draw_plan
from cdpr_struct.reports.figures.style import (
    BAD,
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT,
    ORANGE,
    PURPLE,
    SKY,
    plain_ticks,
    quiet,
)
from cdpr_struct.reports.figures.workspace_map import Layer
from cdpr_struct.workspace.grid import AXES, Grid

MAP_SIZE = (9.6, 4.2)
COURSE_SIZE = (9.6, 4.4)
_COLOURS = dict(zip(PARAMETERS, (BLUE, PURPLE, ORANGE, GREEN, SKY), strict=True))


def draw_audit_map(figure: Figure, audit: PoseAudit, grid: Grid) -> None:
    """Number of broken limits, and the cable that is worst off, over the two free axes of the grid."""
    left, right, beside = figure.subplots(1, 3, width_ratios=[1.0, 1.0, 0.72])
    count = np.where(audit.held, audit.count, -1)
    highest = max(int(count.max()), 1)
    colours = np.vstack([[0.86, 0.93, 0.97, 1.0], colormaps["YlOrRd"](np.linspace(0.15, 0.9, highest))])
    image = _heat(left, grid, count, ListedColormap(colours), np.arange(-0.5, highest + 1.0))
    left.set_title("broken limits, all cables")
    bar = figure.colorbar(image, ax=left, shrink=0.9, ticks=MaxNLocator(8, integer=True))
    bar.outline.set_visible(False)
    cables = audit.tension.shape[1]
    palette = ListedColormap([colormaps["tab20"](i % 20) for i in range(cables)])
    worst = np.where(audit.held, audit.worst_cable, -1)
    image = _heat(right, grid, worst, palette, np.arange(0.5, cables + 1.0))
    right.set_title("worst cable")
    ticks = np.unique(np.linspace(1, cables, min(cables, 12)).round())
    bar = figure.colorbar(image, ax=right, shrink=0.9, ticks=ticks)
    bar.outline.set_visible(False)
    draw_plan(beside, FramePlan.of(audit.robot, grid), grid, *grid.free)


def audit_layers(audit: PoseAudit) -> list[Layer]:
    """What the map that can be zoomed shows: the number of broken limits, and how near the worst cable is to one."""
    nothing = np.zeros(len(audit.held), dtype=bool)
    return [
        Layer("broken limits, all cables", "count", np.where(audit.held, audit.count, np.nan), nothing),
        Layer("worst cable: value over limit", "-", audit_use(audit).max(axis=0), nothing),
    ]


def audit_use(audit: PoseAudit) -> np.ndarray:
    """(5, k) each parameter of the worst cable over its limit (inverse for the crossover distance); nan if not held."""
    return np.where(audit.held[None, :], audit.largest_use.max(axis=-1), np.nan)


def _heat(axes: Axes, grid: Grid, value: np.ndarray, colours: ListedColormap, edges: np.ndarray):  # type: ignore[no-untyped-def]
    across, up = grid.free
    axes.grid(False)
    axes.set_facecolor(LIGHT)
    axes.patch.set(hatch="////", edgecolor=GREY, linewidth=0)
    field = value.reshape(grid.shape[across], grid.shape[up]).T
    image = axes.pcolormesh(
        grid.axes[across], grid.axes[up], np.ma.masked_less(field, 0), norm=BoundaryNorm(edges, colours.N),
        cmap=colours, shading="nearest", rasterized=True,
    )  # fmt: skip
    axes.set_aspect("equal")
    axes.set_xlabel(f"{AXES[across]} [m]")
    axes.set_ylabel(f"{AXES[up]} [m]")
    return image


def draw_audit_course(figure: Figure, audit: PoseAudit, course: np.ndarray, label: str) -> None:
    """Each parameter of the worst cable as a share of its limit, over time or along the one free axis.

    course : (k,) ascending;  label : its name with unit
    """
    axes = figure.subplots()
    use = audit_use(audit)
    top = float(np.nanmax(use)) if audit.held.any() else 1.0
    axes.set_yscale("log")
    for name, value in zip(PARAMETERS, use, strict=True):
        axes.plot(course, np.maximum(value, 1e-4), color=_COLOURS[name], linewidth=1.5, label=WORDS[name])
    axes.axhline(1.0, color=BLACK, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.axhspan(1.0, max(2.0 * top, 2.0), color=BAD, alpha=0.07, linewidth=0)
    lowest = float(np.nanmin(np.where(use > 1e-3, use, np.nan))) if audit.held.any() else 0.1
    axes.set_ylim(0.7 * min(lowest, 0.5), max(1.5 * top, 1.5))
    axes.set_xlabel(label)
    axes.set_ylabel("worst cable: value over limit [-]")
    plain_ticks(axes.yaxis)
    quiet(axes)
    figure.legend(loc="outside upper right", ncols=5)


def audit_map_caption(audit: PoseAudit, wide: bool = True) -> str:
    """What to see in the map: in its three panels, or in the one that can be zoomed."""
    held = int(audit.held.sum())
    clean, most = int(((audit.count == 0) & audit.held).sum()), int(audit.count.max())
    counted = "each cable and limit counted once"
    spread = f"no limit is broken at any of the {held} poses" if not most else (
        f"none at {clean} of {held} poses, the most are {most}"
    )  # fmt: skip
    gaps = "" if audit.held.all() else " {}: poses that the cables cannot hold."
    if wide:
        pale = "" if not most else "; pale blue is none"
        return (
            f"Broken limits: how many printed limits the cables break at each pose, {counted}{pale}: {spread}. Worst "
            "cable: the number of the one that is nearest to a limit or farthest beyond one. In the frame: the mapped "
            f"rectangle in blue, and the numbered anchors.{gaps.format('Hatched')}"
        )
    return (
        f"How many printed limits the cables break at each pose, {counted}: {spread}. The slider changes to the "
        f"largest value over its limit: above 1 the limit is broken.{gaps.format('Blank')} Blue line: the mapped "
        "rectangle. The button “whole frame” shows it in the frame with its numbered anchors."
    )


def audit_course_caption(audit: PoseAudit) -> str:
    """What to see in the curves."""
    bad = [WORDS[name] for name in PARAMETERS if audit.broken[name].any()]
    outcome = f"Broken: {', '.join(bad)}." if bad else "No limit is broken."
    return (
        "Each printed limit: the value of the cable that is worst off at that pose, over the limit (for the crossover "
        f"distance, limit over value). Above the dashed line a limit is broken. {outcome} Gaps: poses not held; ε "
        f"has no "
        "limit of its own above 60°."
    )

"""What a scan for determinant minima sees of the eigenfrequencies (thesis figs 3.8b, 3.8c)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.figures.mode_stacks import densest_window, stack_levels
from cdpr_struct.reports.figures.style import BAD, BLACK, BLUE, GOOD, GREY, LIGHT, quiet

SIZE = (9.6, 5.0)
DETERMINANT_LABEL = "log₁₀ |det(ω²E − M⁻¹K)|   [det in s⁻¹²]"
FREQUENCY_LABEL = "frequency [Hz]"
_STACKS_ACROSS = 70


def draw_determinant(figure: Figure, trial: Verification) -> None:
    """Determinant over frequency, all of it and the densest part; below, the FEM's modes stacked."""
    grid = figure.add_gridspec(2, 2, height_ratios=[2.6, 1.0], width_ratios=[1.6, 1.0])
    whole = (0.0, float(trial.scan.hertz[-1]))
    zoom = zoom_window(trial)
    for column, (window, title) in enumerate(((whole, "whole band"), (zoom, "densest part (shaded)"))):
        top = figure.add_subplot(grid[0, column])
        bottom = figure.add_subplot(grid[1, column], sharex=top)
        top.set_title(title)
        _curves(top, trial, window)
        _stacks(bottom, trial, window)
        top.tick_params(labelbottom=False)
        bottom.set_xlabel(FREQUENCY_LABEL)
        if column == 0:
            top.set_ylabel(DETERMINANT_LABEL)
            bottom.set_ylabel("FEM modes [count]")
            top.axvspan(*zoom, color=LIGHT, alpha=0.7, linewidth=0)
            bottom.axvspan(*zoom, color=LIGHT, alpha=0.7, linewidth=0)
            handles = top.get_legend_handles_labels(), bottom.get_legend_handles_labels()
    figure.legend(*(a + b for a, b in zip(*handles, strict=True)), loc="outside upper center", ncols=5)


def zoom_window(trial: Verification) -> tuple[float, float]:
    """The part of the band [Hz] where modes are densest."""
    return densest_window(trial.fem_limit_hertz, 0.07 * float(trial.scan.hertz[-1]))


def _curves(axes: Axes, trial: Verification, window: tuple[float, float]) -> None:
    scan = trial.scan
    part = (scan.hertz >= window[0]) & (scan.hertz <= window[1])
    axes.plot(
        scan.hertz[part], scan.log_static[part], color=GREY, linewidth=1.0, linestyle=(0, (4, 2)), label="static K"
    )
    axes.plot(scan.hertz[part], scan.log_dynamic[part], color=BLUE, linewidth=1.2, label="dynamic K (DSM, damped)")
    minima = scan.minima_hertz[(scan.minima_hertz >= window[0]) & (scan.minima_hertz <= window[1])]
    depth = np.interp(minima, scan.hertz, scan.log_dynamic)
    axes.plot(minima, depth, "o", color=BLACK, markersize=4.5, zorder=4, label="minimum of the scan")
    axes.set_xlim(*window)
    quiet(axes)


def _stacks(axes: Axes, trial: Verification, window: tuple[float, float]) -> None:
    inside = (trial.fem_limit_hertz >= window[0]) & (trial.fem_limit_hertz <= window[1])
    hertz, missed = trial.fem_limit_hertz[inside], np.isnan(trial.determinant_hertz[inside])
    level = stack_levels(hertz, (window[1] - window[0]) / _STACKS_ACROSS)
    axes.plot(hertz[~missed], level[~missed], "o", color=GOOD, markersize=4.5, label="FEM mode, seen by the scan")
    axes.plot(hertz[missed], level[missed], "x", color=BAD, markersize=4.5, mew=1.3, label="FEM mode, missed")
    axes.set_ylim(0.0, max(3.0, float(level.max(initial=1)) + 1.0))
    axes.yaxis.set_major_locator(MaxNLocator(3, integer=True))
    quiet(axes)


def determinant_caption(trial: Verification) -> str:
    """What to see in the figure."""
    k, step = len(trial.fem_limit_hertz), trial.scan.step_hertz
    low, high = zoom_window(trial)
    inside = (trial.fem_limit_hertz >= low) & (trial.fem_limit_hertz <= high)
    seen = int(np.isfinite(trial.determinant_hertz[inside]).sum())
    return (
        "Above, the determinant whose zeros are natural frequencies, with the cables' dynamic stiffness (line) and "
        "with their static stiffness only (dashed), which shows no cable modes. Below, every FEM "
        "eigenfrequency; marks on top of each other are frequencies too close to draw side by side. A scan at "
        f"{step:g} Hz finds {len(trial.scan.minima_hertz)} minima for {k} eigenfrequencies and misses "
        f"{trial.missed_by_scan}: where modes crowd, damping merges their dips. From {low:.2f} to {high:.2f} Hz "
        f"(shaded) there are {int(inside.sum())} modes, of which the scan sees {seen}."
    )

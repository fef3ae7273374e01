"""Figures 5.4 to 5.6 of the thesis, from the columns of their reproductions."""

import re

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.distribution import LOOKS
from cdpr_struct.reports.figures.style import quiet
from cdpr_struct.thesis.reproduction import Reproduction

PANELS_SIZE, ENERGY_SIZE = (9.6, 4.2), (9.6, 4.0)
_RULES = ("fixed", "pose-dependent")
_EVERY = 5
_LABELS = {"force": "cable force [N]", "lower_bound": "lower bound [N]"}


def draw_panels(figure: Figure, item: Reproduction) -> None:
    """A panel per cable with both bounds (figs 5.4, 5.5)."""
    what = re.sub(r"_1_fixed_N$", "", next(name for name in item.columns if name.endswith("_1_fixed_N")))
    count = sum(name.endswith("_fixed_N") for name in item.columns)
    grid = figure.subplots(-(-count // 4), 4, sharex=True, squeeze=False)
    time = _thin(item.columns["time_s"])
    for i, axes in enumerate(grid.ravel()[:count]):
        for rule in _RULES:
            values = item.columns[f"{what}_{i + 1}_{rule.replace('-', '_')}_N"]
            axes.plot(time, _thin(values), linewidth=1.4, **LOOKS[rule])
        axes.set_title(f"cable {i + 1}")
        axes.margins(x=0.0)
        quiet(axes)
    for row in grid:
        row[0].set_ylabel(_LABELS[what])
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)


def draw_energy(figure: Figure, item: Reproduction) -> None:
    """Energy over time with both bounds (fig. 5.6); the printed totals as crosses."""
    axes, time = figure.subplots(), item.columns["time_s"]
    printed = {"pose-dependent": item.cells[0].printed, "fixed": item.cells[1].printed}
    for rule in _RULES:
        spent = item.columns[f"energy_{rule.replace('-', '_')}_J"] / 1000.0
        axes.plot(_thin(time), _thin(spent), linewidth=1.8, **LOOKS[rule])
        axes.plot(time[-1], float(printed[rule]) / 1000.0, "x", color=LOOKS[rule]["color"], markersize=8, mew=2.0)
    axes.plot([], [], "x", color="black", label="printed total")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("energy spent [kJ]")
    axes.set_ylim(bottom=0.0)
    quiet(axes)
    axes.legend(loc="upper left")


def bounds_caption(item: Reproduction) -> str:
    """What to see in fig. 5.4."""
    return "Lower bound of each cable on the helix: the fixed one is the largest pose-dependent one of all."


def forces_caption(item: Reproduction) -> str:
    """What to see in fig. 5.5."""
    return "Force of each cable on the helix, at the platform. " + " ".join(f"{s.ours}." for s in item.statements)


def energy_caption(item: Reproduction) -> str:
    """What to see in fig. 5.6."""
    return f"Work of the cable forces, both directions; {item.cells[2].ours:.1f} % saved at the end."


def _thin(values: np.ndarray) -> np.ndarray:
    return values[::_EVERY]

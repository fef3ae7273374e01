"""Figs 2.5, 3.8 and 3.9 of the thesis, drawn from the columns of their reproductions."""

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.style import BLUE, GREY, ORANGE, plain_ticks
from cdpr_struct.reports.figures.workspace_map import Layer, draw_heat
from cdpr_struct.thesis.reproduction import Reproduction
from cdpr_struct.workspace.grid import Grid


def draw_trace(figure: Figure, item: Reproduction) -> None:
    """Fig. 2.5: trace of the dynamic and static stiffness."""
    axes = figure.subplots()
    c = item.columns
    axes.semilogy(c["frequency_Hz"], c["dynamic_trace_N_m"], color=BLUE, linewidth=1.4, label="dynamic")
    axes.semilogy(c["frequency_Hz"], c["static_trace_N_m"], color=GREY, linestyle="--", label="static")
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("|trace K| [N/m]")
    plain_ticks(axes.yaxis)
    axes.legend()


def draw_determinants(figure: Figure, item: Reproduction) -> None:
    """Figs 3.8b and 3.8c in one."""
    axes = figure.subplots()
    c = item.columns
    axes.plot(c["frequency_Hz"], c["log10_dynamic"], color=BLUE, linewidth=1.2, label="with cable dynamics (fig. 3.8b)")
    axes.plot(c["frequency_Hz"], c["log10_static"], color=ORANGE, linestyle="--", label="static K (fig. 3.8c)")
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("log10 |det(ω² E − M⁻¹ K)|")
    axes.legend()


def draw_first_frequencies(figure: Figure, item: Reproduction) -> None:
    """Fig. 3.9: platform (dynamic, massless) and the eight cables over the sub-workspace."""
    c = item.columns
    grid = Grid(np.unique(c["x_m"]), np.unique(c["y_m"]), np.zeros(1), np.zeros(3))
    names = {"platform_Hz": "platform", "platform_massless_Hz": "platform, massless cables"}
    names |= {f"cable_{i}_Hz": f"cable {i}" for i in range(1, 9)}
    marked = np.zeros(grid.size, dtype=bool)
    panels = figure.subplots(2, 5, sharex=True, sharey=True)
    for axes, (name, title) in zip(panels.ravel(), names.items(), strict=True):
        draw_heat(figure, axes, grid, Layer(title, "Hz", c[name], marked, signed=False), 5)
        axes.label_outer()


def trace_caption(item: Reproduction) -> str:
    return "Peaks are the clamped cable's natural frequencies; the static trace has none."


def determinants_caption(item: Reproduction) -> str:
    return "Every dip stands for one natural frequency or several: the cable modes of one group share a few dips."


def first_frequencies_caption(item: Reproduction) -> str:
    return "Each panel has its own scale. A cable's first frequency follows its tension and length over the workspace."

"""The picture: time over size, one panel a task."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np


def draw_growth(path: Path, curves: Mapping[str, tuple[str, np.ndarray, np.ndarray]]) -> None:
    """Write panels of (what grows, sizes, seconds) as SVG in logarithmic axes; the same input gives the same file."""
    import matplotlib

    with matplotlib.rc_context({"svg.hashsalt": path.name, "svg.fonttype": "path", "font.size": 8.0}):
        from matplotlib.figure import Figure

        figure = Figure(figsize=(8.0, 7.0), layout="constrained")
        panels = figure.subplots(-(-len(curves) // 3), 3)
        for axes in panels.flat[len(curves) :]:
            axes.set_visible(False)
        for axes, (task, (over, sizes, seconds)) in zip(panels.flat, curves.items(), strict=False):
            axes.loglog(sizes, 1e3 * seconds, "o-", color="#0072B2", markersize=3.5)
            linear = 1e3 * seconds[-1] * sizes / sizes[-1]
            axes.loglog(sizes, linear, ":", color="#8a8f98", linewidth=0.9)
            axes.set(title=task, xlabel=over, ylabel="time [ms]")
            axes.grid(True, which="major", alpha=0.3)
        figure.savefig(path, format="svg", metadata={"Date": None})

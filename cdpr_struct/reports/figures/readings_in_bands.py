"""Every reading against its band, in sigmas."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.compare_told import words_of
from cdpr_struct.reports.figures.style import BAD, GOOD, LIGHT, quiet

CAPTION = (
    "Each reading less its prediction, in sigmas of the robot's tolerances and the sensor's noise; the grey bar is the "
    "band. Marks outside are readings that this robot should seldom give; many on one side point to one cause."
)


def size(result: Mapping[str, Any]) -> tuple[float, float]:
    """Of the figure [inch]."""
    return 8.2, 1.4 + 0.24 * len(result["readings"])


def draw_readings(figure: Figure, result: Mapping[str, Any]) -> None:
    """Marks at the deviations, bars at the bands."""
    axes = figure.subplots()
    rows = result["readings"]
    place = np.arange(len(rows))
    off = np.array([row["off_sigmas"] for row in rows], dtype=float)
    gap = np.array([row["measured"] - row["predicted"] for row in rows], dtype=float)
    sigma = np.array([_sigma(row, g, o) for row, g, o in zip(rows, gap, off, strict=True)])
    ends = np.array([np.subtract(row["band"], row["predicted"]) for row in rows]) / sigma[:, None]
    axes.barh(place, ends[:, 1] - ends[:, 0], left=ends[:, 0], color=LIGHT, height=0.7)
    inside = np.array([row["inside"] for row in rows])
    for kept, colour, mark, label in ((inside, GOOD, "o", "inside"), (~inside, BAD, "X", "outside")):
        if kept.any():
            axes.plot(off[kept], place[kept], mark, color=colour, markersize=6, label=label)
    axes.axvline(0.0, color=LIGHT, linewidth=1.0)
    axes.set_yticks(place, [words_of(row) for row in rows], fontsize=8.0)
    axes.invert_yaxis()
    axes.set_xlabel("measured less predicted [sigmas]")
    axes.set_ylabel("reading")
    axes.legend(fontsize=8.0, loc="best")
    quiet(axes, "x")


def _sigma(row: Mapping[str, Any], gap: float, off: float) -> float:
    """Of tolerances and noise together, in the unit of the reading."""
    return gap / off if off else max(row["band"][1] - row["predicted"], 1e-300)

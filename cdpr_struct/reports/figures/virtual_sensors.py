"""Predicted tensions, places, angles and lengths of all states with their bands, beside what was read."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.virtual_sensors import VirtualSensors
from cdpr_struct.reports.diagnose.virtual_table import kinds, quantile
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION, quiet

SIZE = (9.6, 8.4)
CAPTION = (
    "Bands of what is predicted; dots are readings. Where a sensor was read, its reading less the prediction without it is "
    "shown, about zero: dots outside the band by more than their own noise contradict the robot."
)
_COLOURS = (BLUE, ORANGE, GREEN, VERMILLION, PURPLE, SKY, BLACK)
_ORDER = ("tension", "position", "rotation", "length")
_MILLI = {"m": ("mm", 1e3)}


def draw_virtual(figure: Figure, found: VirtualSensors) -> None:
    """A panel for each kind of sensor, over time, or over the states where there is none."""
    timed = bool(np.isfinite(found.time).all())
    across = found.time if timed else np.arange(1.0, len(found.names) + 1.0)
    panels = figure.subplots(len(_ORDER), 1, sharex=True)
    for axes, sensor in zip(panels, _ORDER, strict=True):
        _draw(axes, found, sensor, across)
    panels[-1].set_xlabel("time [s]" if timed else "state")


def _draw(axes: Axes, found: VirtualSensors, sensor: str, across: np.ndarray) -> None:
    own = [(number, unit, factor, at) for name, number, unit, factor, at in kinds(found.cables) if name == sensor]
    order, off = np.argsort(across, kind="stable"), bool(np.isfinite(found.reading[:, [one[3] for one in own]]).any())
    unit, more = _MILLI.get(own[0][1], (own[0][1], 1.0)) if off else (own[0][1], 1.0)
    for k, (number, _, factor, at) in enumerate(own):
        value, sigma = factor * more * found.value[order, at], factor * more * found.sigma[order, at]
        middle = 0.0 * value if off else value
        colour, reach = _COLOURS[k % len(_COLOURS)], quantile() * sigma
        axes.fill_between(across[order], middle - reach, middle + reach, color=colour, alpha=0.18, linewidth=0.0)
        if off:
            gap = factor * more * found.reading[order, at] - value
            axes.plot(across[order], gap, ".", color=colour, markersize=3.0, label=number)
        else:
            axes.plot(across[order], value, color=colour, linewidth=1.0, label=number)
    axes.set_ylabel(f"{sensor}: read less predicted [{unit}]" if off else f"{sensor} [{unit}]", fontsize=8.0)
    axes.legend(fontsize=7.0, ncols=min(len(own), 9), loc="upper right")
    quiet(axes)

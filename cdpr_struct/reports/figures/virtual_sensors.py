"""Predicted tensions, places, angles and lengths of all states with their bands, beside what was read."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.virtual_sensors import VirtualSensors
from cdpr_struct.reports.diagnose.virtual_table import kinds, quantile
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION, quiet

SIZE = (9.6, 8.4)
CAPTION = (
    "Bands of what is predicted, without the sensor's own reading; dots are readings. Tensions are shown as they are, "
    "of other sensors that were read the reading less the prediction: dots outside the band by more than their own "
    "noise contradict the robot."
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
    """Values, or readings less predictions about zero where bands would be too thin to be seen."""
    own = [(number, unit, factor, at) for name, number, unit, factor, at in kinds(found.cables) if name == sensor]
    read, order = np.isfinite(found.reading[:, [one[3] for one in own]]).any(), np.argsort(across, kind="stable")
    about_zero = bool(read) and sensor != "tension"
    unit, more = _MILLI.get(own[0][1], (own[0][1], 1.0)) if about_zero else (own[0][1], 1.0)
    for k, (number, _, factor, at) in enumerate(own):
        value, sigma, said = (factor * more * part[order, at] for part in (found.value, found.sigma, found.reading))
        zero, colour, reach = value if about_zero else 0.0, _COLOURS[k % len(_COLOURS)], quantile() * sigma
        low, high = value - zero - reach, value - zero + reach
        axes.fill_between(across[order], low, high, color=colour, alpha=0.18, linewidth=0.0)
        if not about_zero:
            axes.plot(across[order], value, color=colour, linewidth=1.0)
        axes.plot(across[order], said - zero, ".", color=colour, markersize=3.0, label=number)
    axes.set_ylabel(f"{sensor} off [{unit}]" if about_zero else f"{sensor} [{unit}]")
    axes.legend(fontsize=7.0, ncols=min(len(own), 5), loc="upper right")
    quiet(axes)

"""Curves of the robot as entered in the bands of robots within the tolerances."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.bands.drawn_curves import CurveBands
from cdpr_struct.reports.figures.style import BLUE, GREY, SKY, plain_ticks, quiet
from cdpr_struct.reports.typeset import typeset

_WIDTH, _PANEL, _REST = 9.6, 1.75, 0.9  # inch: of the figure; height of a panel and of what is around them


@dataclass(frozen=True, slots=True, eq=False)
class ShownCurves:
    """r curves over n places.

    names, units : (r) of the curves;  along : label of the places;  entered : (r, n) of the robot as entered
    logarithmic : whether sizes are compared by their ratio
    """

    names: list[str]
    units: list[str]
    along: str
    entered: np.ndarray
    bands: CurveBands
    logarithmic: bool

    @property
    def size(self) -> tuple[float, float]:
        """Of the figure [inch]."""
        return _WIDTH, _REST + _PANEL * len(self.names)


def draw_curve_bands(figure: Figure, shown: ShownCurves) -> None:
    """A panel for each curve."""
    panels = figure.subplots(len(shown.names), 1, sharex=True, squeeze=False)[:, 0]
    bands, place = shown.bands, shown.bands.place
    for index, (axes, name, unit) in enumerate(zip(panels, shown.names, shown.units, strict=True)):
        axes.fill_between(place, bands.low[index], bands.high[index], color=SKY, alpha=0.45, linewidth=0, label="band")
        axes.plot(place, bands.middle[index], color=GREY, linewidth=0.8, label="median")
        axes.plot(place, shown.entered[index], color=BLUE, linewidth=1.0, label="as entered")
        if shown.logarithmic:
            axes.set_yscale("log")
            plain_ticks(axes.yaxis)
        axes.set_ylabel(f"{name} [{typeset(unit)}]")
        quiet(axes)
    panels[-1].set_xlabel(shown.along)
    panels[-1].set_xlim(place[0], place[-1])
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=3)


def caption(level: float, count: int, what: str) -> str:
    """What is to be seen; level [%]."""
    return (
        f"Shaded: {level:g} % of {count} robots drawn within the tolerances lie inside, at each {what} by itself. "
        "Grey: their median. Where a resonance moves by more than its width the median lies below the peak of any "
        "robot, and the band reaches from flank to peak. Damping is not drawn."
    )

"""Cable forces along a motion in their bands."""

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.bands.force_bands import ForceBands
from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.figures.style import BLACK, BLUE, SKY, VERMILLION, quiet

_ACROSS = 2  # panels beside each other


def size(bands: ForceBands) -> tuple[float, float]:
    """Of the figure [inch]."""
    return 9.6, 0.9 + 1.6 * -(-bands.tension.shape[1] // _ACROSS)


def caption(level: float) -> str:
    """What is to be seen; level [%]."""
    return (
        f"Shaded: {level:g} % of robots within the tolerances pull inside, at each instant by itself. Dashed: the "
        "lower bound. Red: more than one robot in twenty pulls less than the bound."
    )


def draw_force_bands(figure: Figure, found: TrajectoryDistribution, bands: ForceBands) -> None:
    """A panel for each cable."""
    count, time = bands.tension.shape[1], found.trajectory.time[bands.instant]
    panels = figure.subplots(-(-count // _ACROSS), _ACROSS, sharex=True, squeeze=False).ravel()
    lower = np.broadcast_to(found.distribution.lower, found.distribution.tensions.shape)[bands.instant]
    for cable, axes in enumerate(panels[:count]):
        low, high = bands.band[:, cable].T
        axes.fill_between(time, low, high, color=SKY, alpha=0.45, linewidth=0, label="band")
        axes.plot(time, bands.tension[:, cable], color=BLUE, linewidth=1.2, label="tension")
        axes.plot(time, lower[:, cable], color=BLACK, linewidth=0.9, linestyle="--", label="lower bound")
        often = np.where(bands.below[:, cable] > 0.05, bands.tension[:, cable], np.nan)
        axes.plot(time, often, color=VERMILLION, linewidth=2.0, label="may be below it")
        axes.set_ylabel(f"cable {cable + 1} [N]")
        quiet(axes)
    for axes in panels[count:]:
        axes.set_visible(False)
    for axes in panels[max(0, count - _ACROSS) : count]:
        axes.set_xlabel("time [s]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=4)

"""Change of frequency from the first to the last window of decays: measured, by large motion, and with friction."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.amplitude_law import AmplitudeFinding, changes
from cdpr_struct.diagnosis.amplitude_rows import READING
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREY, ORANGE, plain_ticks, quiet

SIZE = (9.6, 3.8)
CAPTION = (
    "Left: frequency of each mode in each window, against its mean over the windows, over the mode's amplitude; lines: "
    "large motion alone, and with friction as fitted to the other records. Right: change from the first to the last "
    "window, predicted against measured; on the dashed line they agree."
)


def draw_amplitudes(figure: Figure, found: AmplitudeFinding) -> None:
    """Two panels: frequencies over amplitude, and predicted against measured changes."""
    left, right = figure.subplots(1, 2, width_ratios=[1.7, 1.0])
    rows = found.rows
    assert rows is not None
    friction = rows.large + found.fits[0].held_out
    _over_amplitude(left, found, friction)
    measured = 100.0 * changes(rows, rows.log_hertz)
    for values, colour, marker, label in (
        (rows.large, ORANGE, "s", "large motion"), (friction, BLUE, "o", "with friction, held out"),
    ):  # fmt: skip
        right.plot(measured, 100.0 * changes(rows, values), marker, color=colour, markersize=4, label=label)
    ends = [min(0.0, measured.min()), max(measured.max(), 0.1)]
    right.plot(ends, ends, "--", color=GREY, linewidth=0.9)
    right.set_xlabel("measured change [%]")
    right.set_ylabel("predicted change [%]")
    right.legend(loc="upper left", fontsize=7.5)
    quiet(right)


def _over_amplitude(axes: Axes, found: AmplitudeFinding, friction: np.ndarray) -> None:
    rows = found.rows
    assert rows is not None
    sigma = np.hypot(rows.hertz_sigma, READING)
    parts = [rows.centred(value, sigma) for value in (rows.log_hertz, rows.large, friction)]
    looks = ((BLACK, "o", "measured"), (ORANGE, "-", "large motion"), (BLUE, "-", "with friction, held out"))
    for value, (colour, look, label) in zip(parts, looks, strict=True):
        for number, mode in enumerate(dict.fromkeys(rows.mode.tolist())):
            own = np.flatnonzero(rows.mode == mode)
            own = own[np.argsort(rows.amplitude[own])]
            axes.plot(
                1e3 * rows.amplitude[own], 100.0 * value[own], look, color=colour, markersize=3, linewidth=0.9,
                alpha=0.8, label=label if number == 0 else None,
            )  # fmt: skip
    axes.set_xscale("log")
    axes.set_xlabel("amplitude [mm], turns at the platform's radius")
    axes.set_ylabel("frequency less its mean [%]")
    axes.legend(loc="upper right", fontsize=7.5)
    plain_ticks(axes.xaxis)
    quiet(axes)

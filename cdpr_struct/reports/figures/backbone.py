"""Frequencies of platform modes over their amplitude."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILLION, quiet

SIZE = (9.6, 3.4)
CAPTION = (
    "Frequency of each platform mode against that of its small motion, over the amplitude of the cables' platform "
    "end that moves most; each mode swings alone. Rings: a cable's tension falls below its weight on the way."
)
_COLOURS = (BLUE, ORANGE, GREEN, VERMILLION, PURPLE, BLACK)


def draw_backbone(figure: Figure, result: Mapping[str, Any]) -> None:
    """Shift in per cent over amplitude in mm, a line a mode, from the small motion on."""
    axes, large = figure.subplots(), result["large_motion"]
    small, amplitudes = (
        np.asarray(result["frequencies_hz"], dtype=float),
        np.asarray(large["amplitudes_m"], dtype=float),
    )
    order = np.argsort(amplitudes)
    millimetres = 1e3 * np.append(0.0, amplitudes[order])
    for line, (mode, hertz, slack) in enumerate(
        zip(large["modes"], large["frequencies_hz"], large["slack"], strict=True)
    ):
        own, colour = small[mode - 1], _COLOURS[line % len(_COLOURS)]
        shift = np.append(0.0, 100.0 * (np.asarray(hertz, dtype=float)[order] / own - 1.0))
        axes.plot(
            millimetres, shift, "o-", color=colour, markersize=3, linewidth=1.2, label=f"mode {mode}, {own:.3g} Hz"
        )
        loose = np.append(False, np.asarray(slack, dtype=bool)[order])
        axes.plot(millimetres[loose], shift[loose], "o", mfc="none", color=colour, markersize=8)
    axes.set_xlabel("amplitude [mm]")
    axes.set_ylabel("change of frequency [%]")
    if len(large["modes"]):
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=7.5, borderaxespad=0.0)
    quiet(axes)

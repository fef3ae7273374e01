"""Natural frequencies of one cable, each with its band."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cdpr_struct.reports.figures.style import BLUE, GREEN, ORANGE, quiet

SIZE = (8.6, 3.4)
_PLANES = {"out_of_plane": ("across the plane", GREEN, -0.12), "in_plane": ("in the plane", BLUE, 0.12)}
_BESIDE = 0.08  # of a mode, by which drawn cables stand beside


def caption(bands: Mapping[str, Any]) -> str:
    """What is to be seen."""
    said = (
        f"Change of every frequency: {bands['level']:g} % of cables within the tolerances lie inside. Modes of a taut "
        "cable move together, as the tension does; those that move less feel the stretch."
    )
    return said + (" Orange: cables drawn within the tolerances, computed anew." if "samples" in bands else "")


def draw_bands(figure: Figure, result: Mapping[str, Any]) -> None:
    """Bands in per cent of each frequency, over the number of the mode."""
    axes, bands = figure.subplots(), result["bands"]
    for plane, (label, colour, aside) in _PLANES.items():
        hertz = np.asarray(result["exact_frequencies_hz"][plane], dtype=float)
        number = np.arange(1, len(hertz) + 1) + aside
        low, high = _percent(bands["exact_frequencies_hz"][plane], hertz)
        axes.vlines(number, low, high, color=colour, linewidth=4.0, alpha=0.7, label=label)
        if "samples" in bands:
            low, high = _percent(bands["samples"]["exact_frequencies_hz"][plane], hertz)
            once = "drawn cables" if plane == "in_plane" else ""
            axes.vlines(number + _BESIDE, low, high, color=ORANGE, linewidth=1.8, label=once)
    axes.axhline(0.0, color="black", linewidth=0.7)
    axes.set_xlabel("mode [count]")
    axes.set_ylabel("change of the frequency [%]")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    figure.legend(loc="outside upper right", ncols=3)
    quiet(axes)


def _percent(ends: Any, hertz: np.ndarray) -> np.ndarray:
    """(2, k) ends less frequencies (k,) [%]."""
    return np.asarray(100.0 * (np.asarray(ends, dtype=float) / hertz[:, None] - 1.0).T)

"""Stabilisation diagram of an ambient record, the singular values of its spectral density behind it."""

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.measurement.ambient_records import AmbientRecord
from cdpr_struct.reports.figures.style import BLUE, GREY, LIGHT, ORANGE, quiet

SIZE = (9.6, 4.4)
_MOST_LINES = 3  # singular values that are drawn


def draw_stabilisation(figure: Figure, record: AmbientRecord) -> None:
    """Poles over frequency and model order; those of the chosen modes filled."""
    behind = figure.subplots()
    axes = behind.twinx()
    low, high = record.band
    hertz, values = record.spectrum.hertz, record.spectrum.values
    inside = (hertz >= 0.5 * low) & (hertz <= high)
    for k in range(min(_MOST_LINES, values.shape[1])):
        behind.semilogy(hertz[inside], values[inside, k], color=GREY, linewidth=0.9 if k == 0 else 0.5, alpha=0.8)
    behind.set_ylabel("singular values of the spectral density")
    behind.set_xlabel("frequency [Hz]")
    behind.grid(visible=False)
    poles = record.diagram
    chosen = poles.chosen >= 0
    loose, stable = ~poles.stable & ~chosen, poles.stable & ~chosen
    axes.plot(poles.hertz[loose], poles.order[loose], "x", color=GREY, markersize=2.5, label="pole of one order")
    axes.plot(
        poles.hertz[stable], poles.order[stable], "o", mfc="none", color=ORANGE, markersize=3.0,
        label="stable, not chosen",
    )  # fmt: skip
    axes.plot(poles.hertz[chosen], poles.order[chosen], "o", color=BLUE, markersize=3.0, label="stable, a mode")
    for f, sigma in zip(record.modes.hertz, record.sigma, strict=True):
        axes.axvspan(f - 2.0 * sigma, f + 2.0 * sigma, color=LIGHT, zorder=0)
    axes.set_xlim(0.5 * low, high)
    axes.set_ylim(0.0, 1.05 * float(np.max(poles.order, initial=1)))
    axes.set_ylabel("model order")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=3)
    quiet(behind)

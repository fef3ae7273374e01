"""Magnitude and phase of frequency responses, with the eigenfrequencies as ticks."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.dynamics.frequency_sweep import ModesInBand, ResponseSweep
from cdpr_struct.measurement.universal_file import response_unit
from cdpr_struct.reports.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    KIND_COLOURS,
    KIND_WORDS,
    PURPLE,
    SKY,
    VERMILLION,
    kind_group,
    plain_ticks,
    quiet,
)
from cdpr_struct.reports.typeset import typeset

SIZE = (9.6, 6.2)
COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, SKY, BLACK)
_MOST_POINTS = 4000


def draw_frf(figure: Figure, sweep: ResponseSweep) -> None:
    """Magnitude on a log scale, the eigenfrequencies below it, then the phase."""
    upper, ticks, lower = figure.subplots(3, 1, sharex=True, height_ratios=[3.0, 0.35, 1.3])
    found = sweep.response
    units = [typeset(response_unit(port, found.excite, found.quantity)) for port in found.respond]
    for column, (port, unit) in enumerate(zip(found.respond, units, strict=True)):
        colour = COLOURS[column % len(COLOURS)]
        if sweep.silent[column]:
            upper.plot([], [], color=colour, linewidth=1.1, label=f"{port.name}: no answer")
            continue
        values = found.response[:, column]
        size = np.abs(values)
        hertz, thin = thinned(found.hertz, size)
        name = port.name if len(set(units)) == 1 else f"{port.name} [{unit}]"
        upper.plot(hertz, np.where(size[thin] > 0.0, size[thin], np.nan), color=colour, linewidth=1.1, label=name)
        lower.plot(hertz, np.degrees(np.angle(values[thin])), color=colour, linewidth=0.8)
    upper.set_yscale("log")
    plain_ticks(upper.yaxis)
    shared = units[0] if len(set(units)) == 1 else "unit in the legend"
    upper.set_ylabel(f"{found.quantity} under {found.excite.name} [{shared}]")
    figure.legend(*upper.get_legend_handles_labels(), loc="outside upper right", ncols=3)
    draw_mode_ticks(ticks, sweep.modes)
    lower.set_ylabel("phase [deg]")
    lower.set_ylim(-190.0, 190.0)
    lower.set_yticks([-180, -90, 0, 90, 180])
    lower.set_xlabel("frequency [Hz]")
    lower.set_xlim(found.hertz[0], found.hertz[-1])
    quiet(upper)
    quiet(lower)


def thinned(hertz: np.ndarray, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies and their numbers: of each bundle of a long sweep the largest and the smallest response."""
    bundle = -(-2 * len(hertz) // _MOST_POINTS)
    if bundle <= 2:
        return hertz, np.arange(len(hertz))
    full = len(hertz) // bundle * bundle
    groups = size[:full].reshape(-1, bundle)
    first = np.arange(0, full, bundle)
    ends = np.array([0, len(hertz) - 1])
    chosen = np.unique(np.concatenate([first + groups.argmax(axis=1), first + groups.argmin(axis=1), ends]))
    return hertz[chosen], chosen


def draw_mode_ticks(axes: Axes, modes: ModesInBand) -> None:
    """A tick for every eigenfrequency, coloured by kind."""
    groups = np.array([kind_group(kind) for kind in modes.kinds], dtype=object)
    for name, colour in KIND_COLOURS.items():
        here = modes.hertz[groups == name] if len(modes.hertz) else modes.hertz
        axes.vlines(here, 0.0, 1.0, color=colour, linewidth=0.9)
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.set_ylabel("modes", rotation=0, ha="right", va="center")
    axes.grid(False)


def frf_caption(sweep: ResponseSweep) -> str:
    """What to see in the figure."""
    count = int((sweep.modes.hertz >= sweep.response.hertz[0]).sum())
    highest = "; ".join(filter(None, (_highest(sweep, column) for column in range(len(sweep.peaks)))))
    return (
        f"Ticks: the {count} undamped eigenfrequencies of the robot in the band{_colours(sweep.modes)}. A mode without "
        "a peak is not excited here, not seen there, or hidden in a cluster."
        + (f" Highest peaks: {highest}." if highest else "")
        + (" Curves are cut off beside the poles." if any(np.isinf(p.magnitude).any() for p in sweep.peaks) else "")
    )


def _colours(modes: ModesInBand) -> str:
    """Which colour is which kind of mode, of those that are there."""
    there = {kind_group(kind) for kind in modes.kinds}
    said = [f"{KIND_WORDS[name]} for {name}" for name in KIND_COLOURS if name in there]
    return f", {' and '.join(filter(None, (', '.join(said[:-1]), said[-1])))} modes" if said else ""


def _highest(sweep: ResponseSweep, column: int) -> str:
    """Frequency, half-power width and damping ratio of a response's highest peak, "" if it has none that is finite."""
    peaks = sweep.peaks[column]
    if len(peaks.hertz) == 0 or np.isinf(peaks.magnitude).any():
        return ""
    top = int(peaks.magnitude.argmax())
    found = f"{sweep.response.respond[column].name} at {peaks.hertz[top]:.4g} Hz"
    if np.isnan(peaks.half_power_width[top]):
        return found
    return (
        f"{found} (half-power width {peaks.half_power_width[top]:.3g} Hz, damping ratio {peaks.damping_ratio[top]:.2g})"
    )

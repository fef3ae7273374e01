"""A vibration over time, and its spectrogram with the predicted modes drawn in."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.dynamics.frequency_sweep import ModesInBand
from cdpr_struct.measurement.spectrogram import Spectrogram
from cdpr_struct.reports.figures.style import BLUE, GREEN, KIND_COLOURS, VERMILLION, kind_group, quiet

SIZE = (9.6, 6.4)
_DECADES = 5.0
_COLOURS = (BLUE, VERMILLION, GREEN)
_MOST_POINTS = 3000


def draw_vibration(
    figure: Figure,
    time: np.ndarray,
    acceleration: np.ndarray,
    names: Sequence[str],
    spectrum: Spectrogram,
    modes: ModesInBand,
    highest_hertz: float,
) -> None:
    """Acceleration (n, c) over time; below it the spectrogram of all channels up to `highest_hertz`."""
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.0, 2.2])
    stride = -(-len(time) // _MOST_POINTS)
    for channel, name in enumerate(names):
        colour = _COLOURS[channel % len(_COLOURS)]
        upper.plot(time[::stride], acceleration[::stride, channel], color=colour, linewidth=0.8, label=name)
    upper.set_ylabel("acceleration [m/s²]")
    figure.legend(*upper.get_legend_handles_labels(), loc="outside upper right", ncols=6)
    quiet(upper)
    shown = spectrum.hertz <= highest_hertz
    density = spectrum.total()[shown]
    top = max(float(density.max()), np.finfo(float).tiny)
    level = np.log10(np.maximum(density, top * 10.0**-_DECADES))
    image = lower.pcolormesh(
        spectrum.time, spectrum.hertz[shown], level, cmap="viridis", shading="nearest", rasterized=True
    )
    figure.colorbar(image, ax=lower, label="log₁₀ of the power density [(m/s²)²/Hz]", pad=0.09)
    lower.set_ylim(0.0, highest_hertz)
    lower.set_xlim(time[0], time[-1])
    lower.set_xlabel("time [s]")
    lower.set_ylabel("frequency [Hz]")
    lower.grid(False)
    _draw_modes(lower, modes, highest_hertz)


def _draw_modes(axes: Axes, modes: ModesInBand, highest_hertz: float) -> None:
    for hertz, kind in zip(modes.hertz, modes.kinds, strict=True):
        if hertz <= highest_hertz:
            long = kind_group(kind) != "cable"
            axes.plot(
                [1.005, 1.06 if long else 1.03], [hertz, hertz], transform=axes.get_yaxis_transform(),
                color=KIND_COLOURS[kind_group(kind)], linewidth=1.6 if long else 0.8, clip_on=False,
            )  # fmt: skip
            if long:
                axes.axhline(hertz, color="white", linewidth=0.6, linestyle=(0, (2, 4)), alpha=0.8)


def vibration_caption(spectrum: Spectrogram) -> str:
    """What to see in the figure."""
    apart = 4.0 / spectrum.window
    return (
        f"Spectrogram with a Hann window of {spectrum.window:.3g} s, which separates modes {apart:.2g} Hz apart; the "
        f"colour spans {_DECADES:g} decades. Marks on the right: predicted undamped eigenfrequencies, long "
        "and dashed for platform (blue) and mixed (pink) modes, short for cable modes (orange)."
    )

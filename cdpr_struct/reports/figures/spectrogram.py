"""A vibration over time, and its spectrogram with the predicted modes drawn in."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.dynamics.frequency_sweep import ModesInBand
from cdpr_struct.measurement.spectrogram import Spectrogram
from cdpr_struct.reports.figures.style import BLUE, GREEN, KIND_COLOURS, VERMILLION, kind_group, quiet

SIZE = (9.6, 6.4)
DECADES = 5.0
COLOURS = (BLUE, VERMILLION, GREEN)
_MOST_POINTS = 3000
DENSITY_LABEL = "log₁₀ of the power density [(m/s²)²/Hz]"


@dataclass(frozen=True, slots=True, eq=False)
class Vibration:
    """A record, its spectrogram, and the modes that are predicted.

    time, acceleration : (n,) [s], (n, c) [m/s^2]
    names              : of the c channels
    highest_hertz      : up to where the spectrogram is shown
    """

    time: np.ndarray
    acceleration: np.ndarray
    names: Sequence[str]
    spectrum: Spectrogram
    modes: ModesInBand
    highest_hertz: float

    @property
    def stride(self) -> int:
        """Every how many samples of the record are drawn."""
        return -(-len(self.time) // _MOST_POINTS)

    @property
    def level(self) -> np.ndarray:
        """(f, t) logarithm of the power density of all channels, cut off below the decades that are shown."""
        density = self.spectrum.total()[self.spectrum.hertz <= self.highest_hertz]
        top = max(float(density.max()), np.finfo(float).tiny)
        level: np.ndarray = np.log10(np.maximum(density, top * 10.0**-DECADES))
        return level


def draw_vibration(figure: Figure, shown: Vibration) -> None:
    """Acceleration over time; below it the spectrogram of all channels."""
    time, spectrum, highest_hertz = shown.time, shown.spectrum, shown.highest_hertz
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.0, 2.2])
    for channel, name in enumerate(shown.names):
        colour = COLOURS[channel % len(COLOURS)]
        upper.plot(
            time[:: shown.stride], shown.acceleration[:: shown.stride, channel], color=colour, linewidth=0.8, label=name
        )
    upper.set_ylabel("acceleration [m/s²]")
    figure.legend(*upper.get_legend_handles_labels(), loc="outside upper right", ncols=6)
    quiet(upper)
    image = lower.pcolormesh(
        spectrum.time,
        spectrum.hertz[spectrum.hertz <= highest_hertz],
        shown.level,
        cmap="viridis",
        shading="nearest",
        rasterized=True,
    )
    figure.colorbar(image, ax=lower, label=DENSITY_LABEL, pad=0.09)
    lower.set_ylim(0.0, highest_hertz)
    lower.set_xlim(time[0], time[-1])
    lower.set_xlabel("time [s]")
    lower.set_ylabel("frequency [Hz]")
    lower.grid(False)
    _draw_modes(lower, shown.modes, highest_hertz)


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
        f"colour spans {DECADES:g} decades. Marks on the right: predicted undamped eigenfrequencies, long "
        "and dashed for platform (blue) and mixed (pink) modes, short for cable modes (orange)."
    )

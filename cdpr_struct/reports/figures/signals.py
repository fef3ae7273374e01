"""Measured spectra with identified peaks and the model's modes, and damping ratios over amplitude."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import find_peaks

from cdpr_struct.diagnosis.damping_rows import DampingRows
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.signal_states import VISIBLE
from cdpr_struct.reports.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    plain_ticks,
    quiet,
)

SPECTRUM_SIZE, DAMPING_SIZE = (9.6, 3.4), (9.6, 3.6)
_STANDS_OUT, _ABOVE = 3.0, 10.0  # factor between a peak and the dips beside it; times the noise
_NEAR = 0.01  # of its frequency: a peak so near an identified mode is that mode
_COLOURS, _MARKERS = (BLUE, ORANGE, GREEN, VERMILLION, PURPLE, SKY, BLACK), "os^Dv"
_MOST_NAMED = 24  # lines in the legend


def draw_spectrum(figure: Figure, item: Identified) -> None:
    """Spectrum of one record, all channels together in units of their noise."""
    axes = figure.subplots()
    hertz, size = _spectrum(item)
    modes = item.modes
    low, high = _band(item, hertz)
    inside = (hertz >= low) & (hertz <= high)
    _model_lines(axes, item, low, high)
    axes.semilogy(hertz[inside], size[inside], color=BLUE, linewidth=0.9)
    height = np.interp(modes.hertz, hertz, size)
    seen = (modes.hertz >= low) & (modes.hertz <= high)
    used, left = item.used & seen, ~item.used & seen
    axes.plot(modes.hertz[used], height[used], "o", color=BLUE, markersize=5, label="joined the campaign")
    axes.plot(modes.hertz[left], height[left], "o", mfc="none", color=ORANGE, markersize=5, label="did not")
    bare = unfitted_peaks(item)
    bare = bare[(bare >= low) & (bare <= high)]
    if bare.size:
        above = 1.5 * np.interp(bare, hertz, size)
        axes.plot(bare, above, "v", mfc="none", color=VERMILLION, markersize=5, label="no mode fitted")
    axes.set_xlim(low, high)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("response [1/its noise]")
    plain_ticks(axes.yaxis)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=5)
    quiet(axes)


def _model_lines(axes: Axes, item: Identified, low: float, high: float) -> None:
    """Upright lines at the model's modes, one of each kind named."""
    if item.state is None:
        return
    named: set[str] = set()
    for f, share in zip(item.state.hertz, item.state.modes.platform_energy, strict=True):
        robot = share >= VISIBLE
        word = "model: robot" if robot else "model: cables"
        if low <= f <= high:
            label = None if word in named else word
            axes.axvline(f, color="black" if robot else GREY, linewidth=0.9 if robot else 0.4, zorder=1, label=label)
            named.add(word)


def unfitted_peaks(item: Identified) -> np.ndarray:
    """Frequencies (p,) [Hz] of peaks that stand out of the spectrum, and that no identified mode stands for."""
    hertz, size = _spectrum(item)
    if not len(item.modes):
        return np.zeros(0)
    found, _ = find_peaks(np.log(size), height=np.log(_ABOVE), prominence=np.log(_STANDS_OUT))
    apart = np.abs(hertz[found][:, None] - item.modes.hertz).min(axis=1)
    result: np.ndarray = hertz[found][apart > _NEAR * hertz[found]]
    return result


def _spectrum(item: Identified) -> tuple[np.ndarray, np.ndarray]:
    record = item.record
    noise = np.where(item.modes.noise > 0.0, item.modes.noise, np.inf)
    if record.kind == "frf":
        return record.axis, np.maximum(np.linalg.norm(record.signal / noise, axis=1), 1e-12)
    n = len(record.axis)
    windowed = (record.signal - record.signal.mean(axis=0)) * np.hanning(n)[:, None]
    size = np.linalg.norm(np.abs(np.fft.rfft(windowed, 4 * n, axis=0)) / noise, axis=1) / np.sqrt(n)
    step = float(record.axis[-1] - record.axis[0]) / (n - 1)
    return np.fft.rfftfreq(4 * n, step), np.maximum(size, 1e-12)


def _band(item: Identified, hertz: np.ndarray) -> tuple[float, float]:
    if not len(item.modes):
        return float(hertz[1]), float(hertz[-1])
    return max(0.3 * float(item.modes.hertz.min()), float(hertz[1])), min(1.3 * item.modes.hertz.max(), hertz[-1])


def draw_damping(figure: Figure, rows: DampingRows) -> None:
    """Damping ratio of each mode in each window over its amplitude, and what the entered law says."""
    axes = figure.subplots()
    drawn = 0
    for number in dict.fromkeys(rows.mode.tolist()):
        own = np.flatnonzero((rows.mode == number) & np.isfinite(rows.amplitude))
        if own.size:
            own = own[np.argsort(rows.amplitude[own])]
            colour, marker = _COLOURS[drawn % len(_COLOURS)], _MARKERS[drawn // len(_COLOURS) % len(_MARKERS)]
            label = f"{rows.case[own[0]]}, {rows.hertz[own[0]]:.2f} Hz" if drawn < _MOST_NAMED else None
            bars, millimetres = 200.0 * rows.sigma[own], 1e3 * rows.amplitude[own]
            axes.errorbar(
                millimetres, 100.0 * rows.ratio[own], bars, color=colour, marker=marker, markersize=4, linewidth=0.9,
                label=label,
            )  # fmt: skip
            law = "entered law" if drawn == 0 else None
            axes.plot(millimetres, 100.0 * rows.entered[own], "_", color=colour, markersize=12, label=law)
            drawn += 1
    axes.set_xscale("log")
    axes.set_xlabel("amplitude of the platform point [mm]")
    axes.set_ylabel("damping ratio [%]")
    plain_ticks(axes.xaxis)
    if drawn:
        columns = 1 + min(drawn, _MOST_NAMED) // 13
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), ncols=columns, fontsize=7.5, borderaxespad=0.0)
    quiet(axes)

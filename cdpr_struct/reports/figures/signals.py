"""Measured spectra with identified peaks and the model's modes, and damping ratios over amplitude."""

import numpy as np
from matplotlib.figure import Figure

from cdpr_struct.diagnosis.damping_rows import DampingRows
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.signal_states import VISIBLE
from cdpr_struct.reports.figures.style import BLUE, GREY, ORANGE, quiet

SPECTRUM_SIZE, DAMPING_SIZE = (9.6, 3.2), (9.6, 3.4)


def draw_spectrum(figure: Figure, item: Identified) -> None:
    """Spectrum of one record, all channels together in units of their noise."""
    axes = figure.subplots()
    hertz, size = _spectrum(item)
    modes = item.modes
    low, high = _band(item, hertz)
    inside = (hertz >= low) & (hertz <= high)
    if item.state is not None:
        for f, share in zip(item.state.hertz, item.state.modes.platform_energy, strict=True):
            if low <= f <= high:
                axes.axvline(f, color="black" if share >= VISIBLE else GREY, linewidth=0.9 if share >= VISIBLE else 0.4)
    axes.semilogy(hertz[inside], size[inside], color=BLUE, linewidth=0.9)
    height = np.interp(modes.hertz, hertz, size)
    seen = (modes.hertz >= low) & (modes.hertz <= high)
    used, left = item.used & seen, ~item.used & seen
    axes.plot(modes.hertz[used], height[used], "o", color=BLUE, markersize=5, label="joined the campaign")
    axes.plot(modes.hertz[left], height[left], "o", mfc="none", color=ORANGE, markersize=5, label="did not")
    axes.set_xlim(low, high)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("response [1/its noise]")
    axes.legend(loc="upper right", ncols=2)
    quiet(axes)


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
    """Damping ratio of each mode in each window over its amplitude."""
    axes = figure.subplots()
    for number in dict.fromkeys(rows.mode.tolist()):
        own = np.flatnonzero((rows.mode == number) & np.isfinite(rows.amplitude))
        if own.size:
            own = own[np.argsort(rows.amplitude[own])]
            bars = 200.0 * rows.sigma[own]
            axes.errorbar(1e3 * rows.amplitude[own], 100.0 * rows.ratio[own], bars, marker=".", linewidth=0.9)
    axes.set_xscale("log")
    axes.set_xlabel("amplitude of the platform point [mm]")
    axes.set_ylabel("damping ratio [%]")
    quiet(axes)

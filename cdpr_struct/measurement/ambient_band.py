"""From which to which frequency an ambient record is analysed, and the record thinned to that band."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter
from scipy.signal import butter, decimate, find_peaks, sosfiltfilt

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.ambient_choice import AmbientChoice
from cdpr_struct.measurement.subspace_poles import spectral_density

PERIODS = 100.0  # of the lowest frequency in a record, at least
PER_SAMPLE_RATE = 0.4  # highest frequency in sampling rates: above it filters of recorders and of thinning bend spectra
_AVERAGES = 20  # parts of the record for its spectral density
_STANDS_OUT = 6.0  # times the scatter of a density's logarithm: the height of a peak over the dips beside it
_BEYOND = 1.25  # of the highest peak: top of the band
_WIDE = 0.1  # of all lines: window of the level that peaks stand above


@dataclass(frozen=True, slots=True, eq=False)
class Spectrum:
    """Singular values (f, c), descending, of the spectral density of c channels over lines hertz (f,) [Hz]."""

    hertz: np.ndarray
    values: np.ndarray


def spectrum_of(signal: np.ndarray, step: float) -> Spectrum:
    """Spectrum of a signal (n, c), each channel in units of its own standard deviation.

    step : between samples [s]
    """
    segment = 2 ** int(np.log2(max(2.0 * len(signal) / _AVERAGES, 16.0)))
    return Spectrum(*spectral_density((signal - signal.mean(axis=0)) / signal.std(axis=0), step, segment))


def band_of(spectrum: Spectrum, choice: AmbientChoice, step: float, count: int, fewest: int) -> tuple[float, float]:
    """Band [Hz] that is analysed: the user's, or up to a quarter above the highest peak that stands out.

    step : between samples [s];  count : of samples;  fewest : that the thinned record must have

    Raises
    ------
    InputError : a band or wanted frequencies that the record does not hold.
    """
    lowest, highest = PERIODS / (step * count), PER_SAMPLE_RATE / step
    asked = choice.frequencies if choice.band is None else choice.band
    if asked and max(asked) > highest * (1.0 + 1e-9):
        expected = f"sampling at {max(asked) / PER_SAMPLE_RATE:.4g} Hz or more for modes up to {max(asked):g} Hz"
        expected += f", or frequencies up to {highest:.4g} Hz"
        raise InputError("sampling rate", "", f"{1.0 / step:.4g} Hz", expected)
    if asked and 0.0 < min(asked) < lowest * (1.0 - 1e-9):
        expected = (
            f"{PERIODS / min(asked):.4g} s or more for modes from {min(asked):g} Hz: {PERIODS:g} of their periods"
        )
        raise InputError("duration", "", f"{step * count:.4g} s", expected)
    if choice.band is not None:
        return max(choice.band[0], lowest), choice.band[1]
    top = max([_highest_peak(spectrum, lowest), *choice.frequencies])
    least = max(2.0 * lowest, PER_SAMPLE_RATE * fewest / (step * count))
    return lowest, float(np.clip(_BEYOND * top, least, highest)) if top > 0.0 else highest


def _highest_peak(spectrum: Spectrum, lowest: float) -> float:
    """Highest frequency [Hz] above the lowest one at which the first singular value stands out; 0 if none does."""
    level = np.log(np.maximum(spectrum.values[:, 0], 1e-300))
    wide = 2 * int(0.5 * _WIDE * len(level)) + 1
    scatter = 1.0 / np.sqrt(1.5 * _AVERAGES)
    found, _ = find_peaks(level - median_filter(level, wide, mode="nearest"), prominence=_STANDS_OUT * scatter)
    hertz = spectrum.hertz[found]
    return float(hertz[hertz > lowest].max(initial=0.0))


def thinned(signal: np.ndarray, step: float, band: tuple[float, float]) -> tuple[np.ndarray, float]:
    """The signal (n, c) without what is far below the band, and with no more samples than the band needs.

    Returns the signal and the step between its samples [s].
    """
    every = int(PER_SAMPLE_RATE / (step * band[1]))
    slow = butter(2, 0.25 * band[0], "highpass", fs=1.0 / step, output="sos")
    moving = sosfiltfilt(slow, signal, axis=0)
    return (decimate(moving, every, ftype="fir", axis=0), step * every) if every > 1 else (moving, step)

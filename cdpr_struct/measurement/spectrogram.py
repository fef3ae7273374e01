"""Which frequencies a vibration holds, and when."""

from dataclasses import dataclass

import numpy as np
from scipy.fft import next_fast_len
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

_OVERLAP = 8  # windows that cover each instant
_WINDOWS = 6.0  # default: windows in the record, side by side


@dataclass(frozen=True, slots=True, eq=False)
class Spectrogram:
    """Power density over time and frequency.

    time, hertz : (t,) [s] and (f,) [Hz]
    density     : (f, t, c) power spectral density of each channel [(unit)^2/Hz]
    window      : length of the analysis window [s]; its main lobe is 4 / window wide [Hz]
    """

    time: np.ndarray
    hertz: np.ndarray
    density: np.ndarray
    window: float

    def total(self) -> np.ndarray:
        """(f, t) density of all channels together."""
        return self.density.sum(axis=2)


def spectrogram(time: np.ndarray, signal: np.ndarray, window: float | None = None) -> Spectrogram:
    """Short-time Fourier transform with a Hann window.

    Parameters
    ----------
    time : (n,) evenly spaced [s]
    signal : (n, c) channels; their means are taken out
    window : [s]; default a sixth of the record

    Raises
    ------
    ValueError : a window shorter than eight samples or longer than the record.
    """
    step = float(time[-1] - time[0]) / (len(time) - 1)
    wanted = len(time) / _WINDOWS if window is None else window / step
    count = max(round(wanted), 8 if window is None else 0)
    if not 8 <= count <= len(time):
        raise ValueError(f"the window must be between {8 * step:.4g} and {len(time) * step:.4g} s, got {window!r} s")
    hop = max(count // _OVERLAP, 1)
    transform = ShortTimeFFT(
        hann(count, sym=False),
        hop,
        1.0 / step,
        fft_mode="onesided2X",
        mfft=next_fast_len(4 * count, real=True),
        scale_to="psd",
    )
    density = transform.spectrogram(signal - signal.mean(axis=0), axis=0)
    density = np.moveaxis(density, -1, 1)
    inside = (transform.t(len(time)) >= 0.0) & (transform.t(len(time)) <= time[-1] - time[0])
    return Spectrogram(time[0] + transform.t(len(time))[inside], transform.f, density[:, inside], count * step)


def dominant_frequency(time: np.ndarray, signal: np.ndarray) -> float:
    """Frequency [Hz] of the highest peak of the power spectrum of all channels together; nan for a dead signal.

    signal : (n, c). Hann window over the whole record, zero-padded, a parabola through the logarithm of the peak.
    """
    step = float(time[-1] - time[0]) / (len(time) - 1)
    size = next_fast_len(8 * len(time), real=True)
    windowed = (signal - signal.mean(axis=0)) * hann(len(time), sym=False)[:, None]
    power = (np.abs(np.fft.rfft(windowed, size, axis=0)) ** 2).sum(axis=1)
    peak = int(power[1:-1].argmax()) + 1
    if not power[peak] > 0.0:
        return float("nan")
    before, here, after = np.log(np.maximum(power[peak - 1 : peak + 2], np.finfo(float).tiny))
    bend = before - 2.0 * here + after
    shift = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
    return float((peak + np.clip(shift, -1.0, 1.0)) / (size * step))

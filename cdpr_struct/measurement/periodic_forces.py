"""Which poles are no modes but periodic forces: motors, fans, mains.

A mode under random forces has the amplitudes of narrow-band noise, kurtosis 3; a sine has kurtosis 1.5 (Jacobsen,
Andersen and Brincker, 2007).
"""

import numpy as np
from scipy.stats import kurtosis

_HARDLY_DAMPED = 0.002  # ratio: a sine looks less damped than that, most modes do not
_SINE = 2.0  # kurtosis, nearer to that of a sine than to that of noise
_WIDTHS, _LINES = 3.0, 10.0  # half of the band around a pole: half-widths of its peak, or lines of the record


def periodic_forces(signal: np.ndarray, step: float, hertz: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """(k,) bool: poles at hertz (k,) with damping ratios (k,) in a signal (n, c) that are sines.

    step : between samples [s]
    """
    lines = np.fft.rfftfreq(len(signal), step)
    spectrum = np.fft.rfft(signal, axis=0)
    found = np.zeros(len(hertz), dtype=bool)
    for i in np.flatnonzero(damping < _HARDLY_DAMPED):
        half = max(_WIDTHS * damping[i] * hertz[i], _LINES / (len(signal) * step))
        near = np.abs(lines - hertz[i]) <= half
        alone = np.fft.irfft(np.where(near[:, None], spectrum, 0.0), len(signal), axis=0)
        loudest = alone[:, alone.var(axis=0).argmax()]
        found[i] = kurtosis(loudest, fisher=False) < _SINE
    return found

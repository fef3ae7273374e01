"""The same modes in successive windows of a decay: does frequency or damping change with the amplitude?"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.measurement.decay_modes import refine
from cdpr_struct.measurement.modal_estimate import Modes

WINDOWS = 3
_CYCLES = 4.0  # of the slowest mode in a window, at least
_FEWEST = 48
_CLEAR = 5.0  # amplitude over its sigma below which a mode is not read in a window


@dataclass(frozen=True, slots=True, eq=False)
class AmplitudeWindows:
    """w windows of a decay with k modes; nan where a mode is not clear.

    middle : (w,) [s];  hertz, hertz_sigma, damping, damping_sigma : (w, k) [Hz], [-]
    amplitude : (w, k, c) of each channel in the middle of the window, in its unit
    """

    middle: np.ndarray
    hertz: np.ndarray
    hertz_sigma: np.ndarray
    damping: np.ndarray
    damping_sigma: np.ndarray
    amplitude: np.ndarray

    def scatter(self) -> np.ndarray:
        """(k,) by how much the frequency varies from window to window beyond its sigma: 1 or more (Birge's ratio)."""
        return _birge(self.hertz, self.hertz_sigma)

    def damping_scatter(self) -> np.ndarray:
        """(k,) the same of the damping ratio."""
        return _birge(self.damping, self.damping_sigma)


def amplitude_windows(time: np.ndarray, signal: np.ndarray, modes: Modes, slowest: float) -> AmplitudeWindows:
    """Modes (k,) of a decay (n,), (n, c) in up to three windows of equal length, each of
    four cycles of `slowest` [Hz] or more.
    """
    k, c = len(modes), signal.shape[1]
    span = float(time[-1] - time[0])
    count = WINDOWS
    while count > 1 and (k == 0 or span / count * slowest < _CYCLES or len(time) // count < _FEWEST):
        count -= 1
    parts = [p for p in np.array_split(np.arange(len(time)), count) if k and count > 1]
    found = [_window(time[p], signal[p], modes) for p in parts]
    if not found:
        empty = np.zeros((0, k))
        return AmplitudeWindows(np.zeros(0), empty, empty, empty, empty, np.zeros((0, k, c)))
    middle = np.array([time[p].mean() for p in parts])
    return AmplitudeWindows(middle, *(np.stack([f[i] for f in found]) for i in range(5)))


def _window(time: np.ndarray, signal: np.ndarray, modes: Modes) -> tuple[np.ndarray, ...]:
    own = refine(time, signal, modes.poles)
    pair = np.array([np.abs(np.log(own.hertz / f)).argmin() for f in modes.hertz])
    own = own.take(pair)
    unclear = (own.strength < _CLEAR) | (np.abs(np.log(own.hertz / modes.hertz)) > 0.03)
    unclear |= (own.damping <= -3.0 * own.damping_sigma) | (own.hertz_sigma > 0.03 * own.hertz)
    fall = np.exp(-own.damping * 2.0 * np.pi * own.hertz * 0.5 * float(time[-1] - time[0]))
    amplitude = np.abs(own.shape) * fall[:, None]
    values = [own.hertz, own.hertz_sigma, own.damping, own.damping_sigma]
    return (*(np.where(unclear, np.nan, v) for v in values), np.where(unclear[:, None], np.nan, amplitude))


def _birge(value: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    ratio = np.ones(value.shape[1])
    for i in range(value.shape[1]):
        known = np.isfinite(value[:, i])
        if known.sum() > 1:
            weight = 1.0 / sigma[known, i] ** 2
            mean = (weight * value[known, i]).sum() / weight.sum()
            chi2 = float((weight * (value[known, i] - mean) ** 2).sum())
            ratio[i] = max(1.0, np.sqrt(chi2 / (known.sum() - 1)))
    return ratio

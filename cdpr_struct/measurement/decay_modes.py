"""Modes of a free decay: every channel is a sum of the same damped sines about a rest that may drift.

Starting poles come from the eigensystem realisation of one Hankel matrix (Juang and Pappa 1985) at every model order;
each order is then fitted by least squares, and the order is that of the smallest Bayesian information criterion. The
standard deviations are those of maximum likelihood, scaled by the residual's own spectrum around each mode: noise need
not be white, but what is not noise (an amplitude-dependent frequency) must be seen by comparing windows.
"""

import numpy as np

from cdpr_struct.measurement.modal_estimate import Modes, modes_from_poles
from cdpr_struct.measurement.peak_kinds import shadows
from cdpr_struct.measurement.separable_fit import SeparableFit, separable_fit

MOST_MODES = 10
LARGEST_DAMPING = 0.2
_ROWS, _COLUMNS, _SIZE = 120, 700, 480  # of the Hankel matrix: block rows, columns, rows in all
_PEAK = 30.0  # times the median of the spectrum: above it there is a vibration
_PATIENCE = 2  # orders without improvement after which the search ends
_NEIGHBOURS = 12  # spectral bins on either side of a mode that tell the noise there
_LEAST_STRENGTH = 6.0
_DRIFT = 2  # degree of the rest in time


def decay_modes(time: np.ndarray, signal: np.ndarray, most: int = MOST_MODES) -> Modes:
    """Modes of a free decay.

    Parameters
    ----------
    time : (n,) evenly spaced [s];  signal : (n, c) channels that vibrate together, any units
    most : largest number of modes

    Modes that are not clear (growing, damped by more than 0.2, weaker than 6 of their standard deviations, slower than
    one period in the record) are left out.
    """
    step = float(time[-1] - time[0]) / (len(time) - 1)
    clock = step * np.arange(len(time))
    spread = signal.std(axis=0)
    alive = spread > 1e-12 * max(float(spread.max()), 1e-300)
    if not alive.any():
        return _none(signal.shape[1])
    target, weight = signal[:, alive], 1.0 / spread[alive][None]
    best = _best_order(clock, target, weight, most)
    if best is None:
        return _none(signal.shape[1])
    noise = np.maximum(best.residual.std(axis=0) / weight[0], 1e-9 * spread[alive])
    for _ in range(2):
        best = separable_fit(_Decays(clock), target, 1.0 / noise[None], best.poles)
        noise = np.maximum(noise * best.residual.std(axis=0), 1e-9 * spread[alive])
    found = _estimates(clock, best, noise, alive)
    found = found.take(np.flatnonzero(~shadows(found)))
    return _clear(found, 1.0 / clock[-1])


def refilled(time: np.ndarray, signal: np.ndarray, lost: np.ndarray, poles: np.ndarray) -> np.ndarray:
    """The signal (n, c) with what damped sines of known poles (k,), fitted to all other samples, have where some (n,)
    were lost."""
    columns = _Decays(time - time[0])(poles)[0]
    linear = np.linalg.lstsq(columns[~lost], signal[~lost], rcond=None)[0]
    return np.where(lost[:, None], columns @ linear, signal)


def refine(time: np.ndarray, signal: np.ndarray, start: np.ndarray) -> Modes:
    """The same modes in another record (a window), from known poles (k,); none is left out."""
    step = float(time[-1] - time[0]) / (len(time) - 1)
    clock, spread = step * np.arange(len(time)), signal.std(axis=0)
    alive = spread > 1e-12 * max(float(spread.max()), 1e-300)
    noise = spread[alive]
    for _ in range(3):
        fit = separable_fit(_Decays(clock), signal[:, alive], 1.0 / noise[None], start)
        noise = np.maximum(noise * fit.residual.std(axis=0), 1e-9 * spread[alive])
    return _estimates(clock, fit, noise, alive)


class _Decays:
    """Columns of damped sines, and of a rest that may drift (a parabola)."""

    def __init__(self, clock: np.ndarray) -> None:
        self.clock = clock
        self.rest = np.polynomial.legendre.legvander(2.0 * clock / clock[-1] - 1.0, _DRIFT)

    def __call__(self, poles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        n, k = len(self.clock), len(poles)
        grown = np.clip(poles.real[None] * self.clock[:, None], None, 50.0)
        wave = np.exp(grown + 1j * poles.imag[None] * self.clock[:, None])
        slope = wave * self.clock[:, None]
        columns = np.concatenate([np.zeros((n, 2 * k)), self.rest], axis=1)
        columns[:, 0 : 2 * k : 2], columns[:, 1 : 2 * k : 2] = wave.real, -wave.imag
        slopes = np.zeros((2 * k, n, 2))
        for i in range(k):
            real, imag = slope[:, i].real, slope[:, i].imag
            slopes[2 * i, :, 0], slopes[2 * i, :, 1] = real, -imag
            slopes[2 * i + 1, :, 0], slopes[2 * i + 1, :, 1] = -imag, -real
        return columns, slopes


def _best_order(clock: np.ndarray, signal: np.ndarray, weight: np.ndarray, most: int) -> SeparableFit | None:
    """The fit of the best order to the signal, thinned to what its frequencies need."""
    every = _thinning(clock, signal * weight)
    short, few = clock[::every], signal[::every]
    basis, vectors = _Decays(short), _hankel_basis(few * weight)
    best, waited = None, 0
    for order in range(1, most + 1):
        start = _realised(vectors, few.shape[1], order, float(short[1] - short[0]))
        start = start[_plausible(start, short)]
        if not len(start):
            continue
        fit = _physical_fit(basis, few, weight, start)
        if fit is None:
            continue
        if best is None or fit.criterion() < best.criterion() - 2.0:
            best, waited = fit, 0
        else:
            waited += 1
            if waited > _PATIENCE:
                break
    return best


def _physical_fit(basis: _Decays, signal: np.ndarray, weight: np.ndarray, start: np.ndarray) -> SeparableFit | None:
    """The fit after poles that grow, hardly swing, are slower than a period, or double another were left out."""
    for _ in range(len(start)):
        fit = separable_fit(basis, signal, weight, start)
        good = _plausible(fit.poles, basis.clock)
        if good.all():
            spread = np.maximum(fit.residual.std(axis=0) / weight[0], 1e-9 / weight[0])
            found = _estimates(basis.clock, fit, spread, np.ones(signal.shape[1], dtype=bool))
            doubled = found.poles[shadows(found)]
            good = np.abs(fit.poles[:, None] - doubled).min(axis=1, initial=np.inf) > 1e-9 * np.abs(fit.poles)
        if good.all():
            return fit
        start = fit.poles[good]
        if not len(start):
            return None
    return None


def _plausible(poles: np.ndarray, clock: np.ndarray) -> np.ndarray:
    damped, size = -poles.real, np.abs(poles)
    period, step = clock[-1], clock[1] - clock[0]
    fast = poles.imag > 2.0 * np.pi / period
    good: np.ndarray = (np.abs(poles.real) * period < 50.0) & (damped > -0.005 * size)
    good &= damped < 1.5 * LARGEST_DAMPING * size
    return good & fast & (poles.imag < 0.95 * np.pi / step)


def _thinning(clock: np.ndarray, signal: np.ndarray) -> int:
    """Every how many samples still hold the highest frequency that stands out, three times over."""
    power = _spectrum(signal).sum(axis=1)
    high = np.flatnonzero(power > _PEAK * np.median(power))
    top = max(int(high.max()) if high.size else len(power), 4)
    most = max(len(clock) // 100, 1)
    return int(np.clip(len(power) // (3 * top), 1, most))


def _spectrum(signal: np.ndarray) -> np.ndarray:
    """Periodogram (f, c), Hann window."""
    window = np.hanning(len(signal))[:, None]
    power: np.ndarray = np.abs(np.fft.rfft((signal - signal.mean(axis=0)) * window, axis=0)) ** 2
    return power


def _hankel_basis(signal: np.ndarray) -> np.ndarray:
    """Left singular vectors of the block Hankel matrix (rows c, ...)."""
    n, c = signal.shape
    rows = max(min(_ROWS, _SIZE // c, n // 2), 2)
    columns = min(n - rows, _COLUMNS)
    centred = (signal - signal.mean(axis=0)).T
    hankel = np.concatenate([centred[:, i : i + columns] for i in range(rows)])
    vectors: np.ndarray = np.linalg.svd(hankel, full_matrices=False)[0]
    return vectors


def _realised(vectors: np.ndarray, channels: int, order: int, step: float) -> np.ndarray:
    """Poles [rad/s] of the eigensystem realisation with 2 order states, those that swing and hardly grow."""
    basis = vectors[:, : 2 * order]
    transition = np.linalg.lstsq(basis[:-channels], basis[channels:], rcond=None)[0]
    discrete = np.linalg.eigvals(transition)
    poles: np.ndarray = np.log(discrete[np.abs(discrete) > 1e-6].astype(complex)) / step
    return poles


def _estimates(clock: np.ndarray, fit: SeparableFit, noise: np.ndarray, alive: np.ndarray) -> Modes:
    k, c = len(fit.poles), len(alive)
    shape = np.zeros((k, c), dtype=complex)
    shape[:, alive] = fit.linear[0 : 2 * k : 2] + 1j * fit.linear[1 : 2 * k : 2]
    level = np.array([_local_noise(clock, fit, pole) for pole in fit.poles])
    spread = np.repeat(np.sqrt(level), 2)
    covariance = fit.covariance * spread[:, None] * spread[None]
    energy = (np.abs(shape[:, alive]) / noise) ** 2
    cycles = np.array([np.sum(np.exp(np.clip(2.0 * p.real * clock, None, 50.0))) for p in fit.poles])
    strength = np.sqrt(0.5 * energy.sum(axis=1) * cycles / level / alive.sum())
    whole = np.zeros(c)
    whole[alive] = noise
    return modes_from_poles(fit.poles, covariance, shape, strength, whole)


def _local_noise(clock: np.ndarray, fit: SeparableFit, pole: complex) -> float:
    """Variance density of the residual around a mode, in units of white noise of unit variance; at least 1."""
    n, c = fit.residual.shape
    power = np.abs(np.fft.rfft(fit.residual, axis=0)) ** 2 / n
    bin_width = 2.0 * np.pi / (n * float(clock[1] - clock[0]))
    middle, reach = pole.imag / bin_width, max(_NEIGHBOURS, 3.0 * abs(pole.real) / bin_width)
    low, high = max(int(middle - reach), 1), min(int(middle + reach) + 1, len(power))
    near = power[low:high]
    if not near.size:
        return 1.0
    inside = (np.abs(fit.poles.imag / bin_width - middle) < reach).sum()
    free = max(2.0 * near.size - inside * (2.0 + 2.0 * c), 0.5 * near.size)
    return max(float(2.0 * near.sum() / free), 1.0)


def _clear(found: Modes, slowest: float) -> Modes:
    good = (found.damping < LARGEST_DAMPING) & (found.damping > -2.0 * found.damping_sigma)
    good &= (found.strength > _LEAST_STRENGTH) & (found.hertz > slowest) & (found.hertz_sigma < 0.03 * found.hertz)
    return found.take(np.flatnonzero(good))


def _none(channels: int) -> Modes:
    return modes_from_poles(
        np.zeros(0, dtype=complex), np.zeros((0, 0)), np.zeros((0, channels), dtype=complex), np.zeros(0),
        np.zeros(channels),
    )  # fmt: skip

"""Modes of frequency responses: all channels of one state share their poles.

Starting poles are those of the least-squares complex-frequency estimator (Guillaume et al. 2003) that keep their place
from one polynomial order to the next. They are then fitted together with residues and a smooth remainder by weighted
least squares; each line's weight follows from the residuals around it, so that noise that grows with the response or
with frequency is weighed as what it is. Standard deviations are those of that fit.
"""

import numpy as np
from scipy.optimize import nnls

from cdpr_struct.measurement.modal_estimate import Modes, modes_from_poles
from cdpr_struct.measurement.separable_fit import SeparableFit, separable_fit

LARGEST_DAMPING = 0.2
_ORDERS = (12, 16, 20, 26, 32, 40)
_SAME = (0.01, 0.3)  # relative change of a stable pole's frequency and damping between orders
_LEAST_STABLE = 3  # orders
_AT_ONCE, _TRIES = 8, 2  # poles added where the fit misses something; how often at one place
_TOGETHER, _CERTAIN = 0.3, 4.5  # correlation of neighbouring residuals that noise does not have; in its sigma
_NEIGHBOURS = 15  # lines on either side among which a mode would show in the residuals
_REACH = 60  # lines on either side that tell how noisy this part of the band is
_ROUNDS, _FEW_ROUNDS = 4, 3  # of weighing, in the final fit and before
_ROUGH, _FEW = 1e-4, 12  # relative change of the squares, and evaluations, with which a fit ends that is not final
_LEAST_STRENGTH = 6.0


def response_modes(hertz: np.ndarray, response: np.ndarray) -> Modes:
    """Modes of accelerances.

    Parameters
    ----------
    hertz : (f,) ascending [Hz];  response : (f, c) complex, acceleration over force

    `shape` of the result holds residues: the response is the sum of shape / (i omega - pole), conjugates included,
    plus a remainder.
    """
    omega = 2.0 * np.pi * hertz
    size = np.sqrt((np.abs(response) ** 2).mean(axis=0))
    alive = size > 1e-12 * max(float(size.max()), 1e-300)
    poles = starting_poles(omega, response[:, alive] / size[alive]) if alive.any() else np.zeros(0, dtype=complex)
    basis, parts = _Resonances(omega), np.concatenate([response.real, response.imag])[:, alive]
    even = np.broadcast_to(1.0 / size[alive], parts.shape)
    tried, final = np.zeros(0, dtype=complex), False
    found = _none(len(alive))
    while len(poles):
        fit, weight = _weighed_fit(basis, parts, even, poles, final)
        found = _estimates(basis, fit, weight, alive)
        good = _clear(found, hertz) & ~_doubled(found)
        found, all_clear = found.take(np.flatnonzero(good)), bool(good.all())
        missed = _overlooked(omega, fit, tried) if all_clear else []
        settled = all_clear and not missed
        if final and settled:
            break
        poles, tried, final = np.append(found.poles, missed), np.append(tried, missed), settled
    return found


def _weighed_fit(
    basis: "_Resonances", parts: np.ndarray, weight: np.ndarray, poles: np.ndarray, final: bool
) -> tuple[SeparableFit, np.ndarray]:
    """Fit whose weights (2f, c) are one over the noise that its own residuals show; a rough one unless it is final."""
    lines = len(parts) // 2
    for _ in range(_ROUNDS if final else _FEW_ROUNDS):
        fit = separable_fit(basis, parts, weight, poles, _ROUGH, _FEW)
        poles, left = fit.poles, fit.residual / weight
        answer = parts - left
        power = 0.5 * (left[:lines] ** 2 + left[lines:] ** 2)
        spread = np.sqrt(_noise(power, answer[:lines] ** 2 + answer[lines:] ** 2))
        weight = 1.0 / np.concatenate([spread, spread])
    return (separable_fit(basis, parts, weight, poles) if final else fit), weight


def _noise(power: np.ndarray, squared: np.ndarray) -> np.ndarray:
    """(f, c) variance of each line: a share of the response and a floor, times what the lines around it show.

    power, squared : (f, c) of the residuals (half of real and imaginary part together) and of the fitted response
    """
    model = np.empty_like(power)
    for i in range(power.shape[1]):
        size = max(float(power[:, i].mean()), 1e-300)
        model[:, i] = size
        for _ in range(_ROUNDS):
            columns = np.stack([squared[:, i], np.full(len(power), size)], axis=1) / model[:, [i]]
            share = nnls(columns, power[:, i] / model[:, i])[0]
            model[:, i] = np.maximum(share[0] * squared[:, i] + share[1] * size, 1e-12 * size)
    ratio = power / model
    total = np.concatenate([np.zeros((1, power.shape[1])), np.cumsum(ratio, axis=0)])
    place = np.arange(len(power))
    low, high = np.maximum(place - _REACH, 0), np.minimum(place + _REACH + 1, len(power))
    around = (total[high] - total[low]) / (high - low)[:, None]
    found: np.ndarray = model * np.maximum(around, 1e-6)
    return found


def _clear(found: Modes, hertz: np.ndarray) -> np.ndarray:
    good = (found.strength > _LEAST_STRENGTH) & (found.damping > 0.0) & (found.damping < LARGEST_DAMPING)
    inside = (found.hertz > hertz[0]) & (found.hertz < hertz[-1]) & (found.hertz_sigma < 0.03 * found.hertz)
    clear: np.ndarray = good & inside
    return clear


def _doubled(found: Modes) -> np.ndarray:
    """(k,) whether a mode is the weaker of two whose peaks are one: nearer than the narrower's half-width."""
    width = -found.poles.real
    near = np.abs(found.poles.imag[:, None] - found.poles.imag) < np.minimum(width[:, None], width)
    doubled: np.ndarray = (near & (found.strength[:, None] < found.strength)).any(axis=1)
    return doubled


def _overlooked(omega: np.ndarray, fit: SeparableFit, tried: np.ndarray) -> list[complex]:
    """A few poles where neighbouring residuals go together, as those of noise do not, and not tried often before."""
    lines = len(omega)
    residual = fit.residual[:lines] + 1j * fit.residual[lines:]
    together = (residual[1:] * np.conj(residual[:-1])).real.sum(axis=1)
    alone = (np.abs(residual) ** 2).sum(axis=1)
    window = np.ones(2 * _NEIGHBOURS + 1)
    share = np.convolve(together, window, "same") / np.convolve(0.5 * (alone[1:] + alone[:-1]), window, "same")
    limit = max(_CERTAIN / np.sqrt(2.0 * len(window) * residual.shape[1]), _TOGETHER)
    apart, found = 0.5 * _NEIGHBOURS * (omega[1] - omega[0]), list[complex]()
    while share.max() >= limit and len(found) < _AT_ONCE:
        place = int(share.argmax())
        low, high = max(place - _NEIGHBOURS, 0), min(place + _NEIGHBOURS + 1, lines)
        pole = _near(omega, residual, low + int(alone[low:high].argmax()))
        if (np.abs(tried.imag - pole.imag) < apart).sum() < _TRIES:
            found.append(pole)
        share[max(place - 2 * _NEIGHBOURS, 0) : place + 2 * _NEIGHBOURS + 1] = -np.inf
    return found


def _near(omega: np.ndarray, response: np.ndarray, peak: int) -> complex:
    """The stable pole nearest to a peak, of the lines about it alone; a lightly damped one where there is none."""
    part = slice(max(peak - _REACH, 0), peak + _REACH + 1)
    poles = stable_poles(omega[part], response[part])
    apart = np.abs(poles.imag - omega[peak])
    good = poles.size and apart.min() < _NEIGHBOURS * (omega[1] - omega[0])
    return complex(poles[apart.argmin()]) if good else complex(omega[peak] * (-0.01 + 1j))


def starting_poles(omega: np.ndarray, response: np.ndarray) -> np.ndarray:
    """Stable poles (k,) [rad/s] of the whole band, or, where it is too wide to show any, of halves, quarters, ..."""
    kept, width = list(stable_poles(omega, response)), len(omega) // 2
    while not kept and width >= 2 * _REACH:
        for low in range(0, len(omega) - width // 2, width // 2):
            part = slice(low, low + width)
            own = stable_poles(omega[part], response[part])
            kept += [pole for pole in own if not any(_same(pole, other) for other in kept)]
        width //= 2
    return np.array(kept, dtype=complex)


def stable_poles(omega: np.ndarray, response: np.ndarray) -> np.ndarray:
    """Poles (k,) [rad/s] that at least three polynomial orders agree on; response (f, c)."""
    orders = [order for order in _ORDERS if 2 * order < len(omega)]
    found = [_polynomial_poles(omega, response, order) for order in orders]
    kept: list[complex] = []
    for own in reversed(found):
        for pole in own:
            near = [other[np.abs(other - pole).argmin()] for other in found if len(other)]
            agree = [o for o in near if _same(o, pole)]
            if len(agree) >= _LEAST_STABLE and not any(_same(pole, k) for k in kept):
                kept.append(complex(np.median(np.real(agree)) + 1j * np.median(np.imag(agree))))
    return np.array(kept, dtype=complex)


def _same(one: complex, other: complex) -> bool:
    frequency = abs(abs(one) / abs(other) - 1.0)
    return frequency < _SAME[0] and abs(one.real - other.real) < max(_SAME[1] * abs(other.real), 2e-3 * abs(other))


def _polynomial_poles(omega: np.ndarray, response: np.ndarray, order: int) -> np.ndarray:
    """Poles of the common denominator of one order, in the z domain of the band."""
    span = omega[-1] - omega[0]
    powers = np.exp(-1j * np.pi * np.outer((omega - omega[0]) / span, np.arange(order + 1)))
    own = (powers.conj().T @ powers).real
    total = np.zeros((order + 1, order + 1))
    for channel in response.T:
        with_answer = -channel[:, None] * powers
        cross = (powers.conj().T @ with_answer).real
        total += (with_answer.conj().T @ with_answer).real - cross.T @ np.linalg.solve(own, cross)
    tail = np.linalg.lstsq(total[:-1, :-1], -total[:-1, -1], rcond=None)[0]
    roots = np.roots(np.concatenate([[1.0], tail[::-1]]))
    roots = roots[np.abs(roots) > 1e-9].astype(complex)
    poles = -np.log(roots) * span / np.pi + 1j * omega[0]
    poles = np.where(poles.imag < omega[0], np.conj(poles - 1j * omega[0]) + 1j * omega[0], poles)
    good = (poles.real < 0.0) & (-poles.real < LARGEST_DAMPING * np.abs(poles))
    good &= (poles.imag > omega[0]) & (poles.imag < omega[-1])
    result: np.ndarray = poles[good]
    return result


class _Resonances:
    """Columns of resonances with their conjugates and of a smooth remainder, real parts above imaginary ones."""

    def __init__(self, omega: np.ndarray) -> None:
        self.omega = omega
        x = omega / omega[-1]
        one, zero = np.ones_like(x), np.zeros_like(x)
        self.rest = np.stack([_stack(one, zero), _stack(x**2, zero), _stack(x**4, zero), _stack(zero, x)], axis=1)

    def __call__(self, poles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        k, n = len(poles), 2 * len(self.omega)
        columns = np.concatenate([np.zeros((n, 2 * k)), self.rest], axis=1)
        slopes = np.zeros((2 * k, n, 2))
        for i, pole in enumerate(poles):
            near, far = 1.0 / (1j * self.omega - pole), 1.0 / (1j * self.omega - np.conj(pole))
            columns[:, 2 * i] = _parts(near + far)
            columns[:, 2 * i + 1] = _parts(1j * (near - far))
            together, apart = _parts(near**2 + far**2), _parts(1j * (near**2 - far**2))
            slopes[2 * i, :, 0], slopes[2 * i, :, 1] = together, apart
            slopes[2 * i + 1, :, 0], slopes[2 * i + 1, :, 1] = apart, -together
        return columns, slopes


def _stack(real: np.ndarray, imag: np.ndarray) -> np.ndarray:
    return np.concatenate([real, imag])


def _parts(value: np.ndarray) -> np.ndarray:
    return _stack(value.real, value.imag)


def _estimates(basis: _Resonances, fit: SeparableFit, weight: np.ndarray, alive: np.ndarray) -> Modes:
    k = len(fit.poles)
    shape = np.zeros((k, len(alive)), dtype=complex)
    shape[:, alive] = fit.linear[0 : 2 * k : 2] + 1j * fit.linear[1 : 2 * k : 2]
    columns = basis(fit.poles)[0]
    strength = np.zeros(k)
    for i in range(k):
        own = columns[:, 2 * i : 2 * i + 2] @ fit.linear[2 * i : 2 * i + 2]
        strength[i] = np.sqrt(((weight * own) ** 2).sum() / alive.sum())
    noise = np.zeros(len(alive))
    noise[alive] = np.median(1.0 / weight, axis=0)
    return modes_from_poles(fit.poles, fit.covariance, shape, strength, noise)


def _none(channels: int) -> Modes:
    none = np.zeros(0, dtype=complex)
    return modes_from_poles(
        none, np.zeros((0, 0)), np.zeros((0, channels), dtype=complex), none.real, np.zeros(channels)
    )

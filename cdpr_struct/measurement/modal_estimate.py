"""What a vibration signal says about modes: frequency, damping, shape and size, each with how sure it is."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """k modes identified in one signal of c channels, in ascending order.

    hertz, hertz_sigma     : (k,) undamped natural frequency |pole| / 2 pi [Hz]
    damping, damping_sigma : (k,) damping ratio [-]
    shape     : (k, c) complex, amplitude of each channel at the start of the signal, in its own unit
    strength  : (k,) amplitude over its own standard deviation
    noise     : (c,) standard deviation of what no mode explains, per sample or line
    """

    hertz: np.ndarray
    hertz_sigma: np.ndarray
    damping: np.ndarray
    damping_sigma: np.ndarray
    shape: np.ndarray
    strength: np.ndarray
    noise: np.ndarray

    def __len__(self) -> int:
        return len(self.hertz)

    @property
    def poles(self) -> np.ndarray:
        """(k,) [rad/s]."""
        omega = 2.0 * np.pi * self.hertz
        return omega * (-self.damping + 1j * np.sqrt(1.0 - self.damping**2))

    def take(self, index: np.ndarray) -> "Modes":
        """Some of the modes."""
        return Modes(
            self.hertz[index], self.hertz_sigma[index], self.damping[index], self.damping_sigma[index],
            self.shape[index], self.strength[index], self.noise,
        )  # fmt: skip


def modes_from_poles(
    poles: np.ndarray, covariance: np.ndarray, shape: np.ndarray, strength: np.ndarray, noise: np.ndarray
) -> Modes:
    """Modes of poles whose real and imaginary parts have a covariance (2k, 2k)."""
    omega, ratio = np.abs(poles), -poles.real / np.abs(poles)
    hertz_sigma, damping_sigma = np.zeros(len(poles)), np.zeros(len(poles))
    for i, pole in enumerate(poles):
        own = covariance[2 * i : 2 * i + 2, 2 * i : 2 * i + 2]
        size = np.array([pole.real, pole.imag]) / omega[i]
        turn = np.array([-(pole.imag**2), pole.real * pole.imag]) / omega[i] ** 3
        hertz_sigma[i] = np.sqrt(max(size @ own @ size, 0.0)) / (2.0 * np.pi)
        damping_sigma[i] = np.sqrt(max(turn @ own @ turn, 0.0))
    order = np.argsort(omega)
    found = Modes(omega / (2.0 * np.pi), hertz_sigma, ratio, damping_sigma, shape, strength, noise)
    return found.take(order)

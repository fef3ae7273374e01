"""How the cables lose energy: one law, two numbers per frequency and cable.

In steady vibration exp(i omega t) a cable with stiffness operator K and mass operator M answers with

    elasticity K - inertia M,      K_dyn = elasticity * K_undamped(inertia / elasticity),

so a damped cable is the undamped one at a complex frequency, whatever the cable model. `docs/damping.md` derives it.
A law is passive if, for omega > 0, Im(inertia) <= 0 and Im(elasticity) >= 0.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cdpr_struct.generated.cable_dsm import damped_omega_squared


class DampingLaw(Protocol):
    """A law of cable damping."""

    @property
    def constant_rates(self) -> bool:
        """Whether `rates` are the same at every frequency: then the law is a differential equation in time."""

    def inertia(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        """(..., m) complex factor of the cables' mass [rad^2/s^2].

        omega : (..., 1), or (..., m) with the same value m times;  first_frequency : (m,); both [rad/s]
        """

    def elasticity(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        """(..., m) complex factor of the cables' stiffness [-]."""


@dataclass(frozen=True, slots=True)
class Undamped:
    """No loss at all."""

    constant_rates: bool = True

    def inertia(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return omega**2 + np.zeros_like(first_frequency)

    def elasticity(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return np.ones(np.broadcast_shapes(np.shape(omega), first_frequency.shape))


@dataclass(frozen=True, slots=True, eq=False)
class Viscous:
    """The thesis's law: a medium at rest that brakes every piece of cable in proportion to its velocity and mass.

    ratio : (m,) xi [-], referred to the first natural frequency omega_1 of each clamped cable;
            inertia = omega^2 - 2 i xi omega_1 omega, eq. (2.39)
    """

    ratio: np.ndarray
    constant_rates: bool = True

    def inertia(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        massive = np.isfinite(first_frequency)
        return damped_omega_squared(omega, self.ratio, np.where(massive, first_frequency, 0.0))

    def elasticity(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return Undamped().elasticity(omega, first_frequency)


@dataclass(frozen=True, slots=True)
class Hysteretic:
    """Constant loss factor of the cable's whole stiffness: elasticity = 1 + i eta. Steady vibration only.

    loss_factor : eta [-]
    """

    loss_factor: float
    constant_rates: bool = False

    def inertia(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return Undamped().inertia(omega, first_frequency)

    def elasticity(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        moving = np.where(omega > 0.0, 1.0, 0.0)
        return 1.0 + 1j * self.loss_factor * moving + np.zeros_like(first_frequency, dtype=complex)


@dataclass(frozen=True, slots=True)
class Rayleigh:
    """Losses in proportion to mass and to stiffness: inertia = omega^2 - i a omega, elasticity = 1 + i b omega.

    mass_rate      : a [1/s]
    stiffness_time : b [s]
    """

    mass_rate: float
    stiffness_time: float
    constant_rates: bool = True

    def inertia(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return omega**2 - 1j * self.mass_rate * omega + np.zeros_like(first_frequency, dtype=complex)

    def elasticity(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return 1.0 + 1j * self.stiffness_time * omega + np.zeros_like(first_frequency, dtype=complex)


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """Loss factor that changes with frequency: elasticity = 1 + i eta (omega / omega_ref)^p. Steady vibration only.

    loss_factor     : eta [-] at the reference
    exponent        : p [-]; 0 hysteretic, 1 viscous losses in the material, negative if losses fade with frequency
    reference_omega : omega_ref [rad/s], or None for the first natural frequency of each clamped cable
    """

    loss_factor: float
    exponent: float
    reference_omega: float | None = None
    constant_rates: bool = False

    def inertia(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        return Undamped().inertia(omega, first_frequency)

    def elasticity(self, omega: np.ndarray, first_frequency: np.ndarray) -> np.ndarray:
        own = first_frequency if self.reference_omega is None else np.full_like(first_frequency, self.reference_omega)
        if not np.isfinite(own).all():
            raise ValueError("massless cables have no first natural frequency: give PowerLaw.reference_omega")
        moving = np.asarray(omega) > 0.0
        ratio = np.where(moving, omega, 1.0) / own
        return 1.0 + 1j * self.loss_factor * np.where(moving, ratio**self.exponent, 0.0)


@dataclass(frozen=True, slots=True)
class ModalDamping:
    """Damping ratios of the robot's own modes, platform and cables together. It is no law of the single cable.

    ratios : zeta [-] of the modes 1, 2, .. of the robot, each in [0, 1); the last one holds for all higher modes
    """

    ratios: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.ratios or not all(0.0 <= ratio < 1.0 for ratio in self.ratios):
            raise ValueError(f"ModalDamping.ratios must be numbers in [0, 1), got {self.ratios!r}")

    def of_modes(self, count: int) -> np.ndarray:
        """(count,) ratio of each of the first modes."""
        last = len(self.ratios) - 1
        return np.array([self.ratios[min(i, last)] for i in range(count)])


Damping = DampingLaw | ModalDamping


def rates(law: DampingLaw, omega: np.ndarray, first_frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Equivalent viscous damping C_i = a_i M_i + b_i K_i of each cable: a (..., m) [1/s] and b (..., m) [s].

    omega : (..., 1) > 0 [rad/s], where the losses are to agree; exact at every frequency if `law.constant_rates`
    """
    mass_rate = -np.imag(law.inertia(omega, first_frequency)) / omega
    return mass_rate, np.imag(law.elasticity(omega, first_frequency)) / omega

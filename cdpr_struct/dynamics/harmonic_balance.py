"""Free motion of a conservative system by harmonic balance: one or several nonlinear modes swinging together.

The coordinates are u(t) = sum of c_k cos(k . tau), tau = Omega t, over integer vectors k of n fundamental
frequencies Omega. A motion that is reversible in time and at rest at t = 0 has no sines. Galerkin's equations, the
mean of cos(k . tau) r over all phases for each k, and the given size of the fundamentals fix the c_k and Omega (Nayfeh
and Mook, Nonlinear Oscillations, 1979, section 2.3.4); they are solved by Newton's method with the exact Jacobian.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Protocol

import numpy as np

from cdpr_struct.errors import ConvergenceError

_FIRST, _SMALLEST = 0.25, 1.0 / 64.0  # of the whole size, by which the motion grows
_ITERATIONS = 12
_ASTRAY = 10.0  # a step as many times the motion's size is the last
_CONVERGED = 1e-8  # last step, of the size of the motion and of the frequencies
_UNRESOLVED = 3  # samples per phase beyond twice the largest order


class Swinging(Protocol):
    """A conservative system of f coordinates u, its rest at u = 0."""

    def linearised(
        self, u: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Inertia minus force (g, f) at g instants, and its derivatives (g, f, f) by u, velocity and acceleration."""


@dataclass(frozen=True, slots=True, eq=False)
class Harmonics:
    """Cosines of n phases up to an order.

    numbers : (h, n) integer vectors k, of k and -k one;  cosine, sine : (g, h) at g samples that stand for all phases
    """

    numbers: np.ndarray
    cosine: np.ndarray
    sine: np.ndarray

    @classmethod
    def of(cls, phases: int, order: int) -> "Harmonics":
        """All k with |k_1| + .. + |k_n| <= order."""
        every = product(*(range(-order, order + 1) for _ in range(phases)))
        kept = [k for k in every if sum(map(abs, k)) <= order and next((x for x in k if x), 1) > 0]
        numbers = np.array(sorted(kept, key=lambda k: sum(map(abs, k))))
        half = order + _UNRESOLVED
        first = np.pi * (np.arange(half) + 0.5) / half  # the other half runs backwards in time
        others = np.pi * (np.arange(2 * half) + 0.5) / half
        grid = np.meshgrid(first, *[others] * (phases - 1), indexing="ij")
        angle = np.stack([axis.ravel() for axis in grid], axis=-1) @ numbers.T
        return cls(numbers, np.cos(angle), np.sin(angle))

    def fundamental(self, phase: int) -> int:
        """Row of the harmonic that has this phase alone, once."""
        wanted = np.arange(self.numbers.shape[1]) == phase
        return int(np.flatnonzero((self.numbers == wanted).all(axis=1))[0])

    def motion(self, coefficients: np.ndarray, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """u, velocity and acceleration (g, f) of coefficients (h, f) at frequencies (n,) [rad/s]."""
        rate = (self.numbers @ omega)[:, None]
        return (
            self.cosine @ coefficients,
            -self.sine @ (rate * coefficients),
            -self.cosine @ (rate**2 * coefficients),
        )


@dataclass(frozen=True, slots=True, eq=False)
class FreeMotion:
    """omega (n,) [rad/s] and coefficients (h, f) of the harmonics of a free motion."""

    harmonics: Harmonics
    omega: np.ndarray
    coefficients: np.ndarray


def free_motion(
    system: Swinging, omega: np.ndarray, modes: Sequence[int], sizes: np.ndarray, order: int, first: float = _FIRST
) -> FreeMotion:
    """The motion in which the fundamentals of some coordinates have given sizes.

    Parameters
    ----------
    omega : (f,) frequencies of small motion; the coordinates of `system` are its modes [rad/s]
    modes : n coordinates, each with a fundamental frequency of its own
    sizes : (n,) amplitudes of their fundamentals, in the unit of the coordinates
    order : of the harmonics kept;  first : share of the sizes that is tried first

    Raises
    ------
    ConvergenceError : no such motion was found: it is too large, or its modes exchange energy.
    """
    harmonics = Harmonics.of(len(modes), order)
    found = FreeMotion(harmonics, np.asarray(omega)[list(modes)], np.zeros((len(harmonics.numbers), len(omega))))
    done, step = 0.0, first
    while done < 1.0:
        whole = min(1.0, done + step)
        next_, left = _balanced(system, _grown(found, modes, np.asarray(sizes), done, whole), modes, sizes)
        if next_ is None:
            step *= 0.5
            if step < _SMALLEST:
                hint = "The motion is too large for its modes to stay apart: take a smaller amplitude."
                raise ConvergenceError(f"free motion beyond {done:.3g} of the amplitude", left, _ITERATIONS, hint)
        else:
            found, done = next_, whole
    return found


def _grown(found: FreeMotion, modes: Sequence[int], sizes: np.ndarray, done: float, share: float) -> FreeMotion:
    """A guess at a share of the sizes, from the motion at the share that is done: harmonics grow by their order."""
    harmonics, order = found.harmonics, np.abs(found.harmonics.numbers).sum(axis=1)
    power = np.where(order == 0, 2, order)
    grown = found.coefficients * ((share / done if done else 0.0) ** power)[:, None]
    for phase, mode in enumerate(modes):
        grown[harmonics.fundamental(phase), mode] = share * sizes[phase]
    return FreeMotion(harmonics, found.omega, grown)


def _balanced(
    system: Swinging, start: FreeMotion, modes: Sequence[int], sizes: np.ndarray
) -> tuple[FreeMotion | None, float]:
    """Newton's method with the fundamentals as they are; None if it does not converge, and the last step's size."""
    harmonics, omega, coefficients = start.harmonics, start.omega, start.coefficients
    fixed = [harmonics.fundamental(a) * coefficients.shape[1] + mode for a, mode in enumerate(modes)]
    free, left = np.setdiff1d(np.arange(coefficients.size), fixed), np.inf
    for _ in range(_ITERATIONS):
        balance, by_coefficients, by_omega = _equations(system, harmonics, coefficients, omega)
        try:
            step = np.linalg.solve(np.concatenate([by_coefficients[:, free], by_omega], axis=1), -balance)
        except np.linalg.LinAlgError:  # two motions meet here
            break
        changed = np.zeros(coefficients.size)
        changed[free] = step[: len(free)]
        coefficients, omega = coefficients + changed.reshape(coefficients.shape), omega + step[len(free) :]
        left = float(max(np.abs(changed).max() / np.abs(sizes).max(), np.abs(step[len(free) :] / omega).max()))
        if not left < _ASTRAY or not (omega > 0.0).all():
            break
        if left < _CONVERGED:
            return FreeMotion(harmonics, omega, coefficients), left
    return None, left


def _equations(
    system: Swinging, harmonics: Harmonics, coefficients: np.ndarray, omega: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Galerkin's equations (h f,) and their derivatives by coefficients (h f, h f) and by omega (h f, n)."""
    motion = harmonics.motion(coefficients, omega)
    residual, by_place, by_speed, by_acceleration = system.linearised(*motion)
    cosine, sine, numbers = harmonics.cosine, harmonics.sine, harmonics.numbers
    mean, rate, size = cosine.T / len(cosine), numbers @ omega, coefficients.size
    balance = (mean @ residual).ravel()
    columns = np.einsum("gij,gl->gilj", by_place, cosine) - np.einsum("gij,gl->gilj", by_speed, sine * rate)
    columns -= np.einsum("gij,gl->gilj", by_acceleration, cosine * rate**2)
    jacobian = (mean @ columns.reshape(len(cosine), -1)).reshape(size, size)
    speed = np.einsum("gl,lf,ln->gfn", -sine, coefficients, numbers)
    acceleration = np.einsum("gl,lf,ln->gfn", -2.0 * cosine * rate, coefficients, numbers)
    turned = by_speed @ speed + by_acceleration @ acceleration
    return balance, jacobian, (mean @ turned.reshape(len(cosine), -1)).reshape(size, -1)

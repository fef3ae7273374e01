"""Every natural frequency of the robot, with a count that proves that none is missing.

Wittrick and Williams: the number of natural frequencies below omega is the number of those of the clamped cables
plus the number of negative eigenvalues of the platform's dynamic stiffness, and of the masts' if they give way, plus
the freedoms of parts that move in the platform whose own frequencies are below.
Bisection on this count isolates each frequency, whatever its multiplicity; a scan for determinant minima cannot.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.internal_mass import internal_count, with_internal_mass
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    inertia_of_platform,
    platform_dynamic_stiffness,
    platform_mass_matrix,
    platform_static_stiffness,
    stability_at,
)
from cdpr_struct.errors import CdprError, UnstableEquilibriumError
from cdpr_struct.statics.guides import free_block
from cdpr_struct.statics.masts import negative_junctions

_HALVINGS = 52
_HOPELESS_OMEGA = 1e6


@dataclass(frozen=True, slots=True, eq=False)
class NaturalFrequencies:
    """The first k natural frequencies, multiplicities repeated; neutral freedoms come first, at zero.

    hertz         : (k,) ascending
    bracket_hertz : (k, 2) interval over which the exact count passes the number of the frequency: the proof that none
                    is missing
    """

    hertz: np.ndarray
    bracket_hertz: np.ndarray

    @property
    def certified(self) -> bool:
        """The count encloses every frequency within a millionth."""
        width = self.bracket_hertz[:, 1] - self.bracket_hertz[:, 0]
        return bool((width <= 1e-6 * self.hertz).all())

    @classmethod
    def in_brackets(cls, bracket_hertz: np.ndarray) -> "NaturalFrequencies":
        """From intervals that overlap where frequencies are nearly equal.

        What an earlier number has above a lower end, all later ones have, and the reverse: ends taken from neighbours
        keep the proof, and put the frequencies in order.
        """
        low = np.maximum.accumulate(bracket_hertz[:, 0])
        high = np.minimum.accumulate(bracket_hertz[::-1, 1])[::-1]
        return cls(0.5 * (low + high), np.stack([low, high], axis=-1))


def count_below(
    point: OperatingPoint, cables: CableDynamics, omega: np.ndarray, assembly: Assembly = "consistent"
) -> np.ndarray:
    """Number of natural frequencies of the robot below each omega (k,) [rad/s] at one pose."""
    omega = np.asarray(omega, dtype=float)[..., None]
    stiffness = platform_dynamic_stiffness(point, cables, omega**2, assembly)
    dynamic = stiffness - inertia_of_platform(point, omega[..., 0] ** 2)
    negative = (np.linalg.eigvalsh(dynamic) < 0.0).sum(axis=-1)
    robot = point.arrays
    if robot.has_masts:
        ends, moving = cables.stiffness(omega**2), cables.mast_stiffness(omega**2)
        negative = negative + negative_junctions(ends, robot, moving)
    return negative + cables.clamped_count(omega).sum(axis=-1) + internal_count(robot, omega[..., 0] ** 2)


def natural_frequencies(
    point: OperatingPoint, cables: CableDynamics, count: int, assembly: Assembly = "consistent"
) -> NaturalFrequencies:
    """First `count` undamped natural frequencies of the robot, by bisection of the count alone.

    Slow and independent of any eigenproblem; `certified_modes` gives the same numbers quickly.

    Raises
    ------
    UnstableEquilibriumError : the lowest "frequencies" are not real.
    CdprError : the model has fewer than `count` frequencies (massless cables: six, and one for each freedom of a moving
        part).
    """
    held = stability_at(point, assembly)
    if held.unstable:
        raise UnstableEquilibriumError("the equilibrium is unstable: the platform's stiffness has negative eigenvalues")
    bracket, neutral = np.zeros((count, 2)), min(int(held.neutral), count)
    if neutral < count:
        number = np.arange(neutral + 1, count + 1)
        bracket[neutral:] = np.stack(bisect_count(point, cables, number, assembly), axis=-1)
    return NaturalFrequencies.in_brackets(bracket / (2.0 * np.pi))


def bisect_count(
    point: OperatingPoint, cables: CableDynamics, number: np.ndarray, assembly: Assembly, precision: float = 1e-15
) -> tuple[np.ndarray, np.ndarray]:
    """Brackets low, high (k,) [rad/s] of the frequencies with these numbers (k,): fewer than `number` below low,
    `number` or more below high, relative width 2 `precision` or what rounding allows."""
    high = np.full(len(number), highest_omega(point, cables, int(number.max()), assembly))
    low = np.zeros(len(number))
    for _ in range(_HALVINGS):
        if (high - low <= 2.0 * precision * low).all():
            break
        middle = 0.5 * (low + high)
        below = count_below(point, cables, middle, assembly) < number
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return low, high


def highest_omega(point: OperatingPoint, cables: CableDynamics, count: int, assembly: Assembly = "consistent") -> float:
    """An omega [rad/s] with at least `count` natural frequencies below it."""
    high = float(min(np.min(cables.first_frequency), 100.0))
    while int(count_below(point, cables, np.array([high]), assembly)[0]) < count:
        high *= 1.3
        if high > _HOPELESS_OMEGA:
            raise CdprError(f"this cable model has fewer than {count} natural frequencies below {high:.1e} rad/s")
    return high


def static_frequencies(point: OperatingPoint, assembly: Assembly = "consistent") -> np.ndarray:
    """Frequencies [Hz] of the platform on massless cables (K_static), one a free direction and one more for each
    freedom of a moving part; zero for neutral freedoms, nan where the stiffness is negative."""
    rigid = platform_static_stiffness(point, assembly), platform_mass_matrix(point.arrays, point.rotation)
    pencil = with_internal_mass(point.arrays, point.rotation, *rigid)
    stiffness, mass = (free_block(matrix, point.arrays) for matrix in pencil)
    lower = np.linalg.inv(np.linalg.cholesky(mass))
    squared, held = np.linalg.eigvalsh(lower @ stiffness @ lower.T), stability_at(point, assembly)
    neutral = np.argsort(np.abs(squared))[: int(held.neutral)]
    squared[neutral] = 0.0
    return np.sort(np.sqrt(np.where(squared >= 0.0, squared, np.nan)) / (2.0 * np.pi))

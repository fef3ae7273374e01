"""Modes of the robot, quickly, and with the proof that none is missing.

An ordinary eigenproblem gives frequencies and shapes to many digits. Each frequency is then corrected with the model's
own dynamic stiffness and enclosed in a bracket over which the Wittrick-Williams count passes its number. Where that
fails, bisection on the count takes over. Where only frequencies are asked for, `pose_frequencies` comes first.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics, CableModel, cable_dynamics
from cdpr_struct.dynamics.internal_mass import internal_squared
from cdpr_struct.dynamics.natural_frequencies import NaturalFrequencies, bisect_count, count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.pose_frequencies import quick_frequencies
from cdpr_struct.dynamics.ritz_modes import RitzModes, ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly, platform_dynamic_stiffness
from cdpr_struct.errors import CdprError

_BRACKET = 1e-9
_MARGIN = 1.15
_ATTEMPTS = 12


@dataclass(frozen=True, slots=True, eq=False)
class CertifiedModes:
    """The first k modes: certified frequencies, and shapes with their energies."""

    frequencies: NaturalFrequencies
    shapes: RitzModes
    cables: CableDynamics


def certified_modes(
    point: OperatingPoint, model: CableModel, count: int, assembly: Assembly = "consistent"
) -> CertifiedModes:
    """First `count` undamped modes of the robot at rest.

    Raises
    ------
    UnstableEquilibriumError : a small motion of the platform would grow.
    CdprError : the model has fewer modes (massless cables: six, and one for each freedom of a moving part).
    """
    return certified(point, *_enough_modes(point, model, count, assembly), assembly)


def certified_frequencies(
    point: OperatingPoint, model: CableModel, count: int, assembly: Assembly = "consistent"
) -> NaturalFrequencies:
    """The frequencies of `certified_modes` without shapes; of taut exact cables in a fraction of the time.

    Raises
    ------
    UnstableEquilibriumError, CdprError : as `certified_modes`.
    """
    quick = quickly_certified(point, count, assembly) if model == "exact" else None
    return certified_modes(point, model, count, assembly).frequencies if quick is None else quick


def quickly_certified(
    point: OperatingPoint, count: int, assembly: Assembly = "consistent"
) -> NaturalFrequencies | None:
    """The frequencies of exact cables where `quick_frequencies` proves them, else None."""
    omega = quick_frequencies(point, count, _BRACKET, assembly)
    if omega is None:
        return None
    bracket = omega[:, None] * (1.0 + _BRACKET * np.array([-1.0, 1.0]))
    return NaturalFrequencies.in_brackets(bracket / (2.0 * np.pi))


def certified(
    point: OperatingPoint, cables: CableDynamics, shapes: RitzModes, assembly: Assembly = "consistent"
) -> CertifiedModes:
    """The model's natural frequencies near those of Ritz modes, enclosed by the count, and the shapes in their order.

    The correction may exchange frequencies that are equal but for rounding. The count at the first one above zero
    proves that there are no more neutral freedoms, whose frequency is zero.
    """
    every = _corrected(point, cables, shapes, assembly)
    order = np.argsort(every, kind="stable")
    every, shapes = every[order], shapes.modes(order)
    neutral = int((every == 0.0).sum())
    omega = every[neutral:]
    if not len(omega):
        return CertifiedModes(NaturalFrequencies.in_brackets(np.zeros((neutral, 2))), shapes, cables)
    low, high = omega * (1.0 - _BRACKET), omega * (1.0 + _BRACKET)
    number = np.arange(neutral + 1, len(every) + 1)
    low_count, high_count = np.split(count_below(point, cables, np.concatenate([low, high]), assembly), 2)
    open_ = ~((low_count < number) & (high_count >= number))
    if open_.any():
        low[open_], high[open_] = bisect_count(point, cables, number[open_], assembly, _BRACKET)
    brackets = np.concatenate([np.zeros((neutral, 2)), np.stack([low, high], axis=-1)])
    return CertifiedModes(NaturalFrequencies.in_brackets(brackets / (2.0 * np.pi)), shapes, cables)


def _enough_modes(
    point: OperatingPoint, model: CableModel, count: int, assembly: Assembly
) -> tuple[CableDynamics, RitzModes]:
    """The cable model and its Ritz modes, resolved up to the last mode that is asked for."""
    highest = _expected_highest(point, model, count)
    for _ in range(_ATTEMPTS):
        cables = cable_dynamics(point, model, highest)
        shapes = ritz_modes(point, cables.expansion(highest), count, assembly)
        if len(shapes.omega) == count and (model == "static" or shapes.omega[-1] <= highest):
            return cables, shapes
        if model == "static":
            break
        highest *= 1.5
    raise CdprError(f"this cable model has fewer than {count} natural frequencies")


def _expected_highest(point: OperatingPoint, model: CableModel, count: int) -> float:
    """An omega [rad/s] with about `count` frequencies below it: two string modes per half wave and cable."""
    if model == "static":
        return 0.0
    first = np.pi / point.cables.chord * np.sqrt(point.cables.tension / point.arrays.linear_density)
    strings = np.sort(np.outer(first, np.arange(1, count + 1)).ravel())
    return _MARGIN * float(strings[(count - 1) // 2])


def _corrected(point: OperatingPoint, cables: CableDynamics, shapes: RitzModes, assembly: Assembly) -> np.ndarray:
    """One step of Newton's method on shape^T D(omega^2) shape, whose slope is minus the unit modal mass.

    Motions of parts inside the platform are unknowns of their own in it.
    """
    squared = shapes.omega**2
    stiffness = platform_dynamic_stiffness(point, cables, squared[:, None], assembly)
    residual = np.einsum("ki,kij,kj->k", shapes.platform, stiffness, shapes.platform)
    residual += (internal_squared(point.arrays) * shapes.internal**2).sum(axis=-1)
    step = residual - squared * shapes.platform_energy
    return np.sqrt(np.where(np.abs(step) < 1e-5 * squared, squared + step, squared))

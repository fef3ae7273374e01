"""What a cause is: named parameters with priors, one function on worlds, and patterns of occurrence."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World

SCALES = (0.4, 1.0, 2.5)  # of the prior's sigma, equally likely: sizes are known to an order of magnitude only


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number of a cause.

    ratio : theta is the logarithm of a factor; reported as the factor
    squared : theta is the root of what is reported
    positive : theta below zero means nothing
    prior   : one sigma of theta
    """

    name: str
    unit: str
    prior: float
    ratio: bool = False
    squared: bool = False
    positive: bool = False

    def shown(self, theta: float, sigma: float) -> dict[str, float | str]:
        """Value, sigma and unit as they are reported."""
        if self.squared:
            return {"value": theta * abs(theta), "sigma": 2.0 * abs(theta) * sigma, "unit": self.unit}
        value = float(np.exp(theta)) if self.ratio else float(theta)
        return {"value": value, "sigma": float(sigma * value if self.ratio else sigma), "unit": self.unit}


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """How the basic parameters theta0 = basis @ theta of a cause occur together.

    weight : probability of this pattern among those of the cause
    """

    label: str
    basis: np.ndarray
    parameters: tuple[Parameter, ...]
    weight: float

    @property
    def prior(self) -> np.ndarray:
        """(d,) sigma of theta."""
        return np.array([p.prior for p in self.parameters])

    @property
    def lowest(self) -> np.ndarray:
        """(d,) lower bound of theta."""
        return np.array([0.0 if p.positive else -np.inf for p in self.parameters])


def always(setting: Setting) -> str:
    """Testable by default."""
    return ""


@dataclass(frozen=True, slots=True, eq=False)
class Cause:
    """A cause in the library.

    per_cable : parameters of one cable (`axes` of them each); the cause occurs in all cables alike, in one, or in
                each differently;  otherwise the parameters belong to the robot as a whole
    apply     : world with basic parameters theta0 (..., d0) put in
    seen_in   : blocks of residuals it shows in
    shapes    : (label, which basic parameters, probability) of the patterns of a cause that has its own
    needs     : why these data cannot show it, or ""
    sentence  : for a person, with {value} and {unit} of the first parameter
    """

    name: str
    title: str
    parameters: tuple[Parameter, ...]
    apply: Callable[[World, np.ndarray], World]
    per_cable: bool = False
    common: bool = True
    seen_in: tuple[str, ...] = ()
    needs: Callable[[Setting], str] = always
    sentence: str = ""
    separated_by: str = ""
    extension: str = ""
    count: Callable[[Setting], int] | None = field(default=None)
    shapes: tuple[tuple[str, slice, float], ...] = ()

    def basic(self, setting: Setting) -> tuple[Parameter, ...]:
        """Basic parameters of the cause for this campaign."""
        if self.count is not None:
            return tuple(
                Parameter(f"{p.name}_{i}", p.unit, p.prior, p.ratio, p.squared, p.positive)
                for i in range(1, self.count(setting) + 1)
                for p in self.parameters
            )
        if not self.per_cable:
            return self.parameters
        m = len(setting.campaign.robot.cables)
        return tuple(
            Parameter(f"{p.name}_{i}", p.unit, p.prior, p.ratio, p.squared, p.positive)
            for i in range(1, m + 1)
            for p in self.parameters
        )

    def patterns(self, setting: Setting) -> list[Pattern]:
        """Patterns of occurrence: all cables alike, each differently, one alone; or the only one."""
        basic = self.basic(setting)
        every = np.eye(len(basic))
        if self.shapes:
            return [Pattern(label, every[:, own], basic[own], weight) for label, own, weight in self.shapes]
        if self.count is not None:
            size = len(self.parameters)
            return [
                Pattern(
                    f"one, {i + 1}",
                    every[:, size * i : size * (i + 1)],
                    basic[size * i : size * (i + 1)],
                    size / len(basic),
                )
                for i in range(len(basic) // size)
            ]
        if not self.per_cable:
            return [Pattern("", every, basic, 1.0)]
        axes, m = len(self.parameters), len(basic) // len(self.parameters)
        alike = np.tile(np.eye(axes), (m, 1))
        shared = 0.4 if self.common else 0.0
        rest = 1.0 - shared
        found = [Pattern("all alike", alike, self.parameters, shared)] if self.common else []
        found.append(Pattern("each its own", every, basic, 0.5 * rest))
        for i in range(m):
            own = slice(axes * i, axes * (i + 1))
            found.append(Pattern(f"cable {i + 1} alone", every[:, own], basic[own], 0.5 * rest / m))
        return found


def by_cable(theta: np.ndarray, axes: int) -> np.ndarray:
    """(..., m * axes) as (..., m, axes)."""
    return theta.reshape((*theta.shape[:-1], -1, axes))

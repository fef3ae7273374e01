"""What a cause is: named parameters with priors, one function on worlds, and patterns of occurrence."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

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
    def one_sided(self) -> bool:
        """Whether it is one number that cannot be negative."""
        return len(self.parameters) == 1 and self.parameters[0].positive

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
    groups    : in place of single cables what has parameters of its own, cables of a mast or axes of the platform:
                ending of the parameter's name and words for each;  carrier : what they are, for the docs
    apply     : world with basic parameters theta0 (..., d0) put in
    seen_in   : blocks of residuals it shows in
    shapes    : (label, which basic parameters, probability) of the patterns of a cause that has its own
    sign      : what a number above zero means, for a person
    becomes   : causes that it is where some of its parameters are zero
    needs     : why these data cannot show it, or ""
    sentence  : for a person, with {value} and {unit} of the first parameter
    """

    name: str
    title: str
    parameters: tuple[Parameter, ...]
    apply: Callable[[World, np.ndarray], World]
    per_cable: bool = False
    groups: Callable[[Setting], dict[str, str]] | None = None
    carrier: str = "cable"
    common: bool = True
    seen_in: tuple[str, ...] = ()
    needs: Callable[[Setting], str] = always
    sentence: str = ""
    separated_by: str = ""
    extension: str = ""
    count: Callable[[Setting], int] | None = field(default=None)
    shapes: tuple[tuple[str, slice, float], ...] = ()
    becomes: tuple[str, ...] = ()
    sign: str = ""

    def basic(self, setting: Setting) -> tuple[Parameter, ...]:
        """Basic parameters of the cause for this campaign."""
        if self.count is not None:
            endings = [str(i) for i in range(1, self.count(setting) + 1)]
        elif self.per_cable:
            endings = list(self._carriers(setting))
        else:
            return self.parameters
        return tuple(replace(p, name=f"{p.name}_{ending}") for ending in endings for p in self.parameters)

    def _carriers(self, setting: Setting) -> dict[str, str]:
        """Ending of the parameter's name and words for each cable, or each group of cables."""
        if self.groups is not None:
            return self.groups(setting)
        return {str(i): f"cable {i}" for i in range(1, len(setting.campaign.robot.cables) + 1)}

    def patterns(self, setting: Setting) -> list[Pattern]:
        """Patterns of occurrence: all cables (or groups) alike, each differently, one alone; or the only one."""
        basic, axes = self.basic(setting), len(self.parameters)
        every = np.eye(len(basic))
        if self.shapes:
            return [Pattern(label, every[:, own], basic[own], weight) for label, own, weight in self.shapes]
        parts = [slice(axes * i, axes * (i + 1)) for i in range(len(basic) // axes)]
        if self.count is not None:
            n, states = len(parts), setting.campaign.states.names
            return [Pattern(f"case {states[i]}", every[:, own], basic[own], 1.0 / n) for i, own in enumerate(parts)]
        if len(parts) < 2:
            return [Pattern("", every, self.parameters, 1.0)]
        alike = np.tile(np.eye(axes), (len(parts), 1))
        shared = 0.4 if self.common else 0.0
        rest = 1.0 - shared
        found = [Pattern("all alike", alike, self.parameters, shared)] if self.common else []
        found.append(Pattern("each its own", every, basic, 0.5 * rest))
        for word, own in zip(self._carriers(setting).values(), parts, strict=True):
            found.append(Pattern(f"{word} alone", every[:, own], basic[own], 0.5 * rest / len(parts)))
        return found


def by_cable(theta: np.ndarray, axes: int) -> np.ndarray:
    """(..., m * axes) as (..., m, axes)."""
    return theta.reshape((*theta.shape[:-1], -1, axes))

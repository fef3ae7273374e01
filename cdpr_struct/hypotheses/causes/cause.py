"""What a cause is: named parameters with priors, one change of the robot, and patterns of occurrence."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays

A_MINUTE = 1.0 / 60.0
"""[h] Readings of a shorter time show nothing that grows with time: creep counts its decades after the first minute."""
ALIKE_IN = "all alike, axes "
"""How the label of a pattern begins in which all carriers are of one size, each in one of several ways."""
_ALONE = " alone"  # in the label of a pattern of one carrier


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number of a cause.

    ratio : theta is the logarithm of a factor; reported as the factor
    squared : theta is the root of what is reported
    positive : theta below zero means nothing
    prior   : one sigma of theta
    tried   : values at which a search begins too, beside zero or, of frequencies, those of peaks that belong to no mode
    least   : smallest size that occurs, of those of a cause in one of several ways
    most    : largest size of either sign that occurs at all
    in_band : a frequency, its prior in the highest one that was measured of the robot; no check bounds it
    """

    name: str
    unit: str
    prior: float
    ratio: bool = False
    squared: bool = False
    positive: bool = False
    in_band: bool = False
    tried: tuple[float, ...] = ()
    least: float = 0.0
    most: float = np.inf

    def shown(self, theta: float, sigma: float) -> dict[str, float | str]:
        """Value, sigma and unit as they are reported."""
        if self.squared:
            spread = float(np.hypot(2.0 * theta * sigma, np.sqrt(2.0) * sigma**2))
            return {"value": theta * abs(theta), "sigma": spread, "unit": self.unit}
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
    def positive(self) -> np.ndarray:
        """(d,) bool: theta below zero means nothing."""
        return np.array([p.positive for p in self.parameters])

    @property
    def in_band(self) -> np.ndarray:
        """(d,) bool: frequencies in the measured band."""
        return np.array([p.in_band for p in self.parameters])

    @property
    def of_one_carrier(self) -> bool:
        """Whether it is one number, of one cable, mast or axis."""
        return self.basis.shape[1] == 1 and _ALONE in self.label


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """What a campaign's data hold, for causes to say whether they can show there.

    kinds : of rows, as in `seen_in`;  tensions, lengths, poses : whether any was read
    relative : whether encoders count from an unknown start
    approach : whether directions are known;  hours : that the readings span
    cable_modes : how many different modes of a cable;  states : names
    highest : frequency measured of the robot [Hz], 0 without;  internal : whether the robot has an internal mass
    swinging : whether it has a mass that swings
    moving, pulling : whether some states are frames of a motion in which lengths, and in which tensions were read
    wheels, bare : whether some cables have pulleys in the robot file, and whether some have none
    groups : endings and words of what carries parameters of its own, by carrier ("cable", "mast", "axis", "state")
    """

    kinds: frozenset[str]
    tensions: bool
    lengths: bool
    approach: bool
    hours: float
    cable_modes: int
    states: tuple[str, ...]
    groups: Mapping[str, Mapping[str, str]]
    highest: float = 0.0
    internal: bool = False
    swinging: bool = False
    poses: bool = True
    relative: bool = False
    wheels: bool = False
    bare: bool = True
    moving: bool = False
    pulling: bool = False


def always(seen: Seen) -> str:
    """Testable by default."""
    return ""


@dataclass(frozen=True, slots=True, eq=False)
class Cause:
    """A cause in the library.

    apply     : robot (arrays) with basic parameters theta0 (..., d0) put in, (...) the batch axes of its fields
    carrier   : "" for parameters of the robot as a whole, else "cable", "mast", "axis" or "state": each has its own
    alike     : probability that all carriers have the same, 0 if that cannot be
    shapes    : (label, which basic parameters, probability) of the patterns of a cause that has its own
    fitted    : how many patterns are fitted, the likeliest first: more where slopes at zero do not tell them apart
    laws      : (words, which of its parameters, probability) where a carrier may follow one of several laws
    law_needs : by words of a law, why these data cannot tell it from others, or ""
    one_of    : words of the first parameters of each carrier, if these are ways to occur of which it has one; the last
                ones bend that way, and are in no pattern to begin with (see `choices.py`)
    along     : words, if the parameter after the ways goes along in half of the patterns
    seen_in   : kinds of rows it shows in;  needs : why these data cannot show it, or ""
    outside   : whether it sits in the data alone: the extended robot does not have it
    in_motion : whether it shows in proportion to speed, and not at rest
    becomes   : causes that it is where some of its parameters are zero
    sentence  : for a person, with {value} and {unit} of the first parameter;  sign : what a number above zero means
    senses    : words for {sense} where the mean of the numbers is above zero, and below it; {size} is its size
    separated_by : measurements that tell it from its rivals;  extension : what of the extended robot holds it
    """

    name: str
    title: str
    parameters: tuple[Parameter, ...]
    apply: Callable[[RobotArrays, np.ndarray], RobotArrays]
    carrier: str = ""
    alike: float = 0.4
    shapes: tuple[tuple[str, slice | list[int], float], ...] = ()
    fitted: int = 1
    laws: tuple[tuple[str, list[int], float], ...] = ()
    law_needs: Mapping[str, Callable[[Seen], str]] = field(default_factory=dict)
    one_of: tuple[str, ...] = ()
    along: str = ""
    seen_in: tuple[str, ...] = ()
    needs: Callable[[Seen], str] = always
    outside: bool = False
    in_motion: bool = False
    becomes: tuple[str, ...] = ()
    sentence: str = ""
    sign: str = ""
    senses: tuple[str, str] = ("more", "less")
    separated_by: str = ""
    extension: str = ""
    known: Mapping[str, float] = field(default_factory=dict)

    @property
    def tuned(self) -> bool:
        """Whether one of the parameters is a frequency: a mode more, which does nothing to first order from zero."""
        return any(p.in_band for p in self.parameters)

    @property
    def tried(self) -> tuple[float, ...]:
        """Frequencies [Hz] at which a search for it begins, whether or not peaks are near."""
        return tuple(hertz for p in self.parameters for hertz in p.tried if p.in_band)

    def basic(self, seen: Seen) -> tuple[Parameter, ...]:
        """Basic parameters of the cause for this campaign."""
        if not self.carrier:
            return self.parameters
        endings = seen.groups[self.carrier]
        return tuple(replace(p, name=f"{p.name}_{ending}") for ending in endings for p in self.parameters)

    def patterns(self, seen: Seen) -> list[Pattern]:
        """Patterns of occurrence: all carriers alike, each differently, one alone; or the only one."""
        basic, axes = self.basic(seen), len(self.parameters)
        every = np.eye(len(basic))
        if self.shapes:
            return [_of_some(label, every, basic, own, weight) for label, own, weight in self.shapes]
        if self.one_of:
            return [p for k in range(len(self.one_of)) for p in self.in_one_way(seen, [k] * (len(basic) // axes))]
        if len(basic) < 2 * axes:
            return [Pattern("", every, self.parameters, 1.0)]
        laws = [law for law in self.laws if not self.law_needs.get(law[0], always)(seen)]
        laws, whole = laws or [("", list(range(axes)), 1.0)], sum(law[2] for law in laws) or 1.0
        return [found for words, own, share in laws for found in self._of_law(seen, words, own, share / whole)]

    def in_one_way(self, seen: Seen, ways: Sequence[int]) -> list[Pattern]:
        """Each carrier in one of its ways, all of one size or each of its own, with what may go along and without."""
        basic, axes, endings = self.basic(seen), len(self.parameters), list(seen.groups[self.carrier])
        every, count = np.eye(len(basic)), len(self.one_of)
        starts = axes * np.arange(len(endings))
        words = self.one_of[ways[0]] if len(set(ways)) == 1 else ", ".join(self.one_of[k] for k in ways)
        each = every[:, starts + np.asarray(ways)]
        own = tuple(replace(self.parameters[0], name=f"{self.parameters[0].name}_{e}") for e in endings)
        sizes = (
            (f"{ALIKE_IN}{words}", each.sum(axis=1, keepdims=True), self.parameters[:1], self.alike / count),
            (f"each its own, axes {words}", each, own, (1.0 - self.alike) / count),
        )
        if not self.along:
            return [Pattern(*size) for size in sizes]
        more, free = every[:, starts + count], tuple(basic[i] for i in starts + count)
        found = [Pattern(label, basis, named, 0.5 * weight) for label, basis, named, weight in sizes]
        return found + [
            Pattern(
                f"{p.label}; {self.along}", np.concatenate([p.basis, more], axis=1), (*p.parameters, *free), p.weight
            )
            for p in found
        ]

    def _of_law(self, seen: Seen, law: str, own: list[int], share: float) -> list[Pattern]:
        """Patterns in which some of the parameters `own` of each carrier act, with a probability `share` together."""
        basic, axes, words = self.basic(seen), len(self.parameters), list(seen.groups[self.carrier].values())
        every, ending = np.eye(len(basic)), f", {law}" if law else ""
        places = [[axes * i + k for k in own] for i in range(len(words))]
        alone = share * (1.0 if self.carrier == "state" else 0.5 * (1.0 - self.alike))
        found = [
            Pattern(f"{word}{_ALONE}{ending}", every[:, at], tuple(basic[k] for k in at), alone / len(words))
            for word, at in zip(words, places, strict=True)
        ]
        if self.carrier == "state":
            return found
        if self.alike:
            same = np.tile(np.eye(axes)[:, own], (len(words), 1))
            alike = tuple(self.parameters[k] for k in own)
            found.append(Pattern(f"all alike{ending}", same, alike, share * self.alike))
        several = [k for at in places for k in at]
        each = tuple(basic[k] for k in several)
        return [*found, Pattern(f"each its own{ending}", every[:, several], each, share * 0.5 * (1.0 - self.alike))]


def _of_some(
    label: str, every: np.ndarray, basic: tuple[Parameter, ...], own: slice | list[int], weight: float
) -> Pattern:
    """Some of the basic parameters; several roots together are a vector, whose parts may be negative."""
    places = np.arange(len(basic))[own].tolist()
    some = [basic[i] for i in places]
    vector = sum(p.squared for p in some) > 1
    free = tuple(replace(p, positive=p.positive and not (vector and p.squared)) for p in some)
    return Pattern(label, every[:, places], free, weight)


def by_carrier(theta: np.ndarray, axes: int) -> np.ndarray:
    """(..., n * axes) as (..., n, axes)."""
    return theta.reshape((*theta.shape[:-1], -1, axes))

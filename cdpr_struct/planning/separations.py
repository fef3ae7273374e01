"""By how many nats is one cause told from another, now and with one more measurement?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.detectable_sizes import plainest
from cdpr_struct.hypotheses.causes.cause import Pattern
from cdpr_struct.hypotheses.detectable import NAMED, noncentrality
from cdpr_struct.hypotheses.hypothesis import SCALES
from cdpr_struct.planning.information import Numbers, expected_evidence, of_causes
from cdpr_struct.planning.measurements import Measurement

WIDE = float(np.exp(np.log(SCALES).mean()))  # prior sigmas that a rival's size may have, and a cause's at most

Pair = tuple[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Sized:
    """A cause in a pattern.

    effect : (c, d) numbers of all causes that are there: one column, or more for the mean over random patterns
    rival  : (c, e) by one sigma of each parameter, as wide as it may be where another cause is true
    """

    effect: np.ndarray
    rival: np.ndarray

    @classmethod
    def fitted(cls, numbers: Numbers, name: str, pattern: Pattern, theta: np.ndarray) -> "Sized":
        """Of sizes theta (d,) in prior sigmas."""
        columns = numbers.pattern(name, pattern)
        return cls(columns @ theta[:, None], max(WIDE, 2.0 * float(np.abs(theta).max())) * columns)

    @classmethod
    def detectable(cls, numbers: Numbers, name: str, gram: np.ndarray, most: float = np.inf) -> "Sized":
        """In its plainest pattern, random with an rms of twice the size that would be found, at most so many sigmas."""
        columns = numbers.pattern(name, plainest(numbers.patterns[name]))
        strength = float((columns * (gram @ columns)).sum())
        size = min(2.0 * np.sqrt(noncentrality(1) / max(strength, 1e-300)), most)
        return cls(size * columns, WIDE * columns)


@dataclass(frozen=True, slots=True)
class Separation:
    """A pair of causes and the expected log evidence for the first against the second, before and after [nat]."""

    cause: str
    rival: str
    before: float
    after: float


@dataclass(frozen=True, slots=True, eq=False)
class Gain:
    """A measurement and what it is worth: nats over all pairs, each counted up to `NAMED`; pairs, best first."""

    measurement: Measurement
    nats: float
    separations: tuple[Separation, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Separator:
    """Pairs of causes, and the information at hand on tolerances and causes.

    beside (c, e) : what may be there whichever cause of a pair is true
    """

    numbers: Numbers
    information: np.ndarray
    sized: Mapping[str, Sized]
    pairs: Sequence[Pair]
    beside: np.ndarray

    def nats(self, more: np.ndarray | float = 0.0) -> np.ndarray:
        """(pairs,) expected log evidence with more information."""
        gram = of_causes(self.information + more, self.numbers.tolerances)
        return np.array([
            expected_evidence(gram, self.sized[cause].effect, np.hstack([self.sized[rival].rival, self.beside]))
            for cause, rival in self.pairs
        ])  # fmt: skip

    def gain(self, measurement: Measurement, more: np.ndarray, before: np.ndarray) -> Gain:
        """What a measurement is worth."""
        after = self.nats(more)
        useful = np.minimum(after, NAMED) - np.minimum(before, NAMED)
        order = np.argsort(before - after, kind="stable")
        rows = separations([self.pairs[i] for i in order], before[order], after[order])
        return Gain(measurement, float(np.maximum(useful, 0.0).sum()), rows)


def separations(pairs: Sequence[Pair], before: np.ndarray, after: np.ndarray) -> tuple[Separation, ...]:
    """Of pairs, with (pairs,) nats."""
    rows = zip(pairs, before.tolist(), after.tolist(), strict=True)
    return tuple(Separation(cause, rival, old, new) for (cause, rival), old, new in rows)

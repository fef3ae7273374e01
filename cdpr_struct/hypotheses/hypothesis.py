"""A hypothesis: which causes at which scale, and which sensors drift how far."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Pattern
from cdpr_struct.hypotheses.correlated import Correlated
from cdpr_struct.hypotheses.drift import Drift
from cdpr_struct.residuals.linearised import Outside, Point, Term
from cdpr_struct.residuals.recorded import Recorded

SCALES = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
"""Of a cause's prior sigma, equally likely: how large an error is when it occurs is known to an order of magnitude."""
_TUNED = 0.005  # of a cause that adds a mode, whose frequency moves it past others
INDEPENDENT = 0.45  # probability of noise that is independent from reading to reading
PRICE = 3.0  # nats that a cause costs before it is found: one campaign in twenty has a given one


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A cause in a pattern of occurrence at a scale of its prior.

    law : of what is no change of the robot, what its basic parameters of this pattern do to the rows
    """

    cause: Cause
    pattern: Pattern
    scale: float
    law: Outside | None = None

    @property
    def term(self) -> Term:
        """What it changes of the robot, or what it does to the rows."""
        if self.law is not None:
            return Term.outside(self.law.times(self.scale * self.pattern.prior))
        return Term(self.cause.apply, self.pattern.basis, self.scale * self.pattern.prior)

    @property
    def log_weight(self) -> float:
        """ln of the probability of pattern and scale, given the cause."""
        return float(np.log(self.pattern.weight / len(SCALES)))

    @property
    def key(self) -> tuple[str, str, float]:
        """What tells it from others."""
        return self.cause.name, self.pattern.label, self.scale


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis:
    """Causes, and sensors that drift or whose noise is correlated."""

    parts: tuple[Part, ...] = ()
    drift: Drift | Correlated | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Of what is wrong with the simulation; a line in the peaks, like a drift, is wrong with the data alone."""
        return tuple(part.cause.name for part in self.parts if not part.cause.outside)

    @property
    def log_prior(self) -> float:
        """ln of its probability against that of nothing being wrong, drift included."""
        own = sum(part.log_weight - PRICE for part in self.parts)
        return own + float(np.log(INDEPENDENT if self.drift is None else self.drift.probability))

    @property
    def key(self) -> tuple[object, ...]:
        """What tells it from others, whatever the order of its causes."""
        return (*sorted(part.key for part in self.parts), self.drift)

    def terms(self, data: Recorded) -> tuple[Term, ...]:
        """What it changes of the robot, beside the tolerances."""
        found = tuple(part.term for part in self.parts)
        return found if self.drift is None else (self.drift.term(data), *found)

    def positive(self, point: Point) -> np.ndarray:
        """(t,) bool, of all numbers of a point with these terms: which cannot be negative."""
        own = [part.pattern.positive for part in self.parts]
        count = sum(len(term.sigma) for term in point.terms) - sum(len(mask) for mask in own)
        return np.concatenate([np.zeros(count, dtype=bool), *own])

    def straight(self, point: Point) -> np.ndarray:
        """(t,) sigmas by which each number of a point with these terms may move before the model bends."""
        own = [np.full(len(part.pattern.prior), _TUNED if part.cause.tuned else 1.0) for part in self.parts]
        count = sum(len(term.sigma) for term in point.terms) - sum(len(values) for values in own)
        return np.concatenate([np.ones(count), *own])

"""What readings say of the numbers that all states share: tolerances of the robot, and sizes of causes.

With its noise integrated out, a block of rows X z + C c + noise gives the information [X C]' S^-1 [X C]. Readings that
are independent given the numbers add theirs: those of a campaign, of a state that is still to be measured, of a scale.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Pattern, Seen
from cdpr_struct.residuals.linearised import Term
from cdpr_struct.robot.tolerances import tolerance_count


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """Tolerances, then the basic parameters of every cause, each in its prior sigma.

    tolerances : how many;  causes : by name;  sigma : (d0,) of each;  place : of each among all causes' numbers
    patterns : of each cause in this campaign
    """

    tolerances: int
    causes: Mapping[str, Cause]
    sigma: Mapping[str, np.ndarray]
    place: Mapping[str, slice]
    patterns: Mapping[str, tuple[Pattern, ...]]

    @classmethod
    def of(cls, cables: int, causes: Sequence[Cause], seen: Seen) -> "Numbers":
        """Those of a robot with so many cables."""
        sigma = {c.name: np.array([p.prior for p in c.basic(seen)]) for c in causes}
        ends = np.cumsum([len(own) for own in sigma.values()]).tolist()
        place = {name: slice(end - len(own), end) for (name, own), end in zip(sigma.items(), ends, strict=True)}
        patterns = {c.name: tuple(c.patterns(seen)) for c in causes}
        return cls(tolerance_count(cables, seen.wheels), {c.name: c for c in causes}, sigma, place, patterns)

    @property
    def count(self) -> int:
        """Of all causes together."""
        return sum(len(own) for own in self.sigma.values())

    def term(self, name: str) -> Term:
        """The basic parameters of a cause as a change of the robot."""
        sigma = self.sigma[name]
        return Term(self.causes[name].apply, np.eye(len(sigma)), sigma)

    def pattern(self, name: str, pattern: Pattern) -> np.ndarray:
        """(c, d) numbers of all causes by one prior sigma of each parameter of a pattern."""
        found = np.zeros((self.count, len(pattern.prior)))
        found[self.place[name]] = pattern.basis * pattern.prior / self.sigma[name][:, None]
        return found


def of_causes(information: np.ndarray, tolerances: int) -> np.ndarray:
    """(c, c) information on the causes, the tolerances z ~ N(0, I) integrated out, from (t + c, t + c)."""
    inner, cross = information[:tolerances, :tolerances], information[:tolerances, tolerances:]
    found = information[tolerances:, tolerances:] - cross.T @ np.linalg.solve(np.eye(tolerances) + inner, cross)
    return np.asarray(0.5 * (found + found.T))


def expected_evidence(gram: np.ndarray, effect: np.ndarray, rival: np.ndarray) -> float:
    """Expected log evidence [nat] for what is there against a rival of any size.

    Parameters
    ----------
    gram : (c, c) information on the causes.
    effect : (c,) numbers that are there, or (c, d): of a random pattern, the sum over its columns is the mean.
    rival : (c, e) numbers by one sigma of each parameter of the rival.

    Half the squared length of the effect in sigmas, less what the rival's own fit takes of it.
    """
    seen, taken = gram @ effect, gram @ rival
    inner = np.eye(rival.shape[1]) + rival.T @ taken
    along = taken.T @ effect
    return 0.5 * float((effect * seen).sum() - (along * np.linalg.solve(inner, along)).sum())

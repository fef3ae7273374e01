"""What a diagnosis holds: decision, candidates, what was set aside, what other data say of it. Numbers only."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.decision import Belief, Decision
from cdpr_struct.diagnosis.explain import Explained
from cdpr_struct.diagnosis.hypotheses.handling import Correction
from cdpr_struct.diagnosis.judge import Judged
from cdpr_struct.diagnosis.left_out import LeftOut
from cdpr_struct.diagnosis.whole_sizes import WholeSize
from cdpr_struct.measurement.campaign import Campaign


@dataclass(frozen=True, slots=True)
class SetAside:
    """A reading that contradicts all others, or a whole pose: kind as in files, case, cable from 0 (-1: none).

    sigmas : by how many stated sigmas it is off;  gain : what its being wrong adds to the log evidence [nat]
    """

    kind: str
    case: str
    cable: int
    sigmas: float
    gain: float


@dataclass(frozen=True, slots=True)
class ErrorOfKind:
    """Simulated minus measured of one kind of data, as entered.

    rms, unit;  expected : rms that noise and tolerances let expect, None where the simulation does not say
    chi2_per_n;  case, cable (from 0, -1: none) of the worst
    """

    kind: str
    rms: float
    expected: float | None
    unit: str
    chi2_per_n: float
    case: str
    cable: int


@dataclass(frozen=True, slots=True)
class Location:
    """Where the error sits: kind of rows ("EQ", "CO", "CF", "RF"), case, cable from 0 (-1: none)."""

    rows: str
    case: str
    cable: int


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A set of causes that was fitted.

    sizes : of each, with the tolerances of the same parameters;  gain : log evidence (prior included) against none
    explained : share of the significant error that it takes away, 0 to 1
    """

    names: tuple[str, ...]
    best: Judged
    sizes: tuple[WholeSize, ...]
    gain: float
    explained: float


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosis:
    """Everything found.

    campaign : as recorded;  correction : of the data that is believed, None where they stand
    chosen, null : what the decision speaks of, and nothing wrong, both on the data that are believed
    p_value : of nothing being wrong with the data as recorded: no likelihood ratio exceeds 1 / p more often than p
    left_out : predictions of states that were not fitted, None where nothing is chosen or can be left out
    confirmed : whether no chosen cause hangs on one state
    minimum_detectable : by cause, parameter's name to the size found in four of five campaigns
    """

    campaign: Campaign
    decision: Decision
    beliefs: tuple[Belief, ...]
    p_value: float
    explained: Explained
    correction: Correction | None
    chosen: Judged
    null: Judged
    candidates: tuple[Candidate, ...]
    set_aside: tuple[SetAside, ...]
    errors: tuple[ErrorOfKind, ...]
    location: Location | None
    left_out: LeftOut | None
    confirmed: bool
    not_testable: dict[str, str]
    minimum_detectable: dict[str, dict[str, float]]

    @property
    def outside(self) -> tuple[str, float]:
        """The best law outside the library in words, and its log evidence against none."""
        laws = [
            one
            for one in self.candidates
            if one.best.hypothesis.parts and one.best.hypothesis.parts[-1].law is not None
        ]
        if not laws:
            return "", -np.inf
        best = max(laws, key=lambda one: one.gain)
        return best.best.hypothesis.parts[-1].pattern.label, best.gain

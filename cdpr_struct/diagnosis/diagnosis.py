"""What a diagnosis holds: decision, candidates, what was set aside, what other data say of it. Numbers only."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.damped import Damped
from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.diagnosis.internal_forces import InternalForces
from cdpr_struct.diagnosis.left_out import LeftOut
from cdpr_struct.diagnosis.peaks_apart import PeaksApart
from cdpr_struct.diagnosis.recommended import Recommendation
from cdpr_struct.diagnosis.recording import Recording
from cdpr_struct.diagnosis.sensor_sigmas import Doubt, NoiseOfKind, Used
from cdpr_struct.diagnosis.unassigned import UncertainPeak
from cdpr_struct.diagnosis.whole_sizes import WholeSize
from cdpr_struct.hypotheses.correction import Correction
from cdpr_struct.hypotheses.correlated import Correlated
from cdpr_struct.hypotheses.explain import Belief, Explained
from cdpr_struct.hypotheses.hypothesis import Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.remainder import Remainder
from cdpr_struct.robot.robot import Robot

DAMPING = "DA"
"""Rows of damping ratios."""
NULL_SPACE = "NS"
"""Internal forces, which are in no row: they do no work on the platform."""


@dataclass(frozen=True, slots=True)
class SetAside:
    """A reading that contradicts all others, or a whole pose: kind as in files, case, cable from 0 (-1: none).

    sigmas : by how many stated sigmas it is off;  gain : what its being wrong adds to the log evidence [nat]
    hertz : of the mode of a modal constant, else 0
    """

    kind: str
    case: str
    cable: int
    sigmas: float
    gain: float
    hertz: float = 0.0


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
    """Where the error sits: rows ("EQ", "CO", "CF", "RF", `DAMPING`, `NULL_SPACE`), case, cable from 0 (-1: none)."""

    rows: str
    case: str
    cable: int


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A set of causes that was fitted.

    sizes : of each, with the tolerances of the same parameters;  gain : log evidence (prior included) against none
    explained : share of the significant error that it takes away, 0 to 1
    ahead : log evidence against the best of its subsets, none among them
    """

    names: tuple[str, ...]
    best: Judged
    sizes: tuple[WholeSize, ...]
    gain: float
    explained: float
    ahead: float

    @property
    def laws(self) -> tuple[Part, ...]:
        """Those of its parts that the library does not know."""
        return tuple(part for part in self.best.hypothesis.parts if part.cause.name == UNKNOWN)

    @property
    def has_size(self) -> bool:
        """Whether it is likelier than with any of its causes left out, and each of them is a change of the robot."""
        return self.ahead > 0.0 and not self.laws and all(size.is_change for size in self.sizes)


@dataclass(frozen=True, slots=True, eq=False)
class Tried:
    """A correction of the data that was looked into, with its log evidence, prior included, against the data as filed.

    explained : share of the significant error that goes with it
    """

    correction: Correction
    gain: float
    explained: float


@dataclass(frozen=True, slots=True)
class Pile:
    """Outliers of one sensor: kind, number of the cable from 0, how many of how many readings.

    p : of a sensor of the campaign with so many, if outliers are independent and as frequent as in the others
    """

    kind: str
    cable: int
    outliers: int
    readings: int
    p: float


@dataclass(frozen=True, slots=True)
class Peaks:
    """How many peaks of the robot were measured, and those that are given to no mode for certain."""

    count: int
    uncertain: tuple[UncertainPeak, ...]


@dataclass(frozen=True, slots=True)
class Drifted:
    """Sensors whose zeros drift: rms over them of their largest change [N or m], of a tracker's frame also [rad]."""

    sensor: str
    size: float
    turn: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosis:
    """Everything found.

    campaign : as recorded;  correction : of the data that is believed (where no cause explains them: that helps most),
    None where they stand
    chosen, null : what the decision speaks of, and nothing wrong, both on the data that are believed
    p_value : of nothing being wrong with the data as recorded: no likelihood ratio exceeds 1 / p more often than p
    piled_up : the sensor whose outliers are no chance, for which the decision is `unknown`; None without any
    p_adequate : of noise as large as what the choice leaves, sigmas being known as well as they usually are
    sizes : of the chosen causes;  drift : of sensors beside them, None where none drift
    candidates : sets of causes that were fitted, best first, those without a size or below the null among them
    tried : corrections of the data, the believed one first
    recorded, residuals : rows with their sigmas under the null, of the data as recorded, and as believed with causes
    left_out : predictions of states that were not fitted, None where nothing is chosen or can be left out
    generic : how many times smaller a common EA and load cell gain make the error of all rows left out, None likewise
    added : log evidence that added modes keep without the peaks of the state that they need most [nat], or None
    confirmed : whether no chosen cause hangs on one state, or on the only one
    extended : the robot with the chosen causes, None where none is chosen
    damped : what signals say of the damping, None without signals
    forces : internal force beside what the simulation commands, None without tensions of a redundant robot
    apart : peaks of the robot beside the modes that a sensor on the platform can see, None without peaks
    fitted : the decision without what internal forces say beside encoders
    minimum_detectable : by cause, parameter's name to the size found in four of five campaigns
    detectable_by_pattern : the same of every pattern
    recording : what frames of a motion say beyond single states, None without any
    """

    campaign: Campaign
    decision: Decision
    beliefs: tuple[Belief, ...]
    p_value: float
    piled_up: Pile | None
    p_adequate: float
    explained: Explained
    correction: Correction | None
    chosen: Judged
    null: Judged
    sizes: tuple[WholeSize, ...]
    drift: Drifted | None
    candidates: tuple[Candidate, ...]
    tried: tuple[Tried, ...]
    set_aside: tuple[SetAside, ...]
    peaks: Peaks
    noise: tuple[NoiseOfKind, ...]
    errors: tuple[ErrorOfKind, ...]
    location: Location | None
    recorded: LeftOut
    residuals: LeftOut
    left_out: LeftOut | None
    added: float | None
    generic: float | None
    confirmed: bool
    extended: Robot | None
    damped: Damped | None
    forces: InternalForces | None
    apart: PeaksApart | None
    fitted: Decision
    recommendations: tuple[Recommendation, ...]
    sigmas: tuple[Used, ...]
    doubts: tuple[Doubt, ...]
    not_testable: dict[str, str]
    minimum_detectable: dict[str, dict[str, float | str]]
    detectable_by_pattern: dict[str, list[dict[str, float | str]]]
    recording: Recording | None

    @property
    def noise_correlation(self) -> float:
        """Of one reading of a sensor with the next, 0 for independent noise."""
        kind = self.chosen.hypothesis.drift
        return kind.correlation if isinstance(kind, Correlated) else 0.0

    @property
    def by_damping(self) -> bool:
        """Whether the decision is that of the damping alone."""
        return self.location is not None and self.location.rows == DAMPING

    @property
    def by_peaks(self) -> bool:
        """Whether the decision speaks of peaks that lie by a common factor from all modes."""
        return self.apart is not None and self.apart.found and self.fitted.classes == (self.apart.names,)

    @property
    def by_forces(self) -> bool:
        """Whether the decision speaks of internal forces that encoders and load cells show together."""
        return self.fitted != self.decision and not self.by_damping

    @property
    def left_at_random(self) -> Remainder | None:
        """What no cause explains, as a random law; None where the decision is another one than `unknown`."""
        return None if self.extended is None else self.extended.remainder

    @property
    def outside(self) -> tuple[str, float]:
        """The best law outside the library in words, and its log evidence against none."""
        laws = [(part.pattern.label, one.gain) for one in self.candidates for part in one.laws]
        return max(laws, key=lambda law: law[1], default=("", -np.inf))
